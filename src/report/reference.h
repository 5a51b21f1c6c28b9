/// Ours beside the numbers of others that an experiment names.
#pragma once

#include <string>

#include "taut/run.h"

namespace taut::report {

std::string StatisticName(const ReferenceSpec& reference);  ///< "mean", "min" or "max".
std::string QuantityName(const ReferenceSpec& reference);   ///< "tension" or "elastic".

/// The run's number for a cable of the reference [N]; NaN if the run did not get that far.
double OurValue(const RunSummary& run, const ReferenceSpec& reference, int cable);

/// For each reference what it is and where it is farthest off; empty without any.
std::string ReferenceLines(const RunSummary& run);

}  // namespace taut::report
