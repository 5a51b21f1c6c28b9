/// Continuous collision detection: tests whether two shapes with a gap that is predicted to close
/// within the step really meet. The prediction uses the present gap and normal. At high speed, this
/// prediction alone would deflect shapes that pass by each other.
#pragma once

#include <stdint.h>

#include "sim/geometry/shape_contacts.h"

namespace taut::sim {

/// Shape, and its motion during a step.
struct MovingShape {
  const Shape* shape;         ///< In the frame of the body.
  ShapePose at;               ///< Pose at the middle of the step.
  double v[3], w[3];          ///< Velocity of the body without contact forces [m/s], [rad/s].
  double bound_m;             ///< Largest distance of a body point from the center [m].
  bool goes_on;               ///< The terrain may continue in the same plane next to the contact.
  NearParts* kept = nullptr;  ///< Cache of a round shape on a surface (TouchGround), or null.
};

/// Returns a bit mask of the `points` that are open now and closed after `step_s` at their present
/// rates.
uint32_t ClosingPoints(const MovingShape& a, const MovingShape& b, double step_s,
                       const TouchPoint* points, int count) noexcept;

/// Follows the shapes through the step (conservative advancement). Removes the points of `closing`
/// that do not close. The remaining points get the normal at the time of contact and the
/// corresponding gap. Returns the number of remaining points.
int KeepMeeting(const MovingShape& a, const MovingShape& b, double step_s, uint32_t closing,
                TouchPoint* points, int count) noexcept;

}  // namespace taut::sim
