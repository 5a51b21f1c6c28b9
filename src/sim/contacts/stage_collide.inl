/// Stage: collision detection between bodies and with the world, at the middle of the step
/// (docs/theory/contact.md, section 7).
///
/// Points on planes are tested in all lanes at once. Other pairs first pass a broad phase. A pair
/// of bodies is tested only if the motion since the last distance query may have used up its
/// clearance, a pair of shapes only if their bounding spheres overlap. The narrow phase then runs
/// in scalar code for each lane (shape_pairs.inl).
#pragma once

#include "sim/bodies/motion.inl"
#include "sim/contacts/ground.inl"
#include "sim/contacts/joined_boxes.inl"
#include "sim/contacts/many_shapes.inl"
#include "sim/contacts/rod_distance.inl"
#include "sim/contacts/shape_pairs.inl"
#include "sim/contacts/slots.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Computes upper bounds of the displacement of any body point by rotation, in this step and since
/// the middle of the previous step.
template <class W>
void BoundTurns(const View& m, Scratch<W>& work, W h, W since_last) noexcept {
  for (int body = 0; body <= m.body_count; ++body) {
    BodyWork<W>& b = work.bodies[body];
    const W bound = W::Splat(m.bound_m[body]);
    b.turns = h * (bound * Norm1(b.w));
    b.turned = since_last * (bound * Norm1(b.w0));
  }
}

template <class W>
void CollidePlanes(const View& m, const Rows<W>& s, Scratch<W>& work, W h, int body,
                   SlotFiller<W>& slots) noexcept {
  V3<W> normal_P[kMaxPlanes];
  W height[kMaxPlanes];
  bool near_plane[kMaxPlanes];
  const int first = m.first_point[body], last = m.first_point[body + 1];
  if (first == last) return;
  const BodyWork<W>& b = work.bodies[body];
  const W margin = h * Norm1(b.v) + b.turns + W::Splat(kContactMarginM);
  bool any = false;
  for (int k = 0; k < m.plane_count; ++k) {
    const V3<W> n = simd::Splat3<W>(m.planes[k].normal);
    height[k] = Dot(n, s.pos[body]) - W::Splat(m.planes[k].offset_m);
    near_plane[k] = Any(height[k] - W::Splat(m.bound_m[body]) < margin);
    any = any || near_plane[k];
    normal_P[k] = TransposeTimes(b.R, n);
  }
  if (!any) return;
  for (int i = first; i < last; ++i) {
    const PointTable& point = m.points[i];
    const V3<W> p_P = simd::Splat3<W>(point.p_P);
    for (int k = 0; k < m.plane_count; ++k) {
      if (!near_plane[k]) continue;
      const W gap = height[k] + Dot(normal_P[k], p_P) - W::Splat(point.radius_m);
      const auto touching = gap < margin;
      if (!Any(touching)) continue;
      const PlaneTable& plane = m.planes[k];
      Found<W> found;
      found.key = W::Splat(i * m.plane_count + k);
      found.frame = m.along_slip ? W::Splat(-1.0) - found.key : W::Splat(k);
      found.gap = gap;
      found.radius = W::Splat(point.radius_m);
      found.static_friction = W::Splat(point.static_friction[k]);
      found.kinetic_friction = W::Splat(point.kinetic_friction[k]);
      found.restitution = W::Splat(point.restitution[k]);
      found.upright = plane.upright && !m.along_slip;
      found.n = simd::Splat3<W>(plane.normal);
      found.t1 = simd::Splat3<W>(plane.tangent1);
      found.t2 = simd::Splat3<W>(plane.tangent2);
      found.arm = b.R * p_P - W::Splat(point.radius_m) * found.n;
      slots.Add(found, touching);
    }
  }
}

/// Returns a lower bound of the distance between all shapes of two bodies, in `lanes`.
template <class W, class M>
W DistanceOfBodies(const View& m, const Rows<W>& s, const Scratch<W>& work,
                   const BodyPairTable& bodies, M lanes) noexcept {
  W least = W::Splat(1e300);
  for (int i = 0; i < bodies.pair_count; ++i) {
    const ShapePairTable& pair = m.shape_pairs[bodies.first_pair + i];
    const ShapeTable &a = m.shapes[pair.a], &b = m.shapes[pair.b];
    if (a.shape_P.kind == ShapeKind::kRound && b.shape_P.kind == ShapeKind::kRound) {
      const W radii = W::Splat(a.shape_P.round.radius_m + b.shape_P.round.radius_m);
      const W lines =
          LineDistance(CenterLineOf(m, s, work, pair.a), CenterLineOf(m, s, work, pair.b));
      least = Min(lines - radii, least);
      continue;
    }
    const V3<W> d = ShapeCenter(m, s, work, pair.a) - ShapeCenter(m, s, work, pair.b);
    W bound = Sqrt(Dot(d, d)) - W::Splat(m.shapes[pair.a].bound_m + m.shapes[pair.b].bound_m);
    const auto closer = lanes & (bound < least);
    if (!Any(closer)) continue;
    for (int lane = 0; lane < W::kLanes; ++lane) {
      if (!closer[lane]) continue;
      const double exact = DistanceLane(m, s, work, pair, lane);
      if (exact > bound[lane]) bound.Set(lane, exact);
    }
    least = Min(bound, least);
  }
  return least;
}

