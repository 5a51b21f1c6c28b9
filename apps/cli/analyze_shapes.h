/// Shapes to view (`taut analyze --out`).
#pragma once

#include <string>

#include "analyze_report.h"
#include "commands.h"

namespace taut::cli {

/// Writes modes, mechanisms and states of self-stress as runs below `folder` and lists them on
/// stdout, or on stderr if stdout has JSON. Modes of several load cases get one folder per case.
/// Returns the exit status.
int WriteShapes(const std::string& folder, const ExperimentSpec& experiment,
                const AnalysisResult& result, int most_modes, bool json);

}  // namespace taut::cli
