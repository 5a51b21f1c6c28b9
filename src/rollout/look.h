/// What one sees of a world who judges it, now and then: the laws of falling, of blowing up, of the
/// way that a robot has made.
#pragma once

#include <cmath>
#include <span>

#include "math/vec.h"
#include "taut/batch.h"
#include "taut/objective.h"

namespace taut::rollout {

/// Whether the angle between a body's own vertical and the world's is beyond the limit.
inline bool AnyTilted(std::span<const BodyState> bodies, double cos_max_tilt) {
  bool tilted = false;
  for (const BodyState& body : bodies) {
    const Quat& q = body.orientation;
    tilted = tilted || 1.0 - 2.0 * (q.x * q.x + q.y * q.y) < cos_max_tilt;
  }
  return tilted;
}

/// Of the centre of mass.
inline bool BeyondHeights(const FallSpec& fall, double height_m) {
  return (fall.min_height_m && height_m < *fall.min_height_m) ||
         (fall.max_height_m && height_m > *fall.max_height_m);
}

/// The last body that is faster, or not a number; kWorld: none.
inline int TooFast(std::span<const BodyState> bodies, double max_speed_m_per_s) {
  int found = kWorld;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Vec3& v = bodies[b].velocity_m_per_s;
    if (!(std::sqrt(Dot(v, v)) <= max_speed_m_per_s)) found = static_cast<int>(b);
  }
  return found;
}

/// The part of a way that counts as distance [m].
inline double DistanceOf(const Vec3& way) { return std::sqrt(way.x * way.x + way.y * way.y); }

/// What exceeding the limit costs; `max_tension_n`: of any cable, ever.
inline double TensionPenalty(const TensionLimit& limit, double max_tension_n) {
  const double above_n = max_tension_n - limit.limit_n;
  return limit.penalty_per_n * (above_n > 0.0 ? above_n : 0.0);
}

}  // namespace taut::rollout
