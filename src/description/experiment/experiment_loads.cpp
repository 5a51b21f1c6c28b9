// Load cases of an experiment: forces, settlements, changes of length and temperature.
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "base/fixed.h"
#include "description/experiment/area_loads.h"
#include "description/experiment/experiment_parts.h"
#include "description/experiment/load_combinations.h"
#include "description/experiment/load_keys.h"
#include "description/experiment/load_members.h"

namespace taut::description {
namespace {

/// Returns the index of the item with this name; -1 after an error. `counts` returns whether an
/// item is eligible.
template <class Named>
int Find(const Placed& name, const char* kind, const std::vector<Named>& all,
         const std::vector<bool>& counts, const Scope& scope) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!counts[i]) continue;
    if (all[i].name == name.text) return static_cast<int>(i);
    names.push_back(all[i].name);
  }
  if (name.text.empty()) return -1;  // already reported
  scope.out.Error("load_case.unknown_name", name.at,
                  std::string("there is no ") + kind + " \"" + name.text + "\"",
                  names.empty() ? std::string("the robot has none") : NameHint(name.text, names));
  return -1;
}

class CaseReader {
 public:
  CaseReader(const RobotSpec& robot, const Scope& scope)
      : robot_(robot), scope_(scope), line_loads_(robot, scope), area_loads_(robot, scope) {
    for (std::size_t i = 0; i < robot.def.nodes.size(); ++i) {
      node_of_.emplace(robot.def.nodes[i].name, static_cast<int>(i));
    }
    for (const JointDef& joint : robot.def.joints) {
      is_support_.push_back(base::IsFixed(robot.def, joint.body_a) && !IsBar(joint));
      if (!is_support_.back()) continue;
      support_of_.emplace(joint.name, static_cast<int>(is_support_.size()) - 1);
    }
  }

  LoadCaseSpec Run(const LoadCaseText& text) {
    LoadCaseSpec out;
    out.name = text.name.text;
    out.weight = text.weight;
    out.weight_factor = text.weight_factor;
    out.max_displacement_m = text.max_displacement_m;
    for (const NodeForceText& force : text.forces) {
      for (const int node : Nodes(force)) out.forces.push_back({node, force.force_n});
      if (out.forces.size() > kMostLoads) return out;
    }
    if (!text.areas.empty()) area_loads_.AddTo(out, text.areas);
    if (!text.lines.empty()) line_loads_.AddTo(out, text.lines);
    for (const SettlementText& settlement : text.settlements) {
      const auto known = support_of_.find(settlement.support.text);
      const int joint = known != support_of_.end() ? known->second
                                                   : Find(settlement.support, "support",
                                                          robot_.def.joints, is_support_, scope_);
      if (joint >= 0) out.settlements.push_back({joint, settlement.by_m});
    }
    gains_.clear();
    for (const RestLengthText& change : text.rest_lengths) {
      if (!change.members.value) continue;
      ForEach(*change.members.value, "rest_lengths.members", [&](const Member& m) {
        return change.by_m.value_or(change.by_ratio.value_or(0) * m.rest_m);
      });
    }
    for (const TemperatureText& change : text.temperatures) {
      if (change.members.value) Warm(*change.members.value, change.by_k);
    }
    for (const auto& [member, gain] : gains_) {
      const Member m = MemberAt(member);
      CheckRestLength(out.name, m.name, m.rest_m, gain.by_m, gain.at, scope_);
      (member.kind == LoadMember::Kind::kBar ? out.bars : out.cables)
          .push_back({member.index, gain.by_m});
    }
    return out;
  }

 private:
  struct Member {
    const std::string& name;
    double rest_m, expansion_per_k;
  };
  struct Gain {
    double by_m = 0;
    SourceRef at;  ///< Position of the last contribution in the file.
  };

  /// Returns the node, or the selected nodes, of a force.
  std::vector<int> Nodes(const NodeForceText& force) const {
    if (!force.nodes.value) {
      const auto known = node_of_.find(force.node_name.text);
      if (known != node_of_.end()) return {known->second};
      const std::vector<bool> all(robot_.def.nodes.size(), true);
      const int node = Find(force.node_name, "node", robot_.def.nodes, all, scope_);
      return node >= 0 ? std::vector{node} : std::vector<int>();
    }
    return SelectNodes(*force.nodes.value, "forces.nodes", robot_, scope_);
  }

