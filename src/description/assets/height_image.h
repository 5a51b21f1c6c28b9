/// Reader of terrain heights from gray-scale PNG images; dark pixels are low.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "trace/table_budget.h"

namespace taut::description {

struct HeightImage {
  int columns = 0, rows = 0;
  int bits = 0;                ///< Bits per sample, 1 to 16.
  std::vector<double> shares;  ///< 0 black to 1 white; row by row, starting with the bottom row of
                               ///< the image.
};

/// Reads a gray-scale PNG without gamma correction or color profile. Adds the number of samples to
/// `budget` before memory is allocated. Returns nothing and reports an error for other files, color
/// images, or an exceeded budget.
std::optional<HeightImage> ReadHeightImage(const std::string& path, trace::TableBudget& budget,
                                           Diagnostics& out);

}  // namespace taut::description
