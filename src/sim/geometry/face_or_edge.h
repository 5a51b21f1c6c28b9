/// Choice between face contact and edge contact of two polyhedra (separating axes).
#pragma once

#include "sim/geometry/touch_list.h"

namespace taut::sim {

/// Another axis must be better by this share of the depth, and of the bodies' size, to be
/// preferred: `b`'s faces over `a`'s, edges over faces. This hysteresis keeps the choice from
/// flickering.
inline constexpr double kBetterShare = 0.05, kBetterSize = 1e-4;
/// Relative enlargement of a face before the other face is clipped against it, so that corners on
/// corners remain.
inline constexpr double kCutSlack = 1e-5;
/// Edges at a smaller angle (as a sine) are parallel: faces are the better axes.
inline constexpr double kParallelSin = 1e-3;

inline bool ClearlyBetter(double apart_m, double than_m, double size_m) noexcept {
  return apart_m > than_m + kBetterShare * Larger(-than_m, 0.0) + kBetterSize * size_m;
}

}  // namespace taut::sim
