/// Orientation of a beam (box along a pair).
#pragma once

#include <cmath>

#include "math/vec.h"

namespace taut::description {

/// Returns q_PartBeam of a beam along the unit vector u, in the part's frame: x along the beam, y
/// horizontal, z upward. A beam along z has its y along the part's y.
inline Quat BeamOrientation(const Vec3& u) {
  // Yaw about z to the horizontal direction of u, then pitch about the new y. The larger of cos and
  // sin of the half angle is computed by a square root, the smaller one by a quotient. This avoids
  // cancellation at small angles.
  const double level = std::sqrt(u.x * u.x + u.y * u.y);
  const double c = level > 1e-12 ? u.x / level : 1.0, s = level > 1e-12 ? u.y / level : 0.0;
  const double larger = std::sqrt(0.5 * (1.0 + std::fabs(c))),
               smaller = std::fabs(s) / (2 * larger);
  const double half_c = c >= 0.0 ? larger : smaller;
  const double half_s = std::copysign(c >= 0.0 ? smaller : larger, s);
  const double pitch_c = std::sqrt(0.5 * (1.0 + level)), pitch_s = -u.z / (2 * pitch_c);
  return Quat{half_c, 0.0, 0.0, half_s} * Quat{pitch_c, 0.0, pitch_s, 0.0};
}

}  // namespace taut::description
