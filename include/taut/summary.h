/// Run summary as JSON, as a few lines and as tables (docs/formats/summary.md).
#pragma once

#include <string>
#include <vector>

#include "taut/run.h"

namespace taut {

/// Returns the content of a run's summary.json: one JSON object, keys always in the same order.
/// Values that were not reached (a phase after an interruption) are null.
std::string SummaryJson(const RunSummary& summary);

/// Returns the short summary of a run for a terminal, without line ends: the verdict, problems, the
/// largest loads, deviations from reference values.
std::vector<std::string> SummaryLines(const RunSummary& summary);

/// Returns tables for a terminal of 100 columns: tension of every cable in every phase, largest
/// tension of the robot, drag forces, demands on actuators, deviations from the experiment's
/// reference values.
std::string SummaryTable(const RunSummary& summary);

/// Returns the line on settling, without a line end: its displacement, and all cables that went
/// slack.
std::string StartLine(const StartChange& start);

}  // namespace taut
