/// Comparison of a run with the reference values in its experiment.
#pragma once

#include <string>
#include <vector>

#include "taut/run.h"

namespace taut::report {

std::string StatisticName(const ReferenceSpec& reference);  ///< "mean", "min" or "max".
std::string QuantityName(const ReferenceSpec& reference);   ///< "tension" or "elastic".

/// Returns the value of the run for a cable of the reference [N]. NaN if the run ended too early.
double OurValue(const RunSummary& run, const ReferenceSpec& reference, int cable);

/// Returns one line per reference, without line end: its source and the largest difference.
std::vector<std::string> ReferenceDifferences(const RunSummary& run);

/// Returns the description and largest difference of each reference. Empty without references.
std::string ReferenceLines(const RunSummary& run);

}  // namespace taut::report
