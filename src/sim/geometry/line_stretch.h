/// Segment of a line, clipped by half spaces.
#pragma once

#include "sim/geometry/touch_list.h"

namespace taut::sim {

/// Segment of a line, between two positions from 0 to 1.
struct LineStretch {
  double low, high;
  /// Keeps the part with `at + position * slope` <= 0.
  void CutAbove(double at, double slope) noexcept {
    if (slope > 0.0) {
      high = Smaller(high, -at / slope);
    } else if (slope < 0.0) {
      low = Larger(low, -at / slope);
    } else if (at > 0.0) {
      high = low - 1.0;
    }
  }
};

}  // namespace taut::sim
