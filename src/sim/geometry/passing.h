/// Whether two shapes that a step's forecast closes do meet. A row forecasts with a gap and a
/// normal of now; at speed, shapes that pass by each other would be deflected by it.
#pragma once

#include <stdint.h>

#include "sim/geometry/shape_contacts.h"

namespace taut::sim {

/// A shape on its way through a step.
struct MovingShape {
  const Shape* shape;         ///< In the body's frame.
  ShapePose at;               ///< Now, at the middle of the step.
  double v[3], w[3];          ///< Of its body, without contacts [m/s], [rad/s].
  double bound_m;             ///< No point of the body is further from its centre.
  bool goes_on;               ///< Beside what it touches it may go on, in the same plane.
  NearParts* kept = nullptr;  ///< Of a round one that meets ground (TouchGround).
};

/// A bit for each of `points` that is open now and closed after `step_s`, if nothing turns.
uint32_t ClosingPoints(const MovingShape& a, const MovingShape& b, double step_s,
                       const TouchPoint* points, int count) noexcept;

/// Follows the shapes through the step. Of the points `closing`, those that do not close go; those
/// that do get the normal, and the gap that belongs to it, of the moment when the shapes touch.
/// Returns how many are left.
int KeepMeeting(const MovingShape& a, const MovingShape& b, double step_s, uint32_t closing,
                TouchPoint* points, int count) noexcept;

}  // namespace taut::sim
