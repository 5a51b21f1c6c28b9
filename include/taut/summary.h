/// What a run has to say, for people and for programs (docs/formats/summary.md).
#pragma once

#include <string>

#include "taut/run.h"

namespace taut {

/// The content of a run's summary.json: one JSON object, keys always in the same order. What was
/// not reached (a phase after an interruption) is null.
std::string SummaryJson(const RunSummary& summary);

/// Tables for a terminal of 100 columns: tension of every cable in every phase, the largest of the
/// system, drag forces, what the actuators had to do, how far off the numbers are
/// that the experiment names.
std::string SummaryTable(const RunSummary& summary);

/// The line of the table about settling: how far it went, all cables that went slack.
std::string StartLine(const StartChange& start);

}  // namespace taut
