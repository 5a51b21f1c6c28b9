/// Stage: collision detection between bodies and with the world, at the middle of the step
/// (docs/theory/contact.md, section 7).
///
/// Points on planes are tested in all lanes at once. Other pairs first pass a broad phase. In large
/// models, only near bodies form pairs (near_bodies.inl). A pair of bodies is tested only if the
/// motion since the last distance query may have used up its clearance, a pair of shapes only if
/// their bounding spheres overlap. The narrow phase then runs in scalar code for each lane
/// (shape_pairs.inl).
#pragma once

#include "sim/bodies/motion.inl"
#include "sim/contacts/body_distance.inl"
#include "sim/contacts/ground.inl"
#include "sim/contacts/joined_boxes.inl"
#include "sim/contacts/many_shapes.inl"
#include "sim/contacts/moving_pairs.h"
#include "sim/contacts/near_bodies.inl"
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

/// Returns whether two bodies may touch in some lane. `near`: lanes in which their clearance is
/// used up; `margin`: bound of their approach [m].
template <class W, class M, class Pair>
bool MayTouch(const View& m, const Rows<W>& s, const Scratch<W>& work, const Pair& bodies,
              W& clearance, M near, W margin) noexcept {
  if (bodies.b < m.body_count) {
    const V3<W> d = s.pos[bodies.a] - s.pos[bodies.b];
    const W reach = W::Splat(m.bound_m[bodies.a] + m.bound_m[bodies.b]);
    clearance = Max(clearance, Sqrt(Dot(d, d)) - reach);
    near = clearance < margin;
    if (!Any(near)) return false;
  }
  // A distance that holds in all lanes delays the next query in all lanes.
  const BodyDistance<W> exact = DistanceOfBodies(m, s, work, bodies, near);
  clearance = exact.everywhere ? exact.least : Select(near, exact.least, clearance);
  return Any(clearance < margin);
}

/// Finds the contacts of a body with static geometry.
template <class W>
void CollideWithWorld(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work, int pair,
                      double step_s, W since_last, SlotFiller<W>* slots,
                      uint32_t* overflow) noexcept {
  const WorldPairTable& bodies = m.world_pairs[pair];
  if (bodies.by_tree) {
    CollideManyShapes(m, s, g, work, pair, step_s, since_last, slots, overflow);
    return;
  }
  W margin;
  const auto near = ClearanceUsedUp(work, bodies.a, bodies.b, s.clearance[pair], W::Splat(step_s),
                                    since_last, margin);
  if (!Any(near)) return;
  if (!MayTouch(m, s, work, bodies, s.clearance[pair], near, margin)) return;
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

/// Finds the contacts of two moving bodies whose clearance is used up in the lanes `near`.
template <class W, class M>
[[gnu::noinline]] void CollideCloseBodies(const View& m, const Rows<W>& s, const Group& g,
                                          Scratch<W>& work, const MovingPair& bodies, W& clearance,
                                          M near, W margin, double step_s,
                                          uint32_t* overflow) noexcept {
  if (!MayTouch(m, s, work, bodies, clearance, near, margin)) return;
  uint32_t key = FirstKeyOf(m, bodies);
  for (int i = m.first_shape[bodies.a]; i < m.first_shape[bodies.a + 1]; ++i) {
    for (int k = m.first_shape[bodies.b]; k < m.first_shape[bodies.b + 1]; ++k) {
      const int a = m.body_shapes[i], b = m.body_shapes[k];
      const V3<W> d = ShapeCenter(m, s, work, a) - ShapeCenter(m, s, work, b);
      const W reach = W::Splat(m.shapes[a].bound_m + m.shapes[b].bound_m) + margin;
      if (Any(Dot(d, d) < reach * reach)) {
        CollideShapes<W>(m, s, g, work, PairOf(m, a, b, key), margin, Dot(d, d), step_s, nullptr,
                         overflow);
      }
      key += kMaxPointsPerPair;
    }
  }
}

/// Finds the contacts of two moving bodies. The test of the clearance is inline, because most pairs
/// of most steps need no more.
template <class W>
TAUT_INLINE void CollideMoving(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                               const MovingPair& bodies, W& clearance, double step_s, W since_last,
                               uint32_t* overflow) noexcept {
  W margin;
  const auto near =
      ClearanceUsedUp(work, bodies.a, bodies.b, clearance, W::Splat(step_s), since_last, margin);
  if (Any(near)) {
    CollideCloseBodies(m, s, g, work, bodies, clearance, near, margin, step_s, overflow);
  }
}

/// Stage: collide.
///   reads   pos, bodies[]     writes  contacts[], touches[] (geometry and materials), clearance
///   order   contacts by ascending key, in the slots of each body and in the list of each lane
/// Returns one bit per lane; it is set if the lane has more contacts than its memory can hold.
template <class W>
uint32_t StageCollide(const View& m, const Rows<W>& s, Group& g, Scratch<W>& work, double step_s,
                      W since_last) noexcept {
  const W h = W::Splat(step_s);
  BoundTurns(m, work, h, since_last);
  if (m.motion_count > 0) BoundMotions(m, s, work, h, since_last);
  uint32_t overflow = 0;
  int pair = 0;
  for (int body = 0; body < m.body_count; ++body) {
    SlotFiller<W> slots(m, work, body);
    CollidePlanes(m, s, work, h, body, slots);
    const auto is_mine = [&] { return pair < m.world_pair_count && m.world_pairs[pair].a == body; };
    for (; is_mine() && !m.world_pairs[pair].on_ground; ++pair) {
      CollideWithWorld(m, s, g, work, pair, step_s, since_last, &slots, &overflow);
    }
    if (const int first = pair; is_mine()) {  // surfaces are last
      while (is_mine()) ++pair;
      CollideGround(m, s, g, work, first, pair, step_s, since_last, &slots, &overflow);
    }
    work.contact_count[body] = slots.count();
  }
  for (int lane = 0; lane < W::kLanes; ++lane) work.touch_count[lane] = 0;
  if (m.near_capacity == 0) {
    work.moving_pairs = m.moving_pairs, work.moving_count = m.moving_pair_count;
  } else {
    FindNear(m, s, g, work, h);
    work.moving_pairs = g.near, work.moving_count = g.near_count > 0 ? g.near_count : 0;
  }
  for (int i = 0; i < work.moving_count; ++i) {
    CollideMoving(m, s, g, work, work.moving_pairs[i], s.clearance[m.world_pair_count + i], step_s,
                  since_last, &overflow);
  }
  if (g.near_count < 0) {
    EachNearPair(m, s, work, s.near_m[0], [&](const MovingPair& bodies) {
      W unknown = W::Splat(0.0);
      CollideMoving(m, s, g, work, bodies, unknown, step_s, since_last, &overflow);
      return true;
    });
  }
  return overflow;
}

}  // namespace taut::sim
