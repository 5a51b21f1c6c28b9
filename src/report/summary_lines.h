/// Lines that the short and the full summary of a run share.
#pragma once

#include <string>
#include <vector>

#include "taut/run.h"

namespace taut::report {

/// Returns lines with the verdict, the effect of settling, and problems.
std::vector<std::string> HeadLines(const RunSummary& run);

}  // namespace taut::report
