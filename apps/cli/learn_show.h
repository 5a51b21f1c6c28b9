/// What `taut learn` shows of a study's folder.
#pragma once

#include <string>

namespace taut::cli {

/// Runs the winner once more: trace, summary, inputs and report in the folder's best/.
int ReplayBest(const std::string& folder, bool quiet);

/// A table (or JSON) of the best `count`.
int PrintTop(const std::string& folder, int count, bool json);

}  // namespace taut::cli
