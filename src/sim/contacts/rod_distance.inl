/// Lower bound of the distance between spheres and capsules, in all lanes at once. This bound only
/// determines whether contacts are computed, so it may differ in rounding from the distance in
/// shape_contacts.cpp.
#pragma once

#include "sim/data/rows.h"

namespace taut::sim {

template <class W>
V3<W> ShapeCenter(const View& m, const Rows<W>& s, const Scratch<W>& work, int shape) noexcept {
  const ShapeTable& t = m.shapes[shape];
  const V3<W> p = work.bodies[t.body].R * simd::Splat3<W>(t.center_P);
  return t.body < m.body_count ? s.pos[t.body] + p : p;
}

/// Centerline of a round shape in W: from center - half to center + half.
template <class W>
struct CenterLine {
  V3<W> center, half;
};

template <class W>
CenterLine<W> CenterLineOf(const View& m, const Rows<W>& s, const Scratch<W>& work,
                           int shape) noexcept {
  const ShapeTable& t = m.shapes[shape];
  const RoundShape& round = t.shape_P.round;
  const M3<W>& R = work.bodies[t.body].R;
  const double half[3] = {0.5 * (round.to[0] - round.from[0]), 0.5 * (round.to[1] - round.from[1]),
                          0.5 * (round.to[2] - round.from[2])};
  return {ShapeCenter(m, s, work, shape), R * simd::Splat3<W>(half)};
}

/// Returns a lower bound of the distance between two centerlines: the distance of their nearest
/// points minus the rounding error for nearly parallel lines.
template <class W>
W LineDistance(const CenterLine<W>& a, const CenterLine<W>& b) noexcept {
  constexpr double kRounding = 1e-7;
  const W zero = W::Splat(0.0), one = W::Splat(1.0), tiny = W::Splat(1e-300);
  const V3<W> d = a.center - b.center;
  const W aa = Max(Dot(a.half, a.half), tiny), bb = Max(Dot(b.half, b.half), tiny);
  const W ab = Dot(a.half, b.half), ad = Dot(a.half, d), bd = Dot(b.half, d);
  const auto clamp = [&](W x) { return Max(Min(x, one), -one); };
  // Line parameters from -1 to 1. First s without the ends of b, then t, then s for this t.
  W s = clamp((ab * bd - ad * bb) / Max(aa * bb - ab * ab, tiny));
  const W t = clamp((ab * s + bd) / bb);
  s = clamp((ab * t - ad) / aa);
  const V3<W> apart = d + s * a.half - t * b.half;
  return Max(Sqrt(Dot(apart, apart)) - W::Splat(kRounding) * (Sqrt(aa) + Sqrt(bb)), zero);
}

}  // namespace taut::sim
