/// Checks of the bends of a cable in all lanes at once (docs/theory/cables.md, section 6). Lanes
/// without changes skip the search, which runs lane by lane. Also updates the sides of rods on
/// which the cable passes.
#pragma once

#include "sim/cables/cable_edges.h"
#include "sim/cables/cable_rods.inl"
#include "sim/data/rows.h"
#include "sim/geometry/box_cut.h"

namespace taut::sim {

/// Calls `use(from, to, starts, ends, is)` for the straight parts of a cable between bends. `is`:
/// lanes that have this part.
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

/// Returns the lanes in which the cable has a bend with this key.
template <class W>
TAUT_INLINE MaskOf<W> LiesAgainst(const Rows<W>& s, const TouchTable& touch, int used,
                                  W key) noexcept {
  auto lies = MaskOf<W>::Splat(false);
  for (int k = 0; k < used; ++k) lies = lies | (s.bend[touch.first_bend + k].key == key);
  return lies;
}

/// Returns the lanes in which a bend is on the rod of a body.
template <class W>
TAUT_INLINE MaskOf<W> IsOnRod(const View& m, const WrapPointNumbers<W>& bend) noexcept {
  return !((bend.key == W::Splat(kNoKey)) | (bend.body == W::Splat(m.body_count)));
}

/// Returns the lanes in which bend `k` and the next one are on rods that overlap at the cable. In
/// these lanes, no shortest path over both rods exists: path and energy jump, or the bends drift
/// along the rods. A cable that passes between the rods needs free space. A cable over both fails
/// only if the rods overlap, which is possible if they do not collide. Crossings near the end of a
/// rod are joints and do not count. `anywhere`: overlaps away from the cable count, too.
template <class W>
TAUT_INLINE MaskOf<W> RanIntoNextRod(const View& m, const Rows<W>& s, const Scratch<W>& work,
                                     const TouchTable& touch, int k, bool anywhere) noexcept {
  constexpr double kSurely = 0.9, kRoom = 1.1, kParallel = 1e-6, kAlike = 0.5;
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  const WrapPointNumbers<W>*const bend = &s.bend[touch.first_bend + k], *const next = bend + 1;
  const Wheel<V3<W>>&rod = work.wheels[k], &other = work.wheels[k + 1];
  const V3<W>&leaves = work.attachments[2 + 2 * k].p, &arrives = work.attachments[3 + 2 * k].p;
  const V3<W> way = arrives - leaves, apart = other.center - rod.center;
  const W reach = rod.radius + other.radius;
  const V3<W> across = Cross(rod.axis, other.axis), beside = Cross(rod.axis, apart);
  const W norm2 = Dot(across, across), along = Dot(across, apart);
  const W inverse = one / Max(norm2, W::Splat(kParallel));
  const auto parallel = !(norm2 > W::Splat(kParallel));
  const W distance2 = Select(parallel, Dot(beside, beside), along * along * inverse);
  const W at_rod = Dot(Cross(apart, other.axis), across) * inverse;
  const W at_other = Dot(Cross(apart, rod.axis), across) * inverse;
  const auto within =
      parallel | ((Abs(at_rod) < bend->half - reach) & (Abs(at_other) < next->half - reach));
  // Returns the axis about which the cable turns counterclockwise.
  const auto turn = [&](const Wheel<V3<W>>& x) {
    return Select(x.angle < zero, zero - one, one) * x.axis;
  };
  const auto over = Dot(turn(rod), turn(other)) > W::Splat(kAlike);
  const W thick = W::Splat(kSurely) * (reach - W::Splat(2.0 * touch.radius_m));
  const W limit = Select(over, Max(thick, zero), W::Splat(kRoom) * reach);
  const W off = Dot(leaves - rod.center, rod.axis) - at_rod;
  const auto beside_it = Dot(way, way) < reach * reach;
  const auto near = beside_it | ((!parallel) & (!over) & (Abs(off) < reach + reach));
  const auto looks = anywhere ? (near | !over) : near;
  return IsOnRod(m, *bend) & IsOnRod(m, *next) & within & (distance2 < limit * limit) & looks;
}

/// Returns the lanes in which the path next to bend `k` starts inside its rod: at an end of the
/// cable, or at another rod. The length could then not continue without a jump.
template <class W>
TAUT_INLINE MaskOf<W> IsInsideRod(const View& m, const Rows<W>& s, const Scratch<W>& work,
                                  const TouchTable& touch, int used, int k) noexcept {
  constexpr double kSurely = 1.0 - 1e-6;
  const WrapPointNumbers<W>* const bend = &s.bend[touch.first_bend + k];
  const AttachmentWork<W>* const ends = work.attachments;
  const Wheel<V3<W>>& rod = work.wheels[k];
  V3<W> behind = ends[2 * used + 1].p;
  if (k + 1 < used) behind = Pick(bend[1].key == W::Splat(kNoKey), behind, ends[3 + 2 * k].p);
  const auto inside = [&](const V3<W>& p) {
    const V3<W> away = p - rod.center;
    const W along = Dot(away, rod.axis);
    return Dot(away, away) - along * along < W::Splat(kSurely) * rod.radius * rod.radius;
  };
  return IsOnRod(m, *bend) & (inside(ends[2 * k].p) | inside(behind));
}

/// Returns the lanes in which a bend lifts off, slips off, or overlaps the next rod or an end of
/// the cable.
template <class W>
TAUT_INLINE MaskOf<W> MayLeave(const View& m, const Rows<W>& s, const Scratch<W>& work,
                               const TouchTable& touch, int used) noexcept {
  const W zero = W::Splat(0.0), half = W::Splat(0.5);
  auto may = MaskOf<W>::Splat(false);
  for (int k = 0; k < used; ++k) {
    const WrapPointNumbers<W>& bend = s.bend[touch.first_bend + k];
    const Wheel<V3<W>>& wheel = work.wheels[k];
    const AttachmentWork<W>* const at = work.attachments + 1 + 2 * k;
    const V3<W> middle = half * (at[0].p + at[1].p) - wheel.center;
    const auto stays = (Abs(Dot(middle, wheel.axis)) < bend.half) & (Abs(wheel.angle) < bend.most) &
                       (wheel.theta > zero);
    may = may | !(stays | (bend.key == W::Splat(kNoKey)));
    if (touch.rod_count == 0) continue;
    may = may | IsInsideRod(m, s, work, touch, used, k);
    if (k + 1 < used) may = may | RanIntoNextRod(m, s, work, touch, k, true);
  }
  return may;
}

/// Position of a rod relative to a path over bends.
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

/// Returns the lanes in which ChangeBends may change something.
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

/// Stores the wrap angles of the bends in the current path.
template <class W>
TAUT_INLINE void KeepAngles(const Rows<W>& s, const Scratch<W>& work, const TouchTable& touch,
                            int used, MaskOf<W> lanes) noexcept {
  for (int k = 0; k < used; ++k) {
    WrapPointNumbers<W>& bend = s.bend[touch.first_bend + k];
    const auto live = lanes & !(bend.key == W::Splat(kNoKey));
    bend.angle = Select(live, work.wheels[k].angle, bend.angle);
  }
}

/// Updates the sides of all rods in work.rod_lines relative to the path of a cable.
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
      const WrapPointNumbers<W>& bend = s.bend[touch.first_bend + k];
      const W around = Select(bend.angle < zero, one, zero - one);
      side = Select(bend.key == W::Splat(KeyOf(rod)), SideOfPart(around, W::Splat(k)), side);
    }
    known = Select(lanes, side, known);
  }
}

}  // namespace taut::sim
