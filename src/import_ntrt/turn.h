/// How NTRT turns vectors onto each other, in its own frame (y up).
#pragma once

#include <cmath>

#include "math/vec.h"

namespace taut::import_ntrt {

inline double Length(const Vec3& v) { return std::sqrt(Dot(v, v)); }
inline Vec3 Unit(const Vec3& v) { return (1.0 / Length(v)) * v; }

/// About an axis of any length but zero.
inline Quat About(const Vec3& axis, double angle_rad) {
  const Vec3 v = (std::sin(0.5 * angle_rad) / Length(axis)) * axis;
  return {std::cos(0.5 * angle_rad), v.x, v.y, v.z};
}

/// The shortest turn from a to b. As in NTRT's tgUtil directions within 1e-5 of each other are the
/// same, which leaves them as they are; opposite ones are turned half about `fallback`, or, where
/// that is zero, about x.
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