/// Finds the contacts of a pair in all lanes with overlapping bounding spheres.
template <class W>
void CollideShapes(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                   const ShapePairTable& pair, W margin, W center_distance2, double step_s,
                   SlotFiller<W>* slots, uint32_t* overflow) noexcept {
  const double reach = m.shapes[pair.a].bound_m + m.shapes[pair.b].bound_m;
  const W limit = W::Splat(reach) + margin;
  const auto close = center_distance2 < limit * limit;
  if (!Any(close)) return;
  for (int lane = 0; lane < W::kLanes; ++lane) {
    if (!close[lane]) continue;
    PutTouches(m, s, g, work, pair, lane, margin[lane], step_s, slots, overflow);
  }
}

/// Returns whether two bodies may touch in some lane, and computes how far they may approach.
template <class W>
bool MayTouch(const View& m, const Rows<W>& s, const Scratch<W>& work, int pair, W h, W since_last,
              W& margin) noexcept {
  const BodyPairTable& bodies = m.body_pairs[pair];
  auto near = ClearanceUsedUp(m, s, work, pair, h, since_last, margin);
  if (!Any(near)) return false;
  if (bodies.b < m.body_count) {
    const V3<W> d = s.pos[bodies.a] - s.pos[bodies.b];
    const W reach = W::Splat(m.bound_m[bodies.a] + m.bound_m[bodies.b]);
    s.clearance[pair] = Max(s.clearance[pair], Sqrt(Dot(d, d)) - reach);
    near = s.clearance[pair] < margin;
    if (!Any(near)) return false;
  }
  const W exact = DistanceOfBodies(m, s, work, bodies, near);
  s.clearance[pair] = Select(near, exact, s.clearance[pair]);
  return Any(s.clearance[pair] < margin);
}

template <class W>
void CollideBodies(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work, int pair,
                   double step_s, W since_last, SlotFiller<W>* slots, uint32_t* overflow) noexcept {
  const BodyPairTable& bodies = m.body_pairs[pair];
  if (bodies.by_tree) {
    CollideManyShapes(m, s, g, work, pair, step_s, since_last, slots, overflow);
    return;
  }
  W margin;
  if (!MayTouch(m, s, work, pair, W::Splat(step_s), since_last, margin)) return;
  if (bodies.joined) {
    CollideJoined(m, s, g, work, bodies, margin, step_s, slots, overflow);
    return;
  }
  for (int k = 0; k < bodies.pair_count; ++k) {
    const ShapePairTable& shapes = m.shape_pairs[bodies.first_pair + k];
    const V3<W> d = ShapeCenter(m, s, work, shapes.a) - ShapeCenter(m, s, work, shapes.b);
    CollideShapes(m, s, g, work, shapes, margin, Dot(d, d), step_s, slots, overflow);
  }
}

/// Stage: collide.
///   reads   pos, bodies[]     writes  contacts[], touches[] (geometry and materials), clearance
///   order   keys rising, in each body's slots and in each lane's list
/// Returns a bit for each lane with more contacts than room.
template <class W>
uint32_t StageCollide(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                      double step_s, W since_last) noexcept {
  const W h = W::Splat(step_s);
  BoundTurns(m, work, h, since_last);
  if (m.motion_count > 0) BoundMotions(m, s, work, h, since_last);
  uint32_t overflow = 0;
  int pair = 0;
  for (int body = 0; body < m.body_count; ++body) {
    SlotFiller<W> slots(m, work, body);
    CollidePlanes(m, s, work, h, body, slots);
    const auto is_mine = [&] { return pair < m.world_pair_count && m.body_pairs[pair].a == body; };
    for (; is_mine() && !m.body_pairs[pair].on_ground; ++pair) {
      CollideBodies(m, s, g, work, pair, step_s, since_last, &slots, &overflow);
    }
    if (const int first = pair; is_mine()) {  // surfaces are last
      while (is_mine()) ++pair;
      CollideGround(m, s, g, work, first, pair, step_s, since_last, &slots, &overflow);
    }
    work.contact_count[body] = slots.count();
  }
  for (int lane = 0; lane < W::kLanes; ++lane) work.touch_count[lane] = 0;
  for (; pair < m.body_pair_count; ++pair) {
    CollideBodies<W>(m, s, g, work, pair, step_s, since_last, nullptr, &overflow);
  }
  return overflow;
}

}  // namespace taut::sim
