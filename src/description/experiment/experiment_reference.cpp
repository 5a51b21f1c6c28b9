// Reference values of an experiment, for comparison with taut's results.
#include "description/experiment/experiment_keys.h"
#include "description/experiment/experiment_parts.h"

namespace taut::description {
namespace {

template <class Items>
std::optional<int> FindNamed(const Items& items, const std::string& name, const SourceRef& at,
                             const char* kind, Diagnostics& out) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < items.size(); ++i) {
    names.push_back(items[i].name);
    if (names.back() == name) return static_cast<int>(i);
  }
  out.Error("reference.unknown_name", at, "there is no " + std::string(kind) + " \"" + name + "\"",
            NameHint(name, names));
  return std::nullopt;
}

}  // namespace

void Check(const MapReader& map, ReferenceText& reference) {
  if (!map.Has("phase") && reference.statistic != ReferenceSpec::Statistic::kMax) {
    map.Error("reference.statistic_only_max", "statistic",
              "reference.statistic must be max for the whole run",
              "for another statistic, name a phase of the timeline, such as `phase: before`");
  }
  const Value* cables = map.Find("cables_n");
  if (cables && cables->kind == Value::Kind::kMap && cables->entries.empty()) {
    map.scope().out.Error("reference.no_values", cables->at, "reference.cables_n has no values",
                          "such as `inner_top_1: 34.4`");
  }
}

std::vector<ReferenceSpec> ToReferences(const std::vector<ReferenceText>& texts,
                                        const RobotSpec* robot,
                                        const std::vector<PhaseSpec>& phases, const Scope& scope) {
  std::vector<ReferenceSpec> references;
  for (const ReferenceText& text : texts) {
    ReferenceSpec& reference = references.emplace_back(text);
    reference.phase = text.phase_text.text;
    if (!text.phase_text.at.file.empty())
      FindNamed(phases, reference.phase, text.phase_text.at, "phase", scope.out);
    if (!robot) continue;
    for (const auto& item : text.cables_n.items) {
      const auto cable = FindNamed(robot->def.cables, item.name, item.name_at, "cable", scope.out);
      if (cable) reference.values.push_back({*cable, item.value});
    }
  }
  return references;
}

}  // namespace taut::description
