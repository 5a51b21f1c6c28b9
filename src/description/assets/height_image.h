/// Heights from gray-scale PNG images; dark is low.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "trace/table_budget.h"

namespace taut::description {

struct HeightImage {
  int columns = 0, rows = 0;
  int bits = 0;                ///< Per sample, 1 to 16.
  std::vector<double> shares;  ///< 0 black, 1 white; row by row, from the lowest row up.
};

/// Reads a PNG of gray samples as stored: no gamma, no color profile. Returns nothing and reports
/// an error for other files, for colors, or for samples beyond the budget, to which they are added
/// before memory is allocated.
std::optional<HeightImage> ReadHeightImage(const std::string& path, trace::TableBudget& budget,
                                           Diagnostics& out);

}  // namespace taut::description
