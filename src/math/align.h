/// Rigid registration: least-squares rigid motion between two sets of points.
#pragma once

#include <span>

#include "taut/types.h"

namespace taut {

/// Rigid motion: maps one center to another and rotates about it.
struct RigidMotion {
  Vec3 from_center_m, to_center_m;
  Quat turn;

  Vec3 Of(const Vec3& point_m) const noexcept;
};

/// Returns the rigid motion that maps each point of `from_m` as closely as possible to its partner
/// in `to_m`, in the least-squares sense. Both sets must have the same size; without points, the
/// result is the identity.
RigidMotion Align(std::span<const Vec3> from_m, std::span<const Vec3> to_m);

}  // namespace taut
