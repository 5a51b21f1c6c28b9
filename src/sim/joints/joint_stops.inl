/// Joint limits (stops; docs/theory/joints.md, section 3): approach, closed state and rebound.
#pragma once

#include "sim/contacts/prepare_contact.inl"
#include "sim/contacts/slots.inl"
#include "sim/data/rows.h"
#include "sim/joints/joints.inl"

namespace taut::sim {

/// Largest gap, in addition to the sagitta of the arc, at which a limit with a contact force stays
/// closed [m].
inline constexpr double kStopClosedM = 1e-7;

/// A closed limit reverses a residual velocity up to this fraction of the velocity change in the
/// step.
inline constexpr double kStopTurned = 0.1;

/// Predicts the pose of a joint after time `t` at the velocities a and b.
template <class W>
JointPlace<W> PlaceAfter(const JointPlace<W>& p, const Twist<W>& a, const Twist<W>& b,
                         W t) noexcept {
  const V3<W> turn_a = t * a.w, turn_b = t * b.w;
  const auto axes = [](const V3<W>& turn, const M3<W>& of) {
    return M3<W>{Turned(turn, of.r0), Turned(turn, of.r1), Turned(turn, of.r2)};
  };
  JointPlace<W> q;
  q.own_a = Turned(turn_a, p.own_a), q.own_b = Turned(turn_b, p.own_b);
  q.gap = p.gap + t * (b.v - a.v) + (q.own_b - p.own_b) - (q.own_a - p.own_a);
  q.axes_a = axes(turn_a, p.axes_a), q.axes_b = axes(turn_b, p.axes_b);
  return q;
}

/// Returns the angle of a hinge, unwrapped near `last`; 0 for other joints.
template <class W>
TAUT_INLINE W AngleAt(const JointTable& j, const JointPlace<W>& p, W last) noexcept {
  return j.has_angle ? HingeAngle(p, last) : W::Splat(0.0);
}

/// Free motion of a body in the second half of the step: mean and final velocities. The angular
/// velocity w changes by w1 = I^-1 (L x w). Near rotations of 1 rad per step, where this series
/// fails, the change is reduced.
template <class W>
struct FreeHalf {
  Twist<W> mean, end;

