/// Lower bounds of the distances between bodies, over all pairs of their shapes.
#pragma once

#include "sim/contacts/rod_distance.inl"
#include "sim/contacts/shape_pairs.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Lower bound of the distance between two bodies. The bound holds in the requested lanes;
/// `everywhere`: in all lanes, because no shape needed the scalar code of the narrow phase.
template <class W>
struct BodyDistance {
  W least = W::Splat(1e300);
  bool everywhere = true;
};

TAUT_INLINE bool IsRound(const ShapeTable& shape) noexcept {
  return shape.shape_P.kind == ShapeKind::kRound;
}

/// Includes the distance of two shapes.
template <class W, class M>
TAUT_INLINE void IncludeShapes(const View& m, const Rows<W>& s, const Scratch<W>& work, int shape_a,
                               int shape_b, M lanes, BodyDistance<W>& out) noexcept {
  const ShapeTable &a = m.shapes[shape_a], &b = m.shapes[shape_b];
  if (IsRound(a) && IsRound(b)) {
    const W radii = W::Splat(a.shape_P.round.radius_m + b.shape_P.round.radius_m);
    const W lines =
        LineDistance(CenterLineOf(m, s, work, shape_a), CenterLineOf(m, s, work, shape_b));
    out.least = Min(lines - radii, out.least);
    return;
  }
  out.everywhere = false;
  const V3<W> d = ShapeCenter(m, s, work, shape_a) - ShapeCenter(m, s, work, shape_b);
  W bound = Sqrt(Dot(d, d)) - W::Splat(a.bound_m + b.bound_m);
  const auto closer = lanes & (bound < out.least);
  if (!Any(closer)) return;
  for (int lane = 0; lane < W::kLanes; ++lane) {
    if (!closer[lane]) continue;
    const double exact = DistanceLane(m, s, work, shape_a, shape_b, lane);
    if (exact > bound[lane]) bound.Set(lane, exact);
  }
  out.least = Min(bound, out.least);
}

/// Returns a lower bound of the distance between all shapes of two bodies, in `lanes`.
template <class W, class M>
BodyDistance<W> DistanceOfBodies(const View& m, const Rows<W>& s, const Scratch<W>& work,
                                 const WorldPairTable& bodies, M lanes) noexcept {
  BodyDistance<W> out;
  for (int i = 0; i < bodies.pair_count; ++i) {
    const ShapePairTable& pair = m.shape_pairs[bodies.first_pair + i];
    IncludeShapes(m, s, work, pair.a, pair.b, lanes, out);
  }
  return out;
}
template <class W, class M>
BodyDistance<W> DistanceOfBodies(const View& m, const Rows<W>& s, const Scratch<W>& work,
                                 const MovingPair& bodies, M lanes) noexcept {
  constexpr int kMostKept = 16;  // lines of b, computed once for all shapes of a
  CenterLine<W> kept[kMostKept];
  BodyDistance<W> out;
  const int* const of_b = m.body_shapes + m.first_shape[bodies.b];
  const int count_b = m.first_shape[bodies.b + 1] - m.first_shape[bodies.b];
  const int first_a = m.first_shape[bodies.a], end_a = m.first_shape[bodies.a + 1];
  for (int k = 0; k < count_b && k < kMostKept; ++k) {
    if (IsRound(m.shapes[of_b[k]])) kept[k] = CenterLineOf(m, s, work, of_b[k]);
  }
  for (int i = first_a; i < end_a; ++i) {
    const int shape_a = m.body_shapes[i];
    const ShapeTable& a = m.shapes[shape_a];
    if (!IsRound(a)) {
      for (int k = 0; k < count_b; ++k) IncludeShapes(m, s, work, shape_a, of_b[k], lanes, out);
      continue;
    }
    const CenterLine<W> line = CenterLineOf(m, s, work, shape_a);
    for (int k = 0; k < count_b; ++k) {
      const ShapeTable& b = m.shapes[of_b[k]];
      if (!IsRound(b) || k >= kMostKept) {
        IncludeShapes(m, s, work, shape_a, of_b[k], lanes, out);
        continue;
      }
      const W radii = W::Splat(a.shape_P.round.radius_m + b.shape_P.round.radius_m);
      out.least = Min(LineDistance(line, kept[k]) - radii, out.least);
    }
  }
  return out;
}

}  // namespace taut::sim
