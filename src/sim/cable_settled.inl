/// What can be said of a cable's bends (docs/theory/cables.md, section 6) in all lanes at once: in
/// which they stay as they are, so that only the others are looked at one by one, and on which side
/// of rods the cable is.

namespace taut::sim {

/// The straight stretches of a cable over bends: in each lane those between the ones that it has,
/// which come first. `use(from, to, starts, ends, is)`, the last for the lanes that have it.
template <class W, class Use>
TAUT_INLINE void EachSpan(const Rows<W>& s, const TouchTable& touch, int used,
                          const AttachmentWork<W>* ends, const Use& use) noexcept {
  auto is = MaskOf<W>::Splat(true);
  for (int k = 0; k <= used; ++k) {
    const auto starts = MaskOf<W>::Splat(k == 0);
    const V3<W>& end = ends[2 * used + 1].p;
    if (k == used) {
      use(ends[2 * k].p, end, starts, MaskOf<W>::Splat(true), is);
      return;
    }
    const auto bends = !(s.bend[touch.first_bend + k].key == W::Splat(kNoKey));
    use(ends[2 * k].p, Pick(bends, ends[1 + 2 * k].p, end), starts, !bends, is);
    is = is & bends;
  }
}

/// Where it lies against that already.
template <class W>
TAUT_INLINE MaskOf<W> LiesAgainst(const Rows<W>& s, const TouchTable& touch, int used,
                                  W key) noexcept {
  auto lies = MaskOf<W>::Splat(false);
  for (int k = 0; k < used; ++k) lies = lies | (s.bend[touch.first_bend + k].key == key);
  return lies;
}

/// Two rods on which the cable lies, one after the other.
template <class V, class S>
struct NextRods {
  V center[2], axis[2];
  V turn[2];  ///< The axis about which the cable turns, counter-clockwise.
  V b, a;     ///< Where it leaves the first, and arrives at the second.
  S radius[2], half[2];
};

/// Whether they have run into each other where the cable is. Then there is no shortest way over
/// both any more: what is laid jumps or flees along the rods, and with it the energy. Where the
/// cable goes between them that is so as soon as it has no room there; where it goes over both,
/// they have to be within each other, as rods can be that no contacts keep apart. Crossings near a
/// rod's end are joints. `anywhere`: wherever the cable is.
template <class V, class S>
TAUT_INLINE auto RanIntoEachOther(const NextRods<V, S>& rods, double cable_radius_m,
                                  bool anywhere) noexcept {
  using C = Constant<S>;
  using Is = decltype(S() < S());
  constexpr double kSurely = 0.9, kRoom = 1.1, kParallel = 1e-6, kAlike = 0.5;
  const V way = rods.a - rods.b, apart = rods.center[1] - rods.center[0];
  const S reach = rods.radius[0] + rods.radius[1];
  const V across = Cross(rods.axis[0], rods.axis[1]), beside = Cross(rods.axis[0], apart);
  const S norm2 = Dot(across, across), along = Dot(across, apart);
  const S inverse = C::Of(1.0) / Max(norm2, C::Of(kParallel));
  const Is parallel = !(norm2 > C::Of(kParallel));
  const S distance2 = Select(parallel, Dot(beside, beside), along * along * inverse);
  const S at0 = Dot(Cross(apart, rods.axis[1]), across) * inverse;
  const S at1 = Dot(Cross(apart, rods.axis[0]), across) * inverse;
  const Is within =
      Either(parallel, Both(Abs(at0) < rods.half[0] - reach, Abs(at1) < rods.half[1] - reach));
  const Is over = Dot(rods.turn[0], rods.turn[1]) > C::Of(kAlike);
  const S thick = C::Of(kSurely) * (reach - C::Of(2.0 * cable_radius_m));
  const S limit = Select(over, Max(thick, C::Of(0.0)), C::Of(kRoom) * reach);
  const S off = Dot(rods.b - rods.center[0], rods.axis[0]) - at0;
  const Is beside_it = Dot(way, way) < reach * reach;
  const Is near = beside_it | ((!parallel) & (!over) & (Abs(off) < reach + reach));
  const Is looks = anywhere ? (near | !over) : near;
  return within & (distance2 < limit * limit) & looks;
}

/// Whether a point of the path is inside of a rod that it lies on next: its cable's end, or where
/// it leaves another rod. From there on no length goes on without a jump.
template <class V, class S>
TAUT_INLINE auto IsInside(const V& p, const Wheel<V>& rod, S radius) noexcept {
  using C = Constant<S>;
  constexpr double kSurely = 1.0 - 1e-6;
  const V away = p - rod.center;
  const S along = Dot(away, rod.axis);
  return Dot(away, away) - along * along < C::Of(kSurely) * radius * radius;
}

/// A bend that is left, or slips off, or whose rod runs into the next or the cable's end.
template <class W>
TAUT_INLINE MaskOf<W> MayLeave(const View& m, const Rows<W>& s, const Scratch<W>& work,
                               const TouchTable& touch, int used) noexcept {
  const W zero = W::Splat(0.0), half = W::Splat(0.5), one = W::Splat(1.0);
  auto may = MaskOf<W>::Splat(false);
  for (int k = 0; k < used; ++k) {
    const BendNumbers<W>& bend = s.bend[touch.first_bend + k];
    const Wheel<V3<W>>& wheel = work.wheels[k];
    const AttachmentWork<W>* const at = work.attachments + 1 + 2 * k;
    const V3<W> middle = half * (at[0].p + at[1].p) - wheel.center;
    const auto stays = (Abs(Dot(middle, wheel.axis)) < bend.half) & (Abs(wheel.angle) < bend.most) &
                       (wheel.theta > zero);
    may = may | !(stays | (bend.key == W::Splat(kNoKey)));
    if (touch.rod_count == 0) continue;
    const V3<W>& end = work.attachments[2 * used + 1].p;
    V3<W> next_point = end;
    if (k + 1 < used) {
      const auto none = s.bend[touch.first_bend + k + 1].key == W::Splat(kNoKey);
      next_point = Pick(none, end, at[2].p);
    }
    const auto on_rod = !((bend.key == W::Splat(kNoKey)) | (bend.body == W::Splat(m.body_count)));
    may = may | (on_rod & (IsInside(work.attachments[2 * k].p, wheel, wheel.radius) |
                           IsInside(next_point, wheel, wheel.radius)));
    if (k + 1 == used) continue;
    const BendNumbers<W>& behind = s.bend[touch.first_bend + k + 1];
    const Wheel<V3<W>>& next = work.wheels[k + 1];
    const W world = W::Splat(m.body_count);
    const auto rods =
        !((behind.key == W::Splat(kNoKey)) | (bend.body == world) | (behind.body == world));
    const auto turn = [&](const Wheel<V3<W>>& x) {
      return Select(x.angle < zero, zero - one, one) * x.axis;
    };
    const NextRods<V3<W>, W> both{{wheel.center, next.center},
                                  {wheel.axis, next.axis},
                                  {turn(wheel), turn(next)},
                                  at[1].p,
                                  at[2].p,
                                  {wheel.radius, next.radius},
                                  {bend.half, behind.half}};
    may = may | (rods & RanIntoEachOther(both, touch.radius_m, true));
  }
  return may;
}

/// How a path over bends passes a rod.
template <class W>
RodPass<W> PassOf(const Rows<W>& s, const TouchTable& touch, int used,
                  const AttachmentWork<W>* ends, const TouchRodTable& rod,
                  const RodLine<W>& line) noexcept {
  RodPass<W> pass = RodPass<W>::None();
  int part = 0;
  EachSpan(s, touch, used, ends, [&](const V3<W>& from, const V3<W>& to, auto, auto, auto is) {
    LookAtPart(from, to, line.center, line.axis, W::Splat(rod.half_m), part++, is, pass);
  });
  return pass;
}

/// Lanes in which ChangeBends may change something; in the others it would not.
template <class W>
[[gnu::noinline]] MaskOf<W> MayChangeBends(const View& m, const Rows<W>& s, const Scratch<W>& work,
                                           const TouchTable& touch, int used) noexcept {
  if (touch.terrain && (m.tree_shapes > 0 || m.ground_count > 0)) return MaskOf<W>::Splat(true);
  auto may = MayLeave(m, s, work, touch, used);
  const AttachmentWork<W>* const ends = work.attachments;
  for (int i = 0; touch.terrain && i < m.world_shape_count; ++i) {
    const int number = m.world_shapes[i];
    const Shape& shape = m.shapes[number].shape_P;
    if (shape.kind != ShapeKind::kBox) continue;
    EachSpan(s, touch, used, ends,
             [&](const V3<W>& from, const V3<W>& to, auto starts, auto stops, auto is) {
               auto through = is;
               const BoxCut<V3<W>> cut =
                   CutBox(shape.box, from, to, touch.radius_m, starts, stops, &through);
               const W key = W::Splat(kEdgesOfShape * number) + NumberOfEdge(cut.in, cut.out);
               may = may | (is & through & !LiesAgainst(s, touch, used, key));
             });
  }
  for (int i = 0; i < touch.rod_count; ++i) {
    const TouchRodTable& rod = m.touch_rods[touch.first_rod + i];
    const auto apart = !LiesAgainst(s, touch, used, W::Splat(KeyOf(rod)));
    if (!Any(apart)) continue;
    const RodPass<W> pass = PassOf(s, touch, used, ends, rod, work.rod_lines[i]);
    const Pressed<W> pressed = PressedBy(pass, s.touch_side[touch.first_rod + i], rod.radius_m);
    may = may | (apart & pressed.same & (pressed.through | pressed.inside));
  }
  return may;
}

/// Of bends, the angles as they are laid.
template <class W>
TAUT_INLINE void KeepAngles(const Rows<W>& s, const Scratch<W>& work, const TouchTable& touch,
                            int used, MaskOf<W> lanes) noexcept {
  for (int k = 0; k < used; ++k) {
    BendNumbers<W>& bend = s.bend[touch.first_bend + k];
    const auto live = lanes & !(bend.key == W::Splat(kNoKey));
    bend.angle = Select(live, work.wheels[k].angle, bend.angle);
  }
}

/// On which side of all rods a cable is, as its path lies over work.rod_lines.
template <class W>
TAUT_INLINE void KeepSides(const View& m, const Rows<W>& s, const Scratch<W>& work,
                           const TouchTable& touch, int used, MaskOf<W> lanes) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  for (int i = 0; i < touch.rod_count; ++i) {
    const TouchRodTable& rod = m.touch_rods[touch.first_rod + i];
    W& known = s.touch_side[touch.first_rod + i];
    const RodPass<W> pass = PassOf(s, touch, used, work.attachments, rod, work.rod_lines[i]);
    W side = SideNext(pass, known, rod.radius_m);
    for (int k = 0; k < used; ++k) {
      const BendNumbers<W>& bend = s.bend[touch.first_bend + k];
      const W around = Select(bend.angle < zero, one, zero - one);
      side = Select(bend.key == W::Splat(KeyOf(rod)), SideOfPart(around, W::Splat(k)), side);
    }
    known = Select(lanes, side, known);
  }
}

}  // namespace taut::sim
