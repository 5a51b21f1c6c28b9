/// Page of a static analysis: one HTML file with the structure under each load case.
#pragma once

#include <string>

#include "analyze_report.h"
#include "taut/spec.h"

namespace taut::cli {

/// Writes the page of an analysis. `experiment`: analyzed robot and its surroundings. `most_modes`:
/// maximum number of modes per load case. Returns the exit status, after messages on stderr.
int WriteAnalysisPage(const std::string& path, const ExperimentSpec& experiment,
                      const AnalysisResult& result, int most_modes);

}  // namespace taut::cli
