/// Shapes to view (`taut analyze --out`).
#pragma once

#include <string>

#include "analyze_report.h"
#include "commands.h"

namespace taut::cli {

/// Writes modes, mechanisms and states of self-stress as runs below `folder` and lists them on
/// stdout, or on stderr if stdout has JSON. Modes of several load cases get one folder per case.
/// Sets `to_view` to the trace of the first mode, else of the first shape. Returns the exit status.
int WriteShapes(const std::string& folder, const ExperimentSpec& experiment,
                const AnalysisResult& result, int most_modes, bool json, std::string& to_view);

}  // namespace taut::cli
