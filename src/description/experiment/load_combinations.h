/// Line loads and combinations of load cases, and their limits.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "description/experiment/experiment_text.h"
#include "description/experiment/load_members.h"

namespace taut::description {

/// Limits of an experiment: number of load cases and combinations; number of elements that all
/// selectors together examine; number of forces, settlements and changes of length in all load
/// cases.
inline constexpr std::size_t kMostCases = 10'000, kMostExamined = 100'000'000,
                             kMostLoads = 10'000'000;

/// Returns the number of forces, settlements and changes of length.
std::size_t LoadCount(const LoadCaseSpec& one);

/// Reports that the loads of all cases exceed kMostLoads.
void RefuseLoads(const SourceRef& at, const Scope& scope);

/// Forces from loads per length. Reused for all line loads of a robot.
class LineLoads {
 public:
  LineLoads(const RobotSpec& robot, const Scope& scope);
  /// Adds all line loads to the forces of `out`: half of the load of a member (for a cable: of each
  /// span) acts at each end. Forces of members that meet at a node are added up.
  void AddTo(LoadCaseSpec& out, const std::vector<LineLoadText>& loads);

 private:
  void Span(const LoadPoint& from, const LoadPoint& to, const std::string& member);
  void Add(int node, const Vec3& force_n);

  const RobotSpec& robot_;
  const Scope& scope_;
  NodePlaces places_;
  std::map<int, std::size_t> force_at_;  ///< Index of the first force on a node, in `out`.
  const LineLoadText* load_ = nullptr;
  LoadCaseSpec* out_ = nullptr;
};

/// Appends the combinations to `cases`. Their factors name the cases that are already in this list.
/// `names`: all names so far.
void AddCombinations(const std::vector<LoadCombinationText>& combinations, const RobotSpec& robot,
                     std::map<std::string, SourceRef>& names, const Scope& scope,
                     std::vector<LoadCaseSpec>& cases);

/// Returns whether no earlier load case has this name; reports an error otherwise.
bool IsNewCase(const Placed& name, std::map<std::string, SourceRef>& names, const Scope& scope);

}  // namespace taut::description
