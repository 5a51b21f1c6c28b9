/// Vectors, quaternions and inertia matrices: plain types for all headers of taut.
#pragma once

#include <cstdint>

namespace taut {

/// 3-vector. The declaration of each variable gives its unit and frame.
struct Vec3 {
  double x = 0.0, y = 0.0, z = 0.0;
  bool operator==(const Vec3&) const = default;
};

/// Unit quaternion, order w, x, y, z. `q_WB` rotates vectors of frame B into frame W.
struct Quat {
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
  bool operator==(const Quat&) const = default;
};

/// Symmetric 3x3 inertia matrix [kg m^2] about the center of mass. Declarations give its frame.
/// Off-diagonal entries are matrix entries (minus the products of inertia).
struct Inertia {
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
  bool operator==(const Inertia&) const = default;
};

/// Body index of the world, which is a fixed reference and not a body.
inline constexpr int kWorld = -1;

}  // namespace taut
