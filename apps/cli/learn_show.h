/// What `taut learn` shows of a study's folder.
#pragma once

#include <string>
#include <vector>

namespace taut::cli {

/// Runs the winner once more: trace, summary, inputs and report in the folder's best/.
int ReplayBest(const std::string& folder, bool skip_damaged, bool quiet);

/// A table (or JSON) of the best `count`.
int PrintTop(const std::string& folder, int count, bool skip_damaged, bool json);

/// What was damaged and not used, a line each on stderr.
void WarnOfDamage(const std::string& folder, const std::vector<std::string>& skipped);

}  // namespace taut::cli
