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

/// A bend that is left, or slips off.
template <class W>
TAUT_INLINE MaskOf<W> MayLeave(const Rows<W>& s, const Scratch<W>& work, const TouchTable& touch,
                               int used) noexcept {
  const W zero = W::Splat(0.0), half = W::Splat(0.5);
  auto may = MaskOf<W>::Splat(false);
  for (int k = 0; k < used; ++k) {
    const BendNumbers<W>& bend = s.bend[touch.first_bend + k];
    const Wheel<V3<W>>& wheel = work.wheels[k];
    const AttachmentWork<W>* const at = work.attachments + 1 + 2 * k;
    const V3<W> middle = half * (at[0].p + at[1].p) - wheel.center;
    const auto stays = (Abs(Dot(middle, wheel.axis)) < bend.half) & (Abs(wheel.angle) < bend.most) &
                       (wheel.theta > zero);
    may = may | !(stays | (bend.key == W::Splat(kNoKey)));
  }
  return may;
}

/// Lanes in which ChangeBends may change something; in the others it would not.
template <class W>
[[gnu::noinline]] MaskOf<W> MayChangeBends(const View& m, const Rows<W>& s, const Scratch<W>& work,
                                           const TouchTable& touch, int used) noexcept {
  constexpr double kRounding = 1e-12;  // that FindRod, which takes a root, never finds more
  if (touch.terrain && (m.tree_shapes > 0 || m.ground_count > 0)) return MaskOf<W>::Splat(true);
  auto may = MayLeave(s, work, touch, used);
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
  for (int i = touch.first_rod; i < touch.first_rod + touch.rod_count; ++i) {
    const TouchRodTable& rod = m.touch_rods[i];
    const auto apart = !LiesAgainst(s, touch, used, W::Splat(KeyOf(rod)));
    if (!Any(apart)) continue;
    const M3<W>& R = work.bodies[rod.body].R;
    const V3<W> center = s.pos[rod.body] + R * simd::Splat3<W>(rod.center_P);
    const V3<W> axis = R * simd::Splat3<W>(rod.axis_P);
    const W half = W::Splat(rod.half_m);
    const W reach2 = W::Splat((1.0 + kRounding) * rod.radius_m * rod.radius_m);
    EachSpan(s, touch, used, ends, [&](const V3<W>& from, const V3<W>& to, auto, auto, auto is) {
      const Crossing<V3<W>> x = CrossingOf(from, to, center, axis);
      const W side = SideOf(x, half);
      const auto near = !(x.across * x.across > reach2 * x.norm2);
      const auto through = side * s.touch_side[i] < W::Splat(0.0);
      may = may | (is & apart & (!(side == W::Splat(0.0))) & (near | through));
    });
  }
  return may;
}

/// On which side of all rods a cable is, as its path lies now.
template <class W>
TAUT_INLINE void KeepSides(const View& m, const Rows<W>& s, const Scratch<W>& work,
                           const TouchTable& touch, int used, MaskOf<W> lanes) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  for (int i = touch.first_rod; i < touch.first_rod + touch.rod_count; ++i) {
    const TouchRodTable& rod = m.touch_rods[i];
    const M3<W>& R = work.bodies[rod.body].R;
    const V3<W> center = s.pos[rod.body] + R * simd::Splat3<W>(rod.center_P);
    const V3<W> axis = R * simd::Splat3<W>(rod.axis_P);
    W side = zero;
    EachSpan(s, touch, used, work.attachments,
             [&](const V3<W>& from, const V3<W>& to, auto, auto, auto is) {
               const W now = SideOf(CrossingOf(from, to, center, axis), W::Splat(rod.half_m));
               side = Select(is & !(now == zero), now, side);
             });
    for (int k = 0; k < used; ++k) {
      const BendNumbers<W>& bend = s.bend[touch.first_bend + k];
      const W around = Select(bend.angle < zero, one, zero - one);
      side = Select(bend.key == W::Splat(KeyOf(rod)), around, side);
    }
    s.touch_side[i] = Select(lanes, side, s.touch_side[i]);
  }
}

}  // namespace taut::sim
