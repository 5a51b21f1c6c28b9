/// Dual numbers for forward-mode automatic differentiation: a number and its derivative with
/// respect to one variable, in place of a SIMD number. A step compiled for it computes the step of
/// a single world and its derivative with respect to the start, by the chain rule for every
/// operation.
///
/// Comparisons and selections depend only on the number, so the derivative belongs to the chosen
/// branch. In memory, a Dual is two doubles, like a SIMD number with two lanes.
#pragma once

#include "simd/wide_angle.h"

namespace taut::simd {

struct DualMask {
  bool v;
  bool operator[](int) const noexcept { return v; }
  void Set(int, bool x) noexcept { v = x; }
  static DualMask Splat(bool x) noexcept { return {x}; }
};

struct Dual {
  static constexpr int kLanes = 1;
  double v, d;
  static Dual Splat(double x) noexcept { return {x, 0.0}; }
  double operator[](int) const noexcept { return v; }
  void Set(int, double x) noexcept { v = x, d = 0.0; }
};

template <>
struct LaneOf<Dual> {
  using Type = Dual;
};

/// Returns the product, but 0 for a zero derivative even if the factor is infinite. Guards such as
/// 1e300 may overflow, but the guarded values are not selected.
TAUT_INLINE double DualPart(double derivative, double factor) noexcept {
  return derivative == 0.0 ? 0.0 : derivative * factor;
}

TAUT_INLINE Dual operator+(Dual a, Dual b) noexcept { return {a.v + b.v, a.d + b.d}; }
TAUT_INLINE Dual operator-(Dual a, Dual b) noexcept { return {a.v - b.v, a.d - b.d}; }
TAUT_INLINE Dual operator-(Dual a) noexcept { return {-a.v, -a.d}; }
TAUT_INLINE Dual operator*(Dual a, Dual b) noexcept {
  return {a.v * b.v, DualPart(a.d, b.v) + DualPart(b.d, a.v)};
}
TAUT_INLINE Dual operator/(Dual a, Dual b) noexcept {
  const double quotient = a.v / b.v;
  return {quotient, DualPart(a.d - DualPart(b.d, quotient), 1.0 / b.v)};
}
TAUT_INLINE DualMask operator<(Dual a, Dual b) noexcept { return {a.v < b.v}; }
TAUT_INLINE DualMask operator>(Dual a, Dual b) noexcept { return {a.v > b.v}; }
TAUT_INLINE DualMask operator==(Dual a, Dual b) noexcept { return {a.v == b.v}; }
TAUT_INLINE DualMask operator&(DualMask a, DualMask b) noexcept { return {a.v && b.v}; }
TAUT_INLINE DualMask operator|(DualMask a, DualMask b) noexcept { return {a.v || b.v}; }
TAUT_INLINE DualMask operator!(DualMask a) noexcept { return {!a.v}; }
TAUT_INLINE Dual Select(DualMask m, Dual yes, Dual no) noexcept { return m.v ? yes : no; }
TAUT_INLINE bool Any(DualMask m) noexcept { return m.v; }
TAUT_INLINE Dual Max(Dual a, Dual b) noexcept { return a.v > b.v ? a : b; }
TAUT_INLINE Dual Min(Dual a, Dual b) noexcept { return a.v < b.v ? a : b; }
TAUT_INLINE Dual Abs(Dual a) noexcept { return Max(a, -a); }
/// At 0, the derivative does not exist and is set to 0. Roots of 0 are not selected.
TAUT_INLINE Dual Sqrt(Dual a) noexcept {
  const double root = __builtin_sqrt(a.v);
  return {root, a.v > 0.0 ? DualPart(a.d, 0.5 / root) : 0.0};
}
/// The function is constant between its jumps, so the derivative is 0.
TAUT_INLINE Dual Round(Dual a) noexcept { return {taut::Round(a.v), 0.0}; }
TAUT_INLINE Dual& operator+=(Dual& a, Dual b) noexcept { return a = a + b; }
TAUT_INLINE Dual& operator-=(Dual& a, Dual b) noexcept { return a = a - b; }
TAUT_INLINE Dual& operator*=(Dual& a, Dual b) noexcept { return a = a * b; }

}  // namespace taut::simd
