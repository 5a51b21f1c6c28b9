/// Continuous collision detection: whether two shapes whose gap is forecast to close within the
/// step really meet. A contact row forecasts with the present gap and normal; at speed, it would
/// deflect shapes that pass by each other.
#pragma once

#include <stdint.h>

#include "sim/geometry/shape_contacts.h"

namespace taut::sim {

/// A shape and its motion during a step.
struct MovingShape {
  const Shape* shape;         ///< In the body's frame.
  ShapePose at;               ///< Pose at the middle of the step.
  double v[3], w[3];          ///< Velocity of the body without contacts [m/s], [rad/s].
  double bound_m;             ///< Largest distance of a point of the body from its center [m].
  bool goes_on;               ///< The terrain may continue in the same plane next to the contact.
  NearParts* kept = nullptr;  ///< Cache of a round shape on ground (TouchGround); may be null.
};

/// Returns a bit mask of the `points` that are open now and closed after `step_s` at their present
/// rates.
uint32_t ClosingPoints(const MovingShape& a, const MovingShape& b, double step_s,
                       const TouchPoint* points, int count) noexcept;

/// Follows the shapes through the step (conservative advancement). Removes the points of `closing`
/// that do not close; gives the others the normal of the moment of contact and the gap that belongs
/// to it. Returns the number of remaining points.
int KeepMeeting(const MovingShape& a, const MovingShape& b, double step_s, uint32_t closing,
                TouchPoint* points, int count) noexcept;

}  // namespace taut::sim
