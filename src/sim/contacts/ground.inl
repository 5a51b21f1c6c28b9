/// Contacts of shapes with height fields and meshes (docs/theory/ground.md, section 4). Every pair
/// of a shape and a surface has a clearance. Scalar code tests each lane.
#pragma once

#include "sim/contacts/shape_pairs.inl"
#include "sim/contacts/slots.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Returns the lanes in which a rod is near its pose of an earlier test without contacts, except at
/// ends covered by other shapes. The tolerance includes a bound of rounding errors.
template <class W>
TAUT_INLINE MaskOf<W> IsQuiet(const Rows<W>& s, const Scratch<W>& work, int kept,
                              const ShapeTable& shape, W slack_m, W margin) noexcept {
  const W limit = W::Splat(shape.shape_P.round.radius_m) + Max(margin, W::Splat(0.0));
  auto quiet = limit < s.quiet_limit[kept];
  if (!Any(quiet)) return quiet;
  const M3<W>& R = work.bodies[shape.body].R;
  const V3<W>& x = s.pos[shape.body];
  const V3<W> from = x + R * simd::Splat3<W>(shape.shape_P.round.from) - s.cache_from[kept];
  const V3<W> to = x + R * simd::Splat3<W>(shape.shape_P.round.to) - s.quiet_to[kept];
  return quiet & (Dot(from, from) < slack_m * slack_m) & (Dot(to, to) < slack_m * slack_m);
}

template <class W>
void KeepQuiet(const Rows<W>& s, int number, int lane, const NearParts& kept) noexcept {
  const auto set = [lane](V3<W>& row, const Vec3& p) {
    row.x.Set(lane, p.x), row.y.Set(lane, p.y), row.z.Set(lane, p.z);
  };
  set(s.cache_from[number], kept.from);
  set(s.quiet_to[number], kept.to);
  s.quiet_limit[number].Set(lane, kept.between.count == 0 ? kept.limit_m : 0.0);
}

/// Tests a shape against a surface, in the lanes `near` in which they may be close.
template <class W, class M>
void LookAtGround(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work, int pair,
                  double step_s, M near, W margin, SlotFiller<W>* slots,
                  uint32_t* overflow) noexcept {
  const ShapePairTable& shapes = m.shape_pairs[m.world_pairs[pair].first_pair];
  const ShapeTable& shape = m.shapes[shapes.a];
  const bool round = shape.shape_P.kind == ShapeKind::kRound;
  const int number = m.world_pairs[pair].kept;
  const bool keeps = number >= 0;
  const bool may_be_quiet = keeps && shape.elsewhere[0] && shape.elsewhere[1];
  if (may_be_quiet) {
    const W slack_m = W::Splat(SlackOf(*m.shapes[shapes.b].shape_P.surface.table));
    near = near & !IsQuiet(s, work, number, shape, slack_m, margin);
    if (!Any(near)) return;
  }
  for (int lane = 0; lane < W::kLanes; ++lane) {
    if (!near[lane]) continue;
    TouchPoint points[kMaxPointsPerPair];
    NearParts* const kept = keeps ? g.kept + number * W::kLanes + lane : nullptr;
    const int found = TouchGroundLane(m, s, work, shapes, lane, margin[lane], kept, points);
    PutPoints(m, s, g, work, shapes, lane, step_s, kept, points, found, slots, overflow);
    bool touches = found > 0;
    for (int end = 0; round && end < 2; ++end) {
      uint32_t& touched = work.touched[shape.point[end]];
      if (shape.elsewhere[end]) {
        touches = touches || (touched >> lane & 1u) != 0;
      } else if (found > 0) {
        touched |= 1u << lane;
      }
    }
    const double enough = kLookAheadSteps * margin[lane];
    s.clearance[pair].Set(
        lane, touches ? 0.0 : GroundDistanceLane(m, s, work, shapes, lane, enough, kept));
    if (may_be_quiet) KeepQuiet(s, number, lane, *kept);
  }
}

/// Finds contacts of a body's shapes with surfaces, pairs [first, end), in each lane separately.
/// Touching pairs are tested in each step, other pairs only when their clearance may be used up.
template <class W>
void CollideGround(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work, int first,
                   int end, double step_s, W since_last, SlotFiller<W>* slots,
                   uint32_t* overflow) noexcept {
  const int body = m.world_pairs[first].a;
  const BodyWork<W>&a = work.bodies[body], &b = work.bodies[m.body_count];
  const W margin = Reach(a, b, W::Splat(step_s)), used = Used(a, b, since_last);
  int surface = -1;
  for (int pair = first; pair < end; ++pair) {
    const int other = m.shape_pairs[m.world_pairs[pair].first_pair].b;
    if (other != surface) {
      for (int i = m.first_point[body]; i < m.first_point[body + 1]; ++i) work.touched[i] = 0;
      surface = other;
    }
    s.clearance[pair] -= used;
    const auto near = s.clearance[pair] < margin;
    if (Any(near)) LookAtGround(m, s, g, work, pair, step_s, near, margin, slots, overflow);
  }
}

}  // namespace taut::sim
