/// Output of `taut learn` from a study's folder: best results, replay, damaged records.
#pragma once

#include <string>
#include <vector>

namespace taut::cli {

/// Runs the best candidate once more and writes trace, summary, inputs and report to the folder's
/// best/.
int ReplayBest(const std::string& folder, bool skip_damaged, bool tables, bool quiet);

/// Prints the best `count` results as a table or JSON.
int PrintTop(const std::string& folder, int count, bool skip_damaged, bool json);

/// Lists the damaged records that were skipped, one line each, on stderr.
void WarnOfDamage(const std::string& folder, const std::vector<std::string>& skipped);

}  // namespace taut::cli
