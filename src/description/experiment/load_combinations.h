/// Line loads and combinations of load cases.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "description/experiment/experiment_text.h"

namespace taut::description {

/// Adds the line load of the selected members to the forces of `out`: half of the load of each
/// member (for a cable, of each span) at either end.
void AddLineLoad(const LineLoadText& load, const RobotSpec& robot, const Scope& scope,
                 LoadCaseSpec& out);

/// Appends the combinations to `cases`. Their factors name the cases that are already in this list.
/// `names`: all names so far.
void AddCombinations(const std::vector<LoadCombinationText>& combinations, const RobotSpec& robot,
                     std::map<std::string, SourceRef>& names, const Scope& scope,
                     std::vector<LoadCaseSpec>& cases);

/// Returns whether no earlier load case has this name; reports an error otherwise.
bool IsNewCase(const Placed& name, std::map<std::string, SourceRef>& names, const Scope& scope);

}  // namespace taut::description