  FreeHalf(const BodyWork<W>& body, bool moves, W half_h) noexcept
      : mean{body.v0, body.w0}, end(mean) {
    if (!moves) return;
    const W one = W::Splat(1.0), half = W::Splat(0.5), h = half_h + half_h;
    const W radians2 = h * h * Dot(body.w0, body.w0);
    const V3<W> momentum = body.mom_free - h * body.torque;
    const W share = half_h / (one + radians2 * radians2);
    const V3<W> change = share * (body.inv_inertia * Cross(momentum, body.w0));
    mean.w += half * change, end.w += change;
  }
};

/// Returns the change of a row's velocity over half a step of free motion: its bodies move on arcs
/// at their velocities before the step.
template <class W>
W BendOf(const Scratch<W>& work, const JointTable& j, const JointRowTable& table,
         const JointPlace<W>& place, const JointDirection<W>& d, W angle, W half_h) noexcept {
  const BodyWork<W>&a = work.bodies[j.a], &b = work.bodies[j.b];
  const FreeHalf<W> free_a(a, j.a_moves, half_h), free_b(b, j.b_moves, half_h);
  const JointPlace<W> end = PlaceAfter(place, free_a.mean, free_b.mean, half_h);
  return RateOf(end, DirectionOf(j, table, end, angle), free_a.end, free_b.end) -
         RateOf(place, d, Before(a), Before(b));
}

/// Predicts the velocities of a body after the step. Linear velocity: adds the change in the
/// previous step; in the first step, the effect of the applied forces. Angular velocity: adds the
/// effect of the applied torques, and of the torques of contacts and stiff cables in the previous
/// step, without changing these torques.
template <class W>
Twist<W> Ahead(const Rows<W>& s, const BodyWork<W>& body, int b, bool moves, W h) noexcept {
  Twist<W> t = Free(body);
  if (!moves) return t;
  const V3<W> v = (body.v_mid + body.v_mid) - body.v0;
  t.v = Select3(s.last_step[0] > W::Splat(0.0), v, t.v);
  t.w += body.inv_inertia * (h * s.held_torque[b]);
  return t;
}

/// Returns the rebound speed at a limit with restitution e (eq. 15), or 0. `before`: row velocity;
/// `kick`: its decrease by forces in the step; `gap`: at the middle of the step. The impact is
/// evaluated at the limit and extrapolated back under the acceleration of forces and arc. A bounce
/// that ends within the step is ignored.
template <class W>
W ReboundOf(W e, W before, W kick, W bend, W gap, W h) noexcept {
  const W zero = W::Splat(0.0), half = W::Splat(0.5), one = W::Splat(1.0);
  const W least = W::Splat(kLeastRebound), nearer = kick - (bend + bend), e2 = e * e;
  const W arrives = half * kick - before;
  const W fall = (one - e2) * (nearer + nearer) * (Max(gap, zero) / h);
  const W leaves = Sqrt(Max(e2 * arrives * arrives - fall, zero)) - half * kick;
  const W speed = Min(leaves, zero - before);
  const auto bounces = (zero - e * before > least) & (Min(speed, speed + bend) > least);
  return Select(bounces, speed, zero);
}

/// Sets the law of a joint limit (eq. 4). `load`: its force in the previous step [N].
///
/// A limit that had a force and is closed reverses the small residual velocity of the previous step
/// (eq. 3), so that it does no work. The reversal of a larger velocity, for example after a snatch,
/// would repeat in every step; in this case, the bodies end the step at rest on their arc. Other
/// limits let their bodies approach until contact. Beyond a limit, bodies return no faster than the
/// forces of this step would move them further, as in a penetrating contact (contact.md, eq. 2).
/// StageJointPlaces closes the remaining distance of about a step.
template <class W>
void SetStop(const Rows<W>& s, const Scratch<W>& work, const JointTable& j,
             const JointRowTable& table, const JointPlace<W>& place, const JointDirection<W>& d,
             W angle, W load, W h, HeldRow<W>& row) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0), half = W::Splat(0.5);
  const BodyWork<W>&a = work.bodies[j.a], &b = work.bodies[j.b];
  const W before = RateOf(place, d, Before(a), Before(b)), speed = Abs(before);
  const W free = RateOf(place, d, Free(a), Free(b)), gap = d.value;
  const W bend = BendOf(work, j, table, place, d, angle, half * h);
  // Sagitta: distance between chord and arc at the middle of the step.
  const W sagitta = W::Splat(0.25) * h * bend, off = gap - sagitta;
  row.reach = h * (speed + Abs(free)) + W::Splat(kContactMarginM);
  row.live = Select(gap < row.reach, row.live, zero);
  row.lower = zero;
  const auto closed = (off < W::Splat(kStopClosedM) + Abs(sagitta)) & (off > zero - row.reach);
  const auto pressed = load > zero, held = pressed & closed;
  row.held = Select(held, one, zero);
  const W slowly = W::Splat(kPushOutShare) * speed;
  const W back = Max(off / h, zero - (half * Max(before - free, zero) + slowly));
  const auto small = Abs(before - bend) < W::Splat(kStopTurned) * (Abs(bend) + Abs(before - free));
  const W at_rest = zero - Max(bend, before), turned = zero - before;
  row.target = Select(held, Select(small, turned, at_rest), zero - (bend + back));
  // The previous force is no measure of forces that pull bodies away from the limit.
  const W kick =
      before - RateOf(place, d, Ahead(s, a, j.a, j.a_moves, h), Ahead(s, b, j.b, j.b_moves, h));
  const W least_kick = Select(pressed, zero, zero - speed);
  row.rebound = ReboundOf(Select(held, zero, W::Splat(j.restitution)), before,
                          Max(kick, least_kick), bend, gap, h);
}

template <class W>
TAUT_INLINE MaskOf<W> Presses(const HeldRow<W>& row) noexcept {
  const W zero = W::Splat(0.0);
  return (row.live > zero) & (row.l[0] > zero);
}

/// Returns the lanes in which displacements close a limit. Such a limit had a force in this step,
/// and is closed or was passed. If the bodies passed it by more than the motion of one step
/// (initial or set state), eq. 4 returns the bodies instead.
template <class W>
MaskOf<W> IsClosedAtEnd(const HeldRow<W>& row, W gap) noexcept {
  const W zero = W::Splat(0.0);
  return Presses(row) & (gap > zero - row.reach) & ((gap < zero) | (row.held > zero));
}

}  // namespace taut::sim
