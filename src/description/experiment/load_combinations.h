/// Line loads and combinations of load cases.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "description/experiment/experiment_text.h"

namespace taut::description {

/// Adds the load per length of the selected members to the forces of `out`, half of each member's
/// (of each span's, for a cable) at either end.
void AddLineLoad(const LineLoadText& load, const RobotSpec& robot, const Scope& scope,
                 LoadCaseSpec& out);

/// Appends the combinations to `cases`, which they name. `names`: all names so far.
void AddCombinations(const std::vector<LoadCombinationText>& combinations, const RobotSpec& robot,
                     std::map<std::string, SourceRef>& names, const Scope& scope,
                     std::vector<LoadCaseSpec>& cases);

/// Reports a name that occurs twice. Returns whether it did not.
bool IsNewCase(const Placed& name, std::map<std::string, SourceRef>& names, const Scope& scope);

}  // namespace taut::description
