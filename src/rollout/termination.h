/// Conditions and measures of an episode, evaluated at intervals: falls, failure by excessive
/// speed, distance, tension penalty.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "math/vec.h"
#include "taut/objective.h"
#include "taut/world_batch.h"

namespace taut::rollout {

/// Returns whether the tilt of any body (angle between its vertical axis and the world's) exceeds
/// the limit.
template <class OrientationOf>
bool AnyTilted(std::size_t count, const OrientationOf& orientation_of, double cos_max_tilt) {
  bool tilted = false;
  for (std::size_t b = 0; b < count; ++b) {
    const Quat q = orientation_of(b);
    tilted = tilted || 1.0 - 2.0 * (q.x * q.x + q.y * q.y) < cos_max_tilt;
  }
  return tilted;
}
inline bool AnyTilted(std::span<const BodyState> bodies, double cos_max_tilt) {
  return AnyTilted(
      bodies.size(), [&](std::size_t b) { return bodies[b].orientation; }, cos_max_tilt);
}

/// Returns whether the height of the center of mass is outside its limits.
inline bool BeyondHeights(const FallSpec& fall, double height_m) {
  return (fall.min_height_m && height_m < *fall.min_height_m) ||
         (fall.max_height_m && height_m > *fall.max_height_m);
}

/// Returns the last body whose speed exceeds the limit or is NaN; kWorld if there is none.
template <class VelocityOf>
int TooFast(std::size_t count, const VelocityOf& velocity_of, double max_speed_m_per_s) {
  int found = kWorld;
  for (std::size_t b = 0; b < count; ++b) {
    const Vec3 v = velocity_of(b);
    if (!(std::sqrt(Dot(v, v)) <= max_speed_m_per_s)) found = static_cast<int>(b);
  }
  return found;
}
inline int TooFast(std::span<const BodyState> bodies, double max_speed_m_per_s) {
  return TooFast(
      bodies.size(), [&](std::size_t b) { return bodies[b].velocity_m_per_s; }, max_speed_m_per_s);
}

/// Returns the horizontal distance of a displacement [m].
inline double DistanceOf(const Vec3& way) { return std::sqrt(way.x * way.x + way.y * way.y); }

/// Returns the penalty for exceeding the limit. `max_tension_n`: largest tension of any cable so
/// far.
inline double TensionPenalty(const TensionLimit& limit, double max_tension_n) {
  const double above_n = max_tension_n - limit.limit_n;
  return limit.penalty_per_n * (above_n > 0.0 ? above_n : 0.0);
}

}  // namespace taut::rollout
