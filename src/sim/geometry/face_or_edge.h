/// Choice between face contact and edge contact of two polyhedra (separating axes).
#pragma once

#include "sim/geometry/touch_list.h"

namespace taut::sim {

/// Advantage that another axis needs to be selected, as a fraction of the depth and of the size of
/// the bodies. Order of preference: faces of `a`, faces of `b`, edges. This hysteresis avoids
/// frequent changes.
inline constexpr double kBetterShare = 0.05, kBetterSize = 1e-4;
/// Relative enlargement of a face before the other face is clipped against it, so that coincident
/// corners remain.
inline constexpr double kCutSlack = 1e-5;
/// Edges with a smaller sine of their angle count as parallel; faces are better axes for them.
inline constexpr double kParallelSin = 1e-3;

inline bool ClearlyBetter(double apart_m, double than_m, double size_m) noexcept {
  return apart_m > than_m + kBetterShare * Larger(-than_m, 0.0) + kBetterSize * size_m;
}

}  // namespace taut::sim
