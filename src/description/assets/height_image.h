/// Heights as an image: gray, dark is low.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::description {

struct HeightImage {
  int columns = 0, rows = 0;
  int bits = 0;                ///< Of a sample, 1 to 16.
  std::vector<double> shares;  ///< 0 black, 1 white; row by row, from the lowest row up.
};

/// A PNG of gray samples, as they are: no gamma, no profile. Nothing and a complaint if it is none,
/// or has colours, or more than `most` samples.
std::optional<HeightImage> ReadHeightImage(const std::string& path, double most, Diagnostics& out);

}  // namespace taut::description
