/// Reader of terrain heights from a CSV file without a header.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "trace/table_budget.h"

namespace taut::description {

struct HeightTable {
  int columns = 0, rows = 0;
  std::vector<double> height_m;  ///< Row by row, in the order of the file's lines.
};

/// Reads one row of heights per line. Ignores empty lines and lines that begin with #. Adds the
/// number of values to `budget`. Returns nothing after an error: values that are not finite, rows
/// of unequal length, or an exceeded budget.
std::optional<HeightTable> ReadHeightCsv(const std::string& path, trace::TableBudget& budget,
                                         Diagnostics& out);

}  // namespace taut::description
