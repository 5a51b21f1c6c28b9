/// Rigid registration: least-squares rigid motion between two sets of points.
#pragma once

#include <span>

#include "taut/types.h"

namespace taut {

/// Rotation about one center, which moves to the other.
struct RigidMotion {
  Vec3 from_center_m, to_center_m;
  Quat turn;

  Vec3 Of(const Vec3& point_m) const noexcept;
};

/// Returns the rigid motion that brings points closest to others, pair by pair, in least squares.
/// `to_m` must have as many points as `from_m`; without points the motion is the identity.
RigidMotion Align(std::span<const Vec3> from_m, std::span<const Vec3> to_m);

}  // namespace taut