  Member MemberAt(const LoadMember& key) const {
    const auto i = static_cast<std::size_t>(key.index);
    if (key.kind == LoadMember::Kind::kBar) {
      const JointDef& bar = robot_.def.joints[i];
      return {bar.name, bar.rest, bar.member.expansion_per_k};
    }
    const CableDef& cable = robot_.def.cables[i];
    return {cable.name, cable.rest_length_m, cable.member.expansion_per_k};
  }

  /// Adds `gain` [m] to the change of rest length of each selected member.
  template <class F>
  void ForEach(const Value& selector, const char* what, const F& gain) {
    for (const LoadMember& key : SelectMembers(selector, what, false, robot_, scope_)) {
      Gain& of_it = gains_[key];
      of_it.by_m += gain(MemberAt(key));
      of_it.at = selector.at;
    }
  }

  void Warm(const Value& selector, double by_k) {
    std::string unknown;
    ForEach(selector, "temperatures.members", [&](const Member& m) {
      if (m.expansion_per_k == 0) unknown += (unknown.empty() ? "" : ", ") + m.name;
      return m.expansion_per_k * by_k * m.rest_m;
    });
    if (unknown.empty()) return;
    scope_.out.Error("load_case.unknown_expansion", selector.at,
                     "temperatures.members: the thermal expansion is not known for " + unknown,
                     "add `expansion_per_k` to the builder in the model: steel has 12e-6");
  }

  const RobotSpec& robot_;
  const Scope& scope_;
  LineLoads line_loads_;
  AreaLoads area_loads_;
  std::unordered_map<std::string_view, int> node_of_, support_of_;
  std::vector<bool> is_support_;
  std::map<LoadMember, Gain> gains_;
};

/// Reports selectors that would examine too many elements. Each selector examines all elements.
bool CheckSelectors(const std::vector<LoadCaseText>& texts, const RobotSpec& robot,
                    const Scope& scope) {
  const ModelDef& def = robot.def;
  const std::size_t elements =
      def.nodes.size() + def.cables.size() + def.joints.size() + def.capsules.size();
  std::size_t selectors = 0;
  for (const LoadCaseText& text : texts) {
    selectors += text.forces.size() + text.settlements.size() + text.rest_lengths.size() +
                 text.temperatures.size() + text.lines.size() + text.areas.size();
    if (selectors * elements <= kMostExamined) continue;
    scope.out.Error("load_case.too_many_selectors", text.name.at,
                    "the " + std::to_string(selectors) + " loads up to this load case and the " +
                        std::to_string(elements) +
                        " nodes, cables, joints and rods of the robot have a product of more "
                        "than " +
                        std::to_string(kMostExamined),
                    "use fewer selectors that match more elements, or several experiments");
    return false;
  }
  return true;
}

}  // namespace

std::vector<LoadCaseSpec> ToLoadCases(const std::vector<LoadCaseText>& texts,
                                      const std::vector<LoadCombinationText>& combinations,
                                      const RobotSpec* robot, const Scope& scope) {
  std::vector<LoadCaseSpec> cases;
  std::map<std::string, SourceRef> names;
  if (texts.size() + combinations.size() > kMostCases) {
    scope.out.Error("load_case.too_many", (texts.empty() ? combinations[0].name : texts[0].name).at,
                    "there are " + std::to_string(texts.size() + combinations.size()) +
                        " load cases and combinations, more than " + std::to_string(kMostCases),
                    "analyze them in several experiments");
    return cases;
  }
  if (robot && !CheckSelectors(texts, *robot, scope)) return cases;
  std::optional<CaseReader> reader;
  if (robot) reader.emplace(*robot, scope);
  std::size_t loads = 0;
  for (const LoadCaseText& text : texts) {
    IsNewCase(text.name, names, scope);
    if (!reader) continue;
    cases.push_back(reader->Run(text));
    loads += LoadCount(cases.back());
    if (loads <= kMostLoads) continue;
    RefuseLoads(text.name.at, scope);
    return {};
  }
  if (robot) AddCombinations(combinations, *robot, names, scope, cases);
  return cases;
}

}  // namespace taut::description
