// Numbers of others, to show ours beside.
#include "description/experiment_parts.h"

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
  out.Error(at, "there is no " + std::string(kind) + " \"" + name + "\"", NameHint(name, names));
  return std::nullopt;
}

ReferenceSpec ReadOne(const Value& value, const RobotSpec* robot,
                      const std::vector<PhaseSpec>& phases, const Scope& scope) {
  const MapReader map(value, "reference", {"source", "quantity", "statistic", "phase", "cables_n"},
                      scope);
  ReferenceSpec reference;
  reference.source = map.Text("source");
  reference.quantity = map.ChoiceOr("quantity", reference.quantity, kReferenceQuantities);
  reference.statistic = map.ChoiceOr("statistic", reference.statistic, kReferenceStatistics);
  if (const Value* phase = map.Find("phase")) {
    reference.phase = ReadText(*phase, map.Path("phase"), scope);
    FindNamed(phases, reference.phase, phase->at, "phase", scope.out);
  } else if (reference.statistic != ReferenceSpec::Statistic::kMax) {
    map.Error("statistic", "reference.statistic: over the whole run there is only max",
              "name a phase of the timeline: phase: before");
  }
  const Value* cables = map.Require("cables_n");
  for (const Entry& entry : Entries(cables, "reference.cables_n", scope)) {
    const double force_n =
        ReadNumber(*entry.value, "reference.cables_n." + entry.key, Bound::kAny, scope);
    if (!robot) continue;
    const auto cable = FindNamed(robot->def.cables, entry.key, entry.key_at, "cable", scope.out);
    if (cable) reference.values.push_back({*cable, force_n});
  }
  if (cables && cables->kind == Value::Kind::kMap && cables->entries.empty()) {
    scope.out.Error(cables->at, "reference.cables_n has no values", "inner_top_1: 34.4");
  }
  return reference;
}

}  // namespace

std::vector<ReferenceSpec> ReadReferences(const Value* list, const RobotSpec* robot,
                                          const std::vector<PhaseSpec>& phases,
                                          const Scope& scope) {
  std::vector<ReferenceSpec> references;
  for (const ValuePtr& item : Items(list, "reference", scope)) {
    references.push_back(ReadOne(*item, robot, phases, scope));
  }
  return references;
}

}  // namespace taut::description
