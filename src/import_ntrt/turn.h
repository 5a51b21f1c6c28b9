/// Rotations between vectors as NTRT computes them, in NTRT's frame (y up).
#pragma once

#include <cmath>

#include "math/vec.h"

namespace taut::import_ntrt {

inline Vec3 Unit(const Vec3& v) { return (1.0 / Length(v)) * v; }

/// Returns the rotation about an axis, which may have any nonzero length.
inline Quat About(const Vec3& axis, double angle_rad) {
  const Vec3 v = (std::sin(0.5 * angle_rad) / Length(axis)) * axis;
  return {std::cos(0.5 * angle_rad), v.x, v.y, v.z};
}

/// Returns the shortest rotation from a to b. As in NTRT's tgUtil, directions within 1e-5 count as
/// equal, which gives the identity. Opposite directions give a half turn about `fallback`, or about
/// x if `fallback` is zero.
inline Quat Between(const Vec3& a, const Vec3& b, const Vec3& fallback) {
  constexpr double kSame = 1e-5;
  const Vec3 from = Unit(a), to = Unit(b);
  if (Length(from - to) < kSame) return {};
  if (Length(from + to) < kSame) {
    return About(Length(fallback) > 0.0 ? fallback : Vec3{1, 0, 0}, std::acos(-1.0));
  }
  return About(Cross(from, to), std::acos(std::fmin(1.0, std::fmax(-1.0, Dot(from, to)))));
}

}  // namespace taut::import_ntrt
