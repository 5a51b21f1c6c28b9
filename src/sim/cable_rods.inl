/// Rods that a cable comes to lie against (docs/theory/cables.md, section 6). Where the straight
/// lines of both cross, the cable is on one side of the rod's axis; that it is on the other one
/// later shows that it has come through, however fast.

namespace taut::sim {

template <class W>
TAUT_INLINE Vec3 PlaceOf(const V3<W>& p, int lane) noexcept {
  return {p.x[lane], p.y[lane], p.z[lane]};
}

/// Lanes in which a cable may have come to touch a rod, of those where it has been `free`: straight
/// from end to end. In the others of those it is written down on which side it is.
template <class W>
MaskOf<W> MayTouchRods(const View& m, const Rows<W>& s, const Scratch<W>& work,
                       const TouchTable& touch, const V3<W>& from, const V3<W>& to,
                       MaskOf<W> free) noexcept {
  const W zero = W::Splat(0.0), half = W::Splat(0.5);
  auto touches = MaskOf<W>::Splat(false);
  const V3<W> way = to - from, middle = half * (from + to);
  const W half_way = half * Sqrt(Dot(way, way)) + W::Splat(touch.radius_m);
  int body = -1;
  bool near_body = false;
  for (int i = touch.first_rod; i < touch.first_rod + touch.rod_count; ++i) {
    if (m.touch_rods[i].body != body) {
      body = m.touch_rods[i].body;
      const V3<W> apart = s.pos[body] - middle;
      const W reach = half_way + W::Splat(m.bound_m[body]);
      near_body = Any(free & (Dot(apart, apart) < reach * reach));
    }
    if (!near_body) {
      s.touch_side[i] = Select(free, zero, s.touch_side[i]);
      continue;
    }
    const TouchRodTable& rod = m.touch_rods[i];
    const M3<W>& R = work.bodies[rod.body].R;
    const Crossing<V3<W>> x =
        CrossingOf(from, to, s.pos[rod.body] + R * simd::Splat3<W>(rod.center_P),
                   R * simd::Splat3<W>(rod.axis_P));
    const auto within = CrossWithin(x, W::Splat(rod.half_m));
    const W side = SideOf(x, W::Splat(rod.half_m));
    const W was = s.touch_side[i];
    const auto through = side * was < zero;
    const auto near =
        within & (x.across * x.across < W::Splat(rod.radius_m * rod.radius_m) * x.norm2);
    const auto here = free & (through | near);
    touches = touches | here;
    s.touch_side[i] = Select(free & !here, side, was);
  }
  return touches;
}

/// Round a rod a cable may be wound up.
inline constexpr double kAnyTurns = 1e300;

/// Key of a rod, which no edge of the terrain has.
TAUT_INLINE double KeyOf(const TouchRodTable& rod) noexcept { return kEdgesOfShape * rod.shape; }

template <class W>
TAUT_INLINE Vec3 TurnedBy(const M3<W>& R, const double* p, int lane) noexcept {
  const auto row = [&](const V3<W>& r) {
    return r.x[lane] * p[0] + r.y[lane] * p[1] + r.z[lane] * p[2];
  };
  return {row(R.r0), row(R.r1), row(R.r2)};
}

/// A rod's middle and axis in one lane.
struct RodInLane {
  Vec3 center, axis;
};
template <class W>
TAUT_INLINE RodInLane RodAt(const Rows<W>& s, const Scratch<W>& work, const TouchRodTable& rod,
                            int lane) noexcept {
  const M3<W>& R = work.bodies[rod.body].R;
  return {PlaceOf(s.pos[rod.body], lane) + TurnedBy(R, rod.center_P, lane),
          TurnedBy(R, rod.axis_P, lane)};
}

/// The rod into which a span has come deepest in one lane, as FindEdge finds edges.
template <class W>
bool FindRod(const View& m, const Rows<W>& s, const Scratch<W>& work, const TouchTable& touch,
             const FreeSpan& span, int lane, const double* taken, int taken_count, bool any,
             BendFound* found) noexcept {
  const Vec3 middle = 0.5 * (span.from + span.to), way = span.to - span.from;
  const double half = 0.5 * Sqrt(Dot(way, way));
  bool is_new = false;
  for (int i = touch.first_rod; i < touch.first_rod + touch.rod_count; ++i) {
    const TouchRodTable& rod = m.touch_rods[i];
    if (IsTaken(KeyOf(rod), taken, taken_count)) continue;
    const auto [center, axis] = RodAt(s, work, rod, lane);
    const Vec3 apart = middle - center;
    const double reach = half + rod.half_m + rod.radius_m;
    if (!(Dot(apart, apart) < reach * reach)) continue;
    const Crossing<Vec3> x = CrossingOf(span.from, span.to, center, axis);
    const double side = SideOf(x, rod.half_m), was = s.touch_side[i][lane];
    if (side == 0.0) continue;
    const double off = Abs(x.across) / Sqrt(x.norm2);
    const bool through = side * was < 0.0;
    if (!through && !(off < rod.radius_m)) continue;
    const double depth = rod.radius_m + (through ? off : -off);
    if ((any || is_new) && !(depth > found->depth_m)) continue;
    const double around = through ? side : -side;  // against the side that it was on
    if (!CanLieOn({0.0, 0, center, axis, kAnyTurns, rod.half_m, rod.radius_m}, span, around))
      continue;
    is_new = true;
    const double* const c = rod.center_P;
    const double* const u = rod.axis_P;
    *found = {{KeyOf(rod),
               rod.body,
               {c[0], c[1], c[2]},
               {u[0], u[1], u[2]},
               kAnyTurns,
               rod.half_m,
               rod.radius_m},
              depth,
              around};
  }
  return is_new;
}

}  // namespace taut::sim
