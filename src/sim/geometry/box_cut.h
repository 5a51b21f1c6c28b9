/// Entry and exit of a straight cable span through a terrain box (docs/theory/cables.md, section
/// 6), for one world or for all lanes. A step includes this header, so it does not use the standard
/// library.
#pragma once

#include "math/scalar.h"
#include "sim/geometry/shapes.h"

namespace taut::sim {

/// Span in the frame of a box that is enlarged by the cable's radius. Faces are numbered: face 2 i
/// has the outward normal -axis i, face 2 i + 1 has +axis i.
template <class V>
struct BoxCut {
  using S = decltype(V::x);
  S p[3], d[3], h[3];  ///< Start of the span, its vector, and half the edge lengths of the box [m].
  S from, to;          ///< Positions on the span, 0..1.
  S in, out;           ///< Faces; negative if the span starts or ends inside.

  TAUT_INLINE S Below(int face, S share) const noexcept {
    const S x = p[face / 2] + share * d[face / 2];
    return face % 2 == 1 ? h[face / 2] - x : h[face / 2] + x;
  }
  TAUT_INLINE S NearestFace(S share) const noexcept {
    S nearest = Constant<S>::Of(0.0), least = Below(0, share);
    for (int face = 1; face < 6; ++face) {
      const S below = Below(face, share);
      const auto less = below < least;
      nearest = Select(less, Constant<S>::Of(face), nearest);
      least = Select(less, below, least);
    }
    return nearest;
  }
};

/// Computes where a span enters and leaves a box. If a bend of the cable is inside, because the
/// cable is round, the span passes through the nearest face. `through`: false if the span misses
/// the box, stays at one face, or an end of the whole cable (`starts`, `ends`) is inside.
template <class V, class M>
TAUT_INLINE BoxCut<V> CutBox(const BoxShape& box, const V& from, const V& to, double radius_m,
                             M starts, M ends, M* through) noexcept {
  using S = decltype(V::x);
  using C = Constant<S>;
  const S zero = C::Of(0.0), one = C::Of(1.0);
  const V center{C::Of(box.center[0]), C::Of(box.center[1]), C::Of(box.center[2])};
  const V start = from - center, way = to - from;
  BoxCut<V> cut;
  cut.from = zero, cut.to = one, cut.in = cut.out = C::Of(-1.0);
  M hits = zero < one;
  for (int i = 0; i < 3; ++i) {
    const double* const a = box.axes + 3 * i;
    const V axis{C::Of(a[0]), C::Of(a[1]), C::Of(a[2])};
    const S p = cut.p[i] = Dot(axis, start), d = cut.d[i] = Dot(axis, way);
    const S h = cut.h[i] = C::Of(box.half_m[i] + radius_m);
    const M along = d == zero;  // parallel to the faces: between them or outside
    hits = hits & ((!along) | (Abs(p) < h));
    const S low = C::Of(2 * i), high = C::Of(2 * i + 1);
    const M rises = d > zero;
    const S divisor = Select(along, one, d);
    const S enters = (Select(rises, zero - h, h) - p) / divisor;
    const S leaves = (Select(rises, h, zero - h) - p) / divisor;
    const M later = (!along) & (enters > cut.from), sooner = (!along) & (leaves < cut.to);
    cut.from = Select(later, enters, cut.from), cut.to = Select(sooner, leaves, cut.to);
    cut.in = Select(later, Select(rises, low, high), cut.in);
    cut.out = Select(sooner, Select(rises, high, low), cut.out);
  }
  const M starts_inside = cut.in < zero, ends_inside = cut.out < zero;
  hits = hits & (cut.from < cut.to) & !((starts_inside & starts) | (ends_inside & ends));
  cut.in = Select(starts_inside, cut.NearestFace(cut.from), cut.in);
  cut.out = Select(ends_inside, cut.NearestFace(cut.to), cut.out);
  *through = hits & !(cut.in == cut.out);
  return cut;
}

/// Returns the number of the edge between two faces, among the edges of its box.
template <class S>
TAUT_INLINE S NumberOfEdge(S face, S other) noexcept {
  return Constant<S>::Of(6.0) * Min(face, other) + Max(face, other);
}

}  // namespace taut::sim
