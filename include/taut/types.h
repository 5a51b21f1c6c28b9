/// Small plain types that every other header of taut shares.
#pragma once

#include <cstdint>

namespace taut {

/// A 3-vector. Its unit and frame are stated where it is declared.
struct Vec3 {
  double x = 0.0, y = 0.0, z = 0.0;
  bool operator==(const Vec3&) const = default;
};

/// A unit quaternion, order w, x, y, z. `q_WB` turns vectors of frame B into frame W.
struct Quat {
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
  bool operator==(const Quat&) const = default;
};

/// A symmetric 3x3 inertia matrix [kg m^2] about the centre of mass; frame stated where declared.
/// Off-diagonal entries are the matrix entries (minus the products of inertia).
struct Inertia {
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
  bool operator==(const Inertia&) const = default;
};

/// "The world" where a body index is asked for: a fixed point, not a body.
inline constexpr int kWorld = -1;

}  // namespace taut
