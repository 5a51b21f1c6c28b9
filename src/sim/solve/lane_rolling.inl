/// Fixed-point rounds of LaneSolve for rolling on kinematic bodies or on bodies with joints
/// (rolling.inl).
#pragma once

#include "sim/data/rows.h"
#include "sim/solve/lane_solve.inl"
#include "sim/solve/rolling.inl"

namespace taut::sim {

/// Returns one body of a rolling contact, with the velocities in the memory of the island.
template <class W>
RollingSide<simd::Lane<W>> LaneSolve<W>::SideOf(const Contact<L, 2>& c, int k,
                                                const Shape& shape) const noexcept {
  const L half = L::Splat(0.5), sign = L::Splat(k == 0 ? 1.0 : -1.0);
  const int body = c.links[k].body;
  RollingSide<L> side;
  side.is_round = shape.kind == ShapeKind::kRound;
  side.radius = L::Splat(RadiusOf(shape)) + half * c.gap;
  side.arm = c.arm[k];
  side.skeleton = c.arm[k] + (sign * side.radius) * c.links[0].lin[0];
  if (m_.HasMotion(body)) {
    const int i = m_.motion_of_body[body];
    side.v = OfLane<L>(work_.bodies[body].v, lane_);
    side.w = OfLane<L>(work_.bodies[body].w, lane_);
    side.x_end = OfLane<L>(work_.motions[i].end.pos - s_.pos[body], lane_);
  } else {
    const Twist<L> t = mem_.island.Load(mem_.island.m.v + kDofs * Number(body));
    side.v = t.v, side.w = t.w;
    side.x_end = (half * h_) * t.v;
  }
  return side;
}

/// Calls f(point, touch, pair) for the rolling contacts of the island.
template <class W>
template <class F>
void LaneSolve<W>::EachRolling(const F& f) noexcept {
  Pool<ContactPoint<L, 2>>& pool = mem_.island.pools;
  for (int i = 0; i < pool.count; ++i) {
    const int touch = mem_.source[i] - m_.slot_count;
    if (touch < 0) continue;
    const TouchingPair& pair = work_.touches[lane_ * m_.pair_capacity + touch];
    if (m_.Rolls(pair.a, pair.b)) f(pool.items[i], mem_.pairs[touch], pair);
  }
}

template <class W>
bool LaneSolve<W>::FindRolling() noexcept {
  if (m_.motion_count == 0 && m_.joint_count == 0) return false;
  bool any = false;
  EachRolling([&](const auto&, const auto&, const auto&) { any = true; });
  return any;
}

/// Predicts the final velocities from the velocity changes in the previous step.
template <class W>
void LaneSolve<W>::ExpectVelocities() noexcept {
  for (int k = 0; k < count_; ++k) {
    const BodyWork<W>& body = work_.bodies[mem_.island.bodies[k].body];
    const V3<W> v = body.v_mid + (body.v_mid - body.v0), w = body.w_mid + (body.w_mid - body.w0);
    mem_.island.Store({OfLane<L>(v, lane_), OfLane<L>(w, lane_)}, mem_.island.m.v + kDofs * k);
  }
}

/// Sets the biases of the island's rolling contacts from the velocities in its memory. Returns the
/// largest change [m/s].
template <class W>
double LaneSolve<W>::FollowRolling() noexcept {
  const L half_h = L::Splat(0.5) * h_;
  double change = 0;
  EachRolling([&](ContactPoint<L, 2>& point, const Contact<L, 2>& c, const TouchingPair& pair) {
    const RollingSide<L> a = SideOf(c, 0, m_.shapes[pair.a].shape_P);
    const RollingSide<L> b = SideOf(c, 1, m_.shapes[pair.b].shape_P);
    // Both points are relative to a's origin at the middle of the step. The arms differ by the
    // vector between the bodies.
    const V3<L> b_from_a = a.arm - b.arm;
    const V3<L> p = PointAtEnd(a, b, b_from_a, c.links[0].lin[0], half_h);
    const V3<L> slip =
        Cross(a.w, (p - a.x_end) - a.arm) - Cross(b.w, (p - b_from_a - b.x_end) - b.arm);
    for (int r = 1; r < 3; ++r) {
      if (r == 2 && c.one_direction) continue;
      const L bias = c.bias[r] + Dot(c.links[0].lin[r], slip);
      const double by = Abs(bias - point.bias[r])[0];
      if (by > change) change = by;
      point.bias[r] = bias;
    }
  });
  return change;
}

/// Stores the biases for the residual of the contacts.
template <class W>
void LaneSolve<W>::KeepRolling() noexcept {
  EachRolling([&](const ContactPoint<L, 2>& point, Contact<L, 2>& c, const TouchingPair&) {
    for (int r = 1; r < 3; ++r) c.bias[r] = point.bias[r];
  });
}

}  // namespace taut::sim
