/// Spans of cables with wrapping and friction (docs/theory/cables.md, section 7): one on each side
/// of every bend, with separate numbers of bends in each lane. Spans that do not exist in a lane
/// are last.
#pragma once

#include "sim/cables/cable_edges.h"
#include "sim/cables/cable_rods.inl"
#include "sim/data/rows.h"
#include "sim/geometry/line_crossing.h"

namespace taut::sim {

TAUT_INLINE int FirstSlip(const View& m, const TouchTable& touch) noexcept {
  return m.cables[touch.cable].first_slip;
}

/// Returns the number of spans of the cable in one lane.
template <class W>
TAUT_INLINE int SpansIn(const View& m, const Rows<W>& s, const CableTable& cable,
                        int lane) noexcept {
  if (cable.touch < 0) return cable.span_count;
  const WrapPointNumbers<W>* const bends = &s.bend[m.touches[cable.touch].first_bend];
  int count = 0;
  while (count < kMostBends && bends[count].key[lane] != kNoKey) ++count;
  return count + 1;
}

/// Returns the lanes in which the cable has this span.
template <class W>
TAUT_INLINE MaskOf<W> HasSpan(const View& m, const Rows<W>& s, const CableTable& cable,
                              int span) noexcept {
  if (span == 0) return MaskOf<W>::Splat(true);
  return !(s.bend[m.touches[cable.touch].first_bend + span - 1].key == W::Splat(kNoKey));
}

/// Returns the lanes in which a link acts. All lanes share the links, but each lane has separate
/// bends.
template <class W>
TAUT_INLINE MaskOf<W> Pulls(const RowLink<W>& link) noexcept {
  return Dot(link.lin[0], link.lin[0]) > W::Splat(0.0);
}
template <class W>
TAUT_INLINE bool Pulls(const RowLink<W>& link, int lane) noexcept {
  const V3<W>& way = link.lin[0];
  return way.x[lane] != 0.0 || way.y[lane] != 0.0 || way.z[lane] != 0.0;
}

/// Same as above, for a link of a whole cable.
template <class W>
TAUT_INLINE bool Acts(const Link<W, 1>& link, int lane) noexcept {
  const V3<W>&way = link.lin[0], &turn = link.ang[0];
  return way.x[lane] != 0.0 || way.y[lane] != 0.0 || way.z[lane] != 0.0 || turn.x[lane] != 0.0 ||
         turn.y[lane] != 0.0 || turn.z[lane] != 0.0;
}

/// Returns the tension ratio at a point with the given mu theta.
template <class S>
TAUT_INLINE S RatioOf(S mu_theta) noexcept {
  using C = Constant<S>;
  constexpr double kMost = 40.0;
  return C::Of(1.0) + ExpLess1(Min(mu_theta, C::Of(kMost)));
}

/// Updates the spans of one lane when bends begin or end.
template <class W>
class LaneSpans {
 public:
  LaneSpans(const View& m, const Rows<W>& s, const TouchTable& touch, int lane) noexcept
      : s_(s), cable_(touch.cable), lane_(lane), grips_(touch.friction > 0) {
    const CableTable& table = m.cables[cable_];
    first_span_ = table.first_span, first_slip_ = table.first_slip;
  }

  /// Removes bend k of `bends` and merges its two spans. Afterwards the strain is uniform, so some
  /// elastic energy is lost (eq. 21).
  void Merge(int k, int bends) const noexcept {
    if (!grips_) return;
    W* const rest = &s_.span_rest[first_span_];
    W* const tension = &s_.span_tension[first_span_];
    const double a = rest[k][lane_], b = rest[k + 1][lane_], all = a + b;
    const double low = tension[k][lane_], high = tension[k + 1][lane_], apart = high - low;
    const double area_n = s_.stiffness[cable_][lane_] * s_.rest[cable_][lane_];
    W& loss = s_.slip_loss[first_slip_ + k];
    loss.Set(lane_, loss[lane_] + 0.5 * (a * b / all) * apart * apart / area_n);
    rest[k + 1].Set(lane_, all);
    tension[k + 1].Set(lane_, (a * low + b * high) / all);
    for (int i = k; i < bends; ++i) Copy(rest, i + 1, i), Copy(tension, i + 1, i);
    rest[bends].Set(lane_, 0.0), tension[bends].Set(lane_, 0.0);
    for (int i = k; i + 1 < bends; ++i) CopyPlace(i + 1, i);
    ForgetPlace(bends - 1);
  }

  /// Inserts bend k into `bends` bends and splits its span, with equal strain on both sides.
  void Split(int k, int bends, double share) const noexcept {
    if (!grips_) return;
    W* const rest = &s_.span_rest[first_span_];
    W* const tension = &s_.span_tension[first_span_];
    for (int i = bends; i >= k; --i) Copy(rest, i, i + 1), Copy(tension, i, i + 1);
    rest[k].Set(lane_, share * rest[k][lane_]);
    rest[k + 1].Set(lane_, rest[k + 1][lane_] - rest[k][lane_]);
    for (int i = bends; i > k; --i) CopyPlace(i - 1, i);
    ForgetPlace(k);
  }

 private:
  void Copy(W* row, int from, int to) const noexcept { row[to].Set(lane_, row[from][lane_]); }
  void CopyPlace(int from, int to) const noexcept {
    Copy(&s_.slip_place[first_slip_], from, to);
    Copy(&s_.slip_along[first_slip_], from, to);
    Copy(&s_.slip_height[first_slip_], from, to);
  }
  void ForgetPlace(int k) const noexcept {
    s_.slip_place[first_slip_ + k].Set(lane_, kNotHeld);
    s_.slip_along[first_slip_ + k].Set(lane_, kNotHeld);
    s_.slip_height[first_slip_ + k].Set(lane_, kNotHeld);
  }

  const Rows<W>& s_;
  int cable_, lane_, first_span_ = 0, first_slip_ = 0;
  bool grips_;
};

/// Returns the fraction of a span's length that lies before a new bend on it. The span consists of
/// the straight part `span` and half arcs of lengths `before_m` and `behind_m` at its ends.
template <class W>
double ShareBefore(const View& m, const Rows<W>& s, const Scratch<W>& work, const BendPlace& place,
                   const FreeSpan& span, double before_m, double behind_m, int lane) noexcept {
  constexpr double kLeast = 0.01;
  Vec3 center = place.center, axis = place.axis;
  if (place.body != m.body_count) {
    const M3<W>& R = work.bodies[place.body].R;
    const double c[3] = {center.x, center.y, center.z}, u[3] = {axis.x, axis.y, axis.z};
    center = PlaceOf(s.pos[place.body], lane) + TurnedBy(R, c, lane), axis = TurnedBy(R, u, lane);
  }
  const Crossing<Vec3> x = CrossingOf(span.from, span.to, center, axis);
  const Vec3 way = span.to - span.from;
  const double straight_m = Sqrt(Dot(way, way));
  const double at_m = before_m + (x.norm2 > 0.0 ? x.along_p / x.norm2 : 0.5) * straight_m;
  return Max(Min(at_m / (before_m + straight_m + behind_m), 1.0 - kLeast), kLeast);
}

}  // namespace taut::sim
