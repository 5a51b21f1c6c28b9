/// Python program that draws figures with matplotlib (python/taut/plot.py).
#pragma once

#include <optional>
#include <string>

#include "taut/diagnostics.h"

namespace taut::cli {

/// Returns the bytes of the figure that `request` (JSON) describes. On failure, returns nothing and
/// adds an error. Python is `$TAUT_PYTHON`; without it, the first of `python3` and
/// `/usr/bin/python3` that has matplotlib.
std::optional<std::string> DrawFigure(const std::string& request, Diagnostics& out);

}  // namespace taut::cli
