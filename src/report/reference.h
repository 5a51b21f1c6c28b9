/// Comparison of a run with the reference values that an experiment contains.
#pragma once

#include <string>
#include <vector>

#include "taut/run.h"

namespace taut::report {

std::string StatisticName(const ReferenceSpec& reference);  ///< "mean", "min" or "max".
std::string QuantityName(const ReferenceSpec& reference);   ///< "tension" or "elastic".

/// Returns the run's value for a cable of the reference [N]; NaN if the run ended before.
double OurValue(const RunSummary& run, const ReferenceSpec& reference, int cable);

/// Returns one line per reference, without a line end: its source and the largest difference.
std::vector<std::string> ReferenceDifferences(const RunSummary& run);

/// Returns, for each reference, its description and largest difference; empty without any.
std::string ReferenceLines(const RunSummary& run);

}  // namespace taut::report
