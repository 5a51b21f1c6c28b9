/// Crossing of a straight cable span and a rod's axis, seen along their common normal. A step
/// includes this header, so it does not use the standard library.
#pragma once

#include "math/scalar.h"

namespace taut::sim {

/// Crossing of two lines, seen along their common normal, which has length `norm` before
/// normalization. `V`: vector of one lane or of all lanes.
template <class V>
struct Crossing {
  using S = decltype(V::x);
  S across;  ///< Distance of the axis from the span * `norm` [m].
  S norm2;   ///< `norm`^2.
  /// Positions of the crossing, each times norm2: on the span, 0 to 1, and on the axis from its
  /// middle [m].
  S along_p;
  S along_a;
};
template <class V>
TAUT_INLINE Crossing<V> CrossingOf(const V& from, const V& to, const V& center,
                                   const V& axis) noexcept {
  const V d = to - from, w = center - from, n = Cross(d, axis);
  return {Dot(n, w), Dot(n, n), Dot(Cross(w, axis), n), Dot(Cross(w, d), n)};
}

/// Returns whether the lines cross within the span and the rod.
template <class V, class S>
TAUT_INLINE auto CrossWithin(const Crossing<V>& x, S half) noexcept {
  const auto zero = Constant<S>::Of(0.0);
  return (x.along_p > zero) & (x.along_p < x.norm2) & (Abs(x.along_a) < half * x.norm2);
}

/// Returns the side of the axis on which the span passes: -1 or 1; 0 without a crossing.
template <class V, class S>
TAUT_INLINE S SideOf(const Crossing<V>& x, S half) noexcept {
  using C = Constant<S>;
  const S side = Select(x.across < C::Of(0.0), C::Of(-1.0), C::Of(1.0));
  return Select(CrossWithin(x, half), side, C::Of(0.0));
}

}  // namespace taut::sim
