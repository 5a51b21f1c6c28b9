#include "description/experiment/load_combinations.h"

#include <algorithm>
#include <cmath>

#include "description/experiment/load_members.h"
#include "math/vec.h"

namespace taut::description {
namespace {

/// Index of the length change of each cable or bar in the list of a combination.
using Positions = std::map<int, std::size_t>;

/// Adds the length changes `from` of a load case, times `factor`, to a combination, `sum`.
void AddLengthenings(const std::vector<LoadCaseSpec::Lengthening>& from, double factor,
                     std::vector<LoadCaseSpec::Lengthening>& sum, Positions& positions) {
  for (const LoadCaseSpec::Lengthening& one : from) {
    const auto [at, fresh] = positions.emplace(one.index, sum.size());
    if (fresh) {
      sum.push_back({one.index, factor * one.by_m});
    } else {
      sum[at->second].by_m += factor * one.by_m;
    }
  }
}

void AddCase(const LoadCaseSpec& one, double factor, LoadCaseSpec& sum, Positions& cables,
             Positions& bars) {
  sum.weight_factor += factor * one.GravityFactor();
  for (const auto& force : one.forces) sum.forces.push_back({force.node, factor * force.force_n});
  for (const auto& settled : one.settlements) {
    sum.settlements.push_back({settled.joint, factor * settled.by_m});
  }
  AddLengthenings(one.cables, factor, sum.cables, cables);
  AddLengthenings(one.bars, factor, sum.bars, bars);
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

LineLoads::LineLoads(const RobotSpec& robot, const Scope& scope)
    : robot_(robot), scope_(scope), places_(robot) {}

void LineLoads::AddTo(LoadCaseSpec& out, const std::vector<LineLoadText>& loads) {
  out_ = &out;
  force_at_.clear();
  for (std::size_t i = 0; i < out.forces.size(); ++i) force_at_.emplace(out.forces[i].node, i);
  for (const LineLoadText& load : loads) {
    if (!load.members.value) continue;
    load_ = &load;
    for (const LoadMember& member :
         SelectMembers(*load.members.value, "line_loads.members", true, robot_, scope_)) {
      const std::vector<LoadPoint> points = PointsOf(member, robot_);
      for (std::size_t i = 1; i < points.size(); ++i) {
        Span(points[i - 1], points[i], NameOf(member, robot_));
      }
    }
  }
}

void LineLoads::Span(const LoadPoint& from, const LoadPoint& to, const std::string& member) {
  const double half_m = 0.5 * Length(from.at_m - to.at_m);
  for (const LoadPoint& end : {from, to}) {
    const auto node = places_.At(end);
    if (!node && end.body == kWorld) continue;
    if (!node) {
      scope_.out.Error("load_case.end_without_node", load_->members.value->at,
                       "line_loads.members: \"" + member + "\" has no node at its end",
                       "add a node to the part at this end");
      return;
    }
    Add(*node, half_m * load_->force_n_per_m);
  }
}

void LineLoads::Add(int node, const Vec3& force_n) {
  const auto [at, fresh] = force_at_.emplace(node, out_->forces.size());
  if (fresh) {
    out_->forces.push_back({node, force_n});
  } else {
    Vec3& sum = out_->forces[at->second].force_n;
    sum = sum + force_n;
  }
}

std::size_t LoadCount(const LoadCaseSpec& one) {
  return one.forces.size() + one.settlements.size() + one.cables.size() + one.bars.size();
}

void RefuseLoads(const SourceRef& at, const Scope& scope) {
  scope.out.Error("load_case.too_many_loads", at,
                  "the load cases and combinations up to this one have more than " +
                      std::to_string(kMostLoads) + " forces and changes of length",
                  "analyze them in several experiments");
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
  std::map<std::string, std::size_t> case_of;
  std::size_t loads = 0;
  for (const LoadCaseSpec& one : cases) {
    case_of.emplace(one.name, known.size());
    known.push_back(one.name);
    loads += LoadCount(one);
  }
  // Check before memory is allocated: a few bytes of the file can repeat all loads of a case.
  for (const LoadCombinationText& text : combinations) {
    for (const auto& factor : text.factors.items) {
      const auto found = case_of.find(factor.name);
      if (found != case_of.end()) loads += LoadCount(cases[found->second]);
    }
    if (loads > kMostLoads) return RefuseLoads(text.name.at, scope);
  }
  for (const LoadCombinationText& text : combinations) {
    IsNewCase(text.name, names, scope);
    LoadCaseSpec sum;
    sum.name = text.name.text;
    sum.weight_factor = 0.0;
    sum.max_displacement_m = text.max_displacement_m;
    Positions cables, bars;
    for (const auto& factor : text.factors.items) {
      const auto found = case_of.find(factor.name);
      if (found == case_of.end()) {
        scope.out.Error(
            "load_combination.unknown_case", factor.name_at,
            "there is no load case \"" + factor.name + "\"",
            known.empty() ? std::string("the experiment has none") : NameHint(factor.name, known));
        continue;
      }
      const LoadCaseSpec& one = cases[found->second];
      AddCase(one, factor.value, sum, cables, bars);
    }
    sum.weight = sum.weight_factor != 0.0;
    CheckRestLengths(sum, robot, text.name.at, scope);
    cases.push_back(std::move(sum));
  }
}

}  // namespace taut::description
