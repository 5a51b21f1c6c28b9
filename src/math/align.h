/// The rigid motion between two sets of points.
#pragma once

#include <span>

#include "taut/types.h"

namespace taut {

/// Turns about one centre, which goes to the other.
struct RigidMotion {
  Vec3 from_center_m, to_center_m;
  Quat turn;

  Vec3 Of(const Vec3& point_m) const noexcept;
};

/// The rigid motion that brings points closest to others, pair by pair, in least squares. As many
/// in `to_m` as in `from_m`; without points nothing moves.
RigidMotion Align(std::span<const Vec3> from_m, std::span<const Vec3> to_m);

}  // namespace taut
