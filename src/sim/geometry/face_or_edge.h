/// Where bodies with flat faces meet: by a face of one of them, or edge on edge.
#pragma once

#include "sim/geometry/touch_list.h"

namespace taut::sim {

/// Another axis must be better by this share of the depth, and of the bodies' size, before it takes
/// over: `b`'s faces from `a`'s, edges from faces. So the choice does not flicker.
inline constexpr double kBetterShare = 0.05, kBetterSize = 1e-4;
/// Faces are this much larger when the other's corners are cut off, so that corners on corners
/// stay what they are.
inline constexpr double kCutSlack = 1e-5;
/// Edges at less than this angle are parallel: faces do better.
inline constexpr double kParallelSin = 1e-3;

inline bool ClearlyBetter(double apart_m, double than_m, double size_m) noexcept {
  return apart_m > than_m + kBetterShare * Larger(-than_m, 0.0) + kBetterSize * size_m;
}

}  // namespace taut::sim
