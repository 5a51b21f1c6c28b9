#include "description/experiment/load_combinations.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "description/experiment/load_members.h"
#include "math/vec.h"

namespace taut::description {
namespace {

constexpr double kSamePoint_m = 1e-9;

/// Point of a body, in the frame of `NodeDef::position_m`.
struct Point {
  int body;
  Vec3 at_m;
};

std::optional<int> NodeAt(const ModelDef& def, const Point& point) {
  for (std::size_t i = 0; i < def.nodes.size(); ++i) {
    const NodeDef& node = def.nodes[i];
    if (node.body == point.body && Length(node.position_m - point.at_m) <= kSamePoint_m) {
      return static_cast<int>(i);
    }
  }
  return std::nullopt;
}

class LineLoad {
 public:
  LineLoad(const LineLoadText& load, const RobotSpec& robot, const Scope& scope, LoadCaseSpec& out)
      : load_(load), robot_(robot), scope_(scope), out_(out) {}

  void Run() {
    if (!load_.members.value) return;
    const ModelDef& def = robot_.def;
    for (const LoadMember& member :
         SelectMembers(*load_.members.value, "line_loads.members", true, robot_, scope_)) {
      const auto i = static_cast<std::size_t>(member.index);
      if (member.kind == LoadMember::Kind::kCable) {
        Cable(def.cables[i]);
      } else if (member.kind == LoadMember::Kind::kBar) {
        const JointDef& bar = def.joints[i];
        Span({bar.body_a, bar.from_m}, {bar.body_b, bar.to_m}, bar.name);
      } else {
        const CapsuleDef& rod = def.capsules[i];
        Span({rod.body, rod.from_m}, {rod.body, rod.to_m}, rod.name);
      }
    }
  }

 private:
  void Cable(const CableDef& cable) {
    for (std::size_t i = 1; i < cable.attachments.size(); ++i) {
      const AttachmentDef &from = cable.attachments[i - 1], &to = cable.attachments[i];
      Span({from.body, from.position_m}, {to.body, to.position_m}, cable.name);
    }
  }

  void Span(const Point& from, const Point& to, const std::string& member) {
    const double half_m = 0.5 * Length(from.at_m - to.at_m);
    for (const Point& end : {from, to}) {
      const auto node = NodeAt(robot_.def, end);
      if (!node && end.body == kWorld) continue;
      if (!node) {
        scope_.out.Error("load_case.end_without_node", load_.members.value->at,
                         "line_loads.members: \"" + member + "\" has no node at its end",
                         "add a node to the part there");
        return;
      }
      Add(*node, half_m * load_.force_n_per_m);
    }
  }

  /// Members that meet at a node add up there.
  void Add(int node, const Vec3& force_n) {
    for (LoadCaseSpec::NodeForce& force : out_.forces) {
      if (force.node != node) continue;
      force.force_n = force.force_n + force_n;
      return;
    }
    out_.forces.push_back({node, force_n});
  }

  const LineLoadText& load_;
  const RobotSpec& robot_;
  const Scope& scope_;
  LoadCaseSpec& out_;
};

/// Adds `factor` times the changes of length to those of the sum.
void AddLengthenings(const std::vector<LoadCaseSpec::Lengthening>& from, double factor,
                     std::vector<LoadCaseSpec::Lengthening>& sum) {
  for (const LoadCaseSpec::Lengthening& one : from) {
    const auto same = std::find_if(sum.begin(), sum.end(),
                                   [&](const auto& other) { return other.index == one.index; });
    if (same == sum.end()) {
      sum.push_back({one.index, factor * one.by_m});
    } else {
      same->by_m += factor * one.by_m;
    }
  }
}

void AddCase(const LoadCaseSpec& one, double factor, LoadCaseSpec& sum) {
  sum.weight_factor += factor * one.GravityFactor();
  for (const auto& force : one.forces) sum.forces.push_back({force.node, factor * force.force_n});
  for (const auto& settled : one.settlements) {
    sum.settlements.push_back({settled.joint, factor * settled.by_m});
  }
  AddLengthenings(one.cables, factor, sum.cables);
  AddLengthenings(one.bars, factor, sum.bars);
}

/// Reports members without a positive rest length under a combination.
void CheckRestLengths(const LoadCaseSpec& sum, const RobotSpec& robot, const SourceRef& at,
                      const Scope& scope) {
  for (const auto& longer : sum.cables) {
    const CableDef& cable = robot.def.cables[static_cast<std::size_t>(longer.index)];
    CheckRestLength(sum.name, cable.name, cable.rest_length_m, longer.by_m, at, scope);
  }
  for (const auto& longer : sum.bars) {
    const JointDef& bar = robot.def.joints[static_cast<std::size_t>(longer.index)];
    CheckRestLength(sum.name, bar.name, bar.rest, longer.by_m, at, scope);
  }
}

}  // namespace

void AddLineLoad(const LineLoadText& load, const RobotSpec& robot, const Scope& scope,
                 LoadCaseSpec& out) {
  LineLoad(load, robot, scope, out).Run();
}

bool IsNewCase(const Placed& name, std::map<std::string, SourceRef>& names, const Scope& scope) {
  const auto [first, fresh] = names.emplace(name.text, name.at);
  if (fresh || name.text.empty()) return fresh;
  scope.out.Error("load_case.duplicate_name", name.at, "two load cases are called " + name.text,
                  "the first is in line " + std::to_string(first->second.line));
  return false;
}

void AddCombinations(const std::vector<LoadCombinationText>& combinations, const RobotSpec& robot,
                     std::map<std::string, SourceRef>& names, const Scope& scope,
                     std::vector<LoadCaseSpec>& cases) {
  std::vector<std::string> known;
  for (const LoadCaseSpec& one : cases) known.push_back(one.name);
  for (const LoadCombinationText& text : combinations) {
    IsNewCase(text.name, names, scope);
    LoadCaseSpec sum;
    sum.name = text.name.text;
    sum.weight_factor = 0.0;
    sum.max_displacement_m = text.max_displacement_m;
    for (const auto& factor : text.factors.items) {
      const auto found = std::find(known.begin(), known.end(), factor.name);
      if (found == known.end()) {
        scope.out.Error(
            "load_combination.unknown_case", factor.name_at,
            "there is no load case \"" + factor.name + "\"",
            known.empty() ? std::string("the experiment has none") : NameHint(factor.name, known));
        continue;
      }
      AddCase(cases[static_cast<std::size_t>(found - known.begin())], factor.value, sum);
    }
    sum.weight = sum.weight_factor != 0.0;
    CheckRestLengths(sum, robot, text.name.at, scope);
    cases.push_back(std::move(sum));
  }
}

}  // namespace taut::description
