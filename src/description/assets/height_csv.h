/// Heights as a CSV file without a header.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "trace/table_budget.h"

namespace taut::description {

struct HeightTable {
  int columns = 0, rows = 0;
  std::vector<double> height_m;  ///< Row by row, from the first line.
};

/// Reads one row per line; empty lines and lines that begin with # do not count. Returns nothing
/// after an error: numbers that are not finite, rows of unequal length, more numbers than the
/// budget has left. Adds them to the budget.
std::optional<HeightTable> ReadHeightCsv(const std::string& path, trace::TableBudget& budget,
                                         Diagnostics& out);

}  // namespace taut::description
