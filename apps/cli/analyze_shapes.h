/// `taut analyze --out`: shapes to look at.
#pragma once

#include <string>

#include "analyze_report.h"
#include "commands.h"

namespace taut::cli {

/// Writes modes, mechanisms and states of self-stress as runs below `folder` and says which on
/// stdout, or stderr if that has JSON. Modes of several load cases have a folder a case. Returns
/// the exit status.
int WriteShapes(const std::string& folder, const ExperimentSpec& experiment,
                const AnalysisResult& result, int most_modes, bool json);

}  // namespace taut::cli
