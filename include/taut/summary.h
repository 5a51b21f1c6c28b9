/// Run summary as JSON, as a few lines, and as tables (docs/formats/summary.md).
#pragma once

#include <string>
#include <vector>

#include "taut/run.h"

namespace taut {

/// Returns the contents of summary.json: a JSON object with keys in a fixed order. Values that were
/// not reached are null, such as a phase after an interruption.
std::string SummaryJson(const RunSummary& summary);

/// Returns the short summary of a run for a terminal, one text per line without line ends: verdict,
/// problems, largest loads, deviations from reference values.
std::vector<std::string> SummaryLines(const RunSummary& summary);

/// Returns tables for a terminal with 100 columns: tension of every cable in every phase, largest
/// tension of the robot, drag forces, demands on actuators, deviations from reference values.
std::string SummaryTable(const RunSummary& summary);

/// Returns a line about settling, without line end: the displacement, and all cables that went
/// slack.
std::string StartLine(const StartChange& start);

}  // namespace taut
