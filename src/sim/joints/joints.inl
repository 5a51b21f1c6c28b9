/// Joints (docs/theory/joints.md): rows for the solver at the middle of the step, including
/// kinematic loops, and loads from their impulses.
#pragma once

#include "sim/data/rows.h"

namespace taut::sim {

/// Pose of a joint: points and axes in W. Points are relative to the centers of mass of their
/// bodies.
template <class W>
struct JointPlace {
  V3<W> own_a, own_b;  ///< Joint points of a and b [m].
  V3<W> gap;           ///< From a's point to b's point [m].
  M3<W> axes_a, axes_b;

  V3<W> arm_a() const noexcept { return own_a + gap; }  ///< Lever arm to b's point.
};

/// Directions of a row for b's velocity at its point and for b's rotation; the directions for a are
/// opposite. Also the coordinate of the row, whose rate is the row velocity.
template <class W>
struct JointDirection {
  V3<W> lin, turn;
  W value;
};

template <class W>
TAUT_INLINE M3<W> AxesOf(const M3<W>& R, const double* axes_P) noexcept {
  return {R * simd::Splat3<W>(axes_P), R * simd::Splat3<W>(axes_P + 3),
          R * simd::Splat3<W>(axes_P + 6)};
}

/// Returns the pose of a joint from the frames in `work`.
template <class W>
JointPlace<W> PlaceOf(const View& m, const Rows<W>& s, const Scratch<W>& work,
                      const JointTable& j) noexcept {
  const M3<W>&Ra = work.bodies[j.a].R, &Rb = work.bodies[j.b].R;
  JointPlace<W> p;
  p.own_a = Ra * simd::Splat3<W>(j.own_a_P), p.own_b = Rb * simd::Splat3<W>(j.own_b_P);
  p.gap = p.own_b - p.own_a;
  if (j.b < m.body_count) p.gap += s.pos[j.b];
  if (j.a < m.body_count) p.gap -= s.pos[j.a];
  p.axes_a = AxesOf(Ra, j.axes_a_P), p.axes_b = AxesOf(Rb, j.axes_b_P);
  return p;
}

/// Returns the unwrapped angle of a hinge nearest to `expected`, which must be accurate to half a
/// turn. Therefore `expected` must follow the rate of the hinge.
template <class W>
TAUT_INLINE W HingeAngle(const JointPlace<W>& p, W expected) noexcept {
  const W turn = W::Splat(2 * simd::kPi), inv_turn = W::Splat(0.5 / simd::kPi);
  const W angle = simd::Atan2(Dot(p.axes_a.r2, p.axes_b.r1), Dot(p.axes_a.r1, p.axes_b.r1));
  return angle + turn * simd::Round(inv_turn * (expected - angle));
}

/// Returns the rotation from a's axes to b's axes as a vector in W: axis * angle, 0..pi. At half a
/// turn, the result is one of the two possible vectors.
template <class W>
V3<W> TurnOf(const JointPlace<W>& p) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0), tiny = W::Splat(1e-300);
  const W aa = Dot(p.axes_a.r0, p.axes_b.r0), bb = Dot(p.axes_a.r1, p.axes_b.r1),
          cc = Dot(p.axes_a.r2, p.axes_b.r2);
  const W ab = Dot(p.axes_a.r0, p.axes_b.r1), ba = Dot(p.axes_a.r1, p.axes_b.r0),
          ac = Dot(p.axes_a.r0, p.axes_b.r2), ca = Dot(p.axes_a.r2, p.axes_b.r0),
          bc = Dot(p.axes_a.r1, p.axes_b.r2), cb = Dot(p.axes_a.r2, p.axes_b.r1);
  // Quaternion times its transpose, 4 q q^T. Each row is parallel to q, and the largest one is well
  // conditioned.
  const W w[4] = {one + aa + bb + cc, cb - bc, ac - ca, ba - ab};
  const W x[4] = {w[1], one + aa - bb - cc, ab + ba, ac + ca};
  const W y[4] = {w[2], x[2], one - aa + bb - cc, bc + cb};
  const W z[4] = {w[3], x[3], y[3], one - aa - bb + cc};
  const auto xy = x[1] > y[2], xyz = Max(x[1], y[2]) > z[3];
  const auto first = w[0] > Max(x[1], Max(y[2], z[3]));
  W q[4];
  for (int i = 0; i < 4; ++i) q[i] = Select(first, w[i], Select(xyz, Select(xy, x[i], y[i]), z[i]));
  const auto back = q[0] < zero;
  for (W& part : q) part = Select(back, zero - part, part);
  const W sine = Sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const W angle = W::Splat(2.0) * simd::Atan2(sine, q[0]), scale = angle / Max(sine, tiny);
  return (scale * q[1]) * p.axes_a.r0 + (scale * q[2]) * p.axes_a.r1 + (scale * q[3]) * p.axes_a.r2;
}

/// Returns direction and value of a measure. `angle`: angle of a hinge, including whole turns. For
/// the rotation of a ball joint, TurnOf returns the value.
template <class W>
JointDirection<W> DirectionOf(const JointTable& j, JointMeasure measure, const JointPlace<W>& p,
                              W angle) noexcept {
  const W zero = W::Splat(0.0), reach = W::Splat(j.reach_m), tiny = W::Splat(1e-300);
  const V3<W> none{zero, zero, zero};
  const auto along = [&](const V3<W>& axis) {
    return JointDirection<W>{axis, none, Dot(axis, p.gap)};
  };
  const auto across = [&](const V3<W>& in_a, const V3<W>& in_b) {
    return JointDirection<W>{none, reach * Cross(in_b, in_a), reach * Dot(in_a, in_b)};
  };
  switch (measure) {
    case JointMeasure::kAlongAxis:
      return along(p.axes_a.r0);
    case JointMeasure::kAcross1:
      return along(p.axes_a.r1);
    case JointMeasure::kAcross2:
      return along(p.axes_a.r2);
    case JointMeasure::kDistance: {
      const W length = Sqrt(Dot(p.gap, p.gap));
      return {(W::Splat(1.0) / Max(length, tiny)) * p.gap, none, length};
    }
    case JointMeasure::kSwing1:
      return across(p.axes_a.r1, p.axes_b.r0);
    case JointMeasure::kSwing2:
      return across(p.axes_a.r2, p.axes_b.r0);
    case JointMeasure::kTwist:
      return across(p.axes_a.r2, p.axes_b.r1);
    case JointMeasure::kAngle:
      return {none, reach * p.axes_a.r0, reach * angle};
    case JointMeasure::kTurn1:
      return {none, reach * p.axes_a.r0, zero};
    case JointMeasure::kTurn2:
      return {none, reach * p.axes_a.r1, zero};
    case JointMeasure::kTurn3:
      return {none, reach * p.axes_a.r2, zero};
    case JointMeasure::kCone:
      break;
  }
  const V3<W> c = Cross(p.axes_a.r0, p.axes_b.r0);
  const W sine = Sqrt(Dot(c, c));
  return {none, (reach / Max(sine, tiny)) * c,
          reach * simd::Atan2(sine, Dot(p.axes_a.r0, p.axes_b.r0))};
}

/// Returns direction and value of a row's measure, with the sign of the row's role. The value of a
/// joint limit is the remaining distance, so its impulse pushes.
template <class W>
JointDirection<W> DirectionOf(const JointTable& j, const JointRowTable& row, const JointPlace<W>& p,
                              W angle) noexcept {
  JointDirection<W> d = DirectionOf(j, row.measure, p, angle);
  if (row.role == JointRole::kMost) {
    d = {-d.lin, -d.turn, W::Splat(j.most) - d.value};
  } else if (row.role == JointRole::kLeast) {
    d.value -= W::Splat(j.least);
  }
  return d;
}

/// Returns the velocity of a row for the body velocities (va, wa) and (vb, wb).
template <class W>
TAUT_INLINE W RateOf(const JointPlace<W>& p, const JointDirection<W>& d, const Twist<W>& a,
                     const Twist<W>& b) noexcept {
  const V3<W> apart = (b.v + Cross(b.w, p.own_b)) - (a.v + Cross(a.w, p.arm_a()));
  return Dot(d.lin, apart) + Dot(d.turn, b.w - a.w);
}

/// Computes links and inverse effective mass of a row in direction `d`. The first link is to a body
/// that impulses move.
///
/// A joint that constrains a point pushes each body at the body's own joint point (joints.md,
/// section 2). A push at the point of the other body, which differs by the gap, would spin a thin
/// rod about its axis and make redundant rows independent.
template <class W>
void SetJointLinks(const Rows<W>& s, const Scratch<W>& work, const JointTable& j,
                   const JointPlace<W>& p, const JointDirection<W>& d, JointRow<W>& row) noexcept {
  const V3<W> arm_a = j.holds_point ? p.own_a : p.arm_a();
  const V3<W> on_b = Cross(p.own_b, d.lin) + d.turn, on_a = -(Cross(arm_a, d.lin) + d.turn);
  row.link_count = 0;
  const auto link = [&](int body, const V3<W>& lin, const V3<W>& ang) {
    Link<W, 1>& to = row.links[row.link_count++];
    to.body = body;
    to.inv_mass = s.inv_mass[body];
    to.lin[0] = lin, to.ang[0] = ang;
    to.turn[0] = work.bodies[body].inv_inertia * ang;
  };
  if (j.b_moves) link(j.b, d.lin, on_b);
  if (j.a_moves) link(j.a, -d.lin, on_a);
  if (j.b_is_moved) link(j.b, d.lin, on_b);
  if (j.a_is_moved) link(j.a, -d.lin, on_a);
  row.FinishMasses();
}

/// Returns a + turn x a + turn x (turn x a) / 2.
template <class W>
TAUT_INLINE V3<W> Turned(const V3<W>& turn, const V3<W>& a) noexcept {
  const V3<W> once = Cross(turn, a);
  return a + once + W::Splat(0.5) * Cross(turn, once);
}

template <class W>
TAUT_INLINE Twist<W> Before(const BodyWork<W>& body) noexcept {
  return {body.v0, body.w0};
}
template <class W>
TAUT_INLINE Twist<W> Free(const BodyWork<W>& body) noexcept {
  return {body.v, body.w};
}

/// Sets the law of a spring and damper: a line through the mean of start and end of the step (eq.
/// 6).
template <class W>
void SetSpring(const JointTable& j, W stretch, W before, W h, JointRow<W>& row) noexcept {
  const W one = W::Splat(1.0), half = W::Splat(0.5), quarter = W::Splat(0.25);
  const W k = h * W::Splat(j.stiffness), b = h * W::Splat(j.damping);
  const W gain = quarter * h * k + half * b;
  row.give = one / gain;
  row.target = (quarter * h * k * before - half * b * before - k * stretch) / gain;
}

/// Sets the law of a constrained row (eq. 3), which reverses its velocity, so that its impulse does
/// no work. A tiny compliance relative to the previous impulse, if there is one, makes nearly
/// dependent rows solvable.
template <class W>
void SetHeld(const Rows<W>& s, const Scratch<W>& work, W last_impulse, JointRow<W>& row) noexcept {
  const W zero = W::Splat(0.0);
  W before = zero;
  for (int k = 0; k < row.link_count; ++k) {
    const BodyWork<W>& body = work.bodies[row.links[k].body];
    AddVelocity(row.links[k], body.v0, body.w0, &before);
  }
  row.compliant = true;
  row.give = Select(s.last_step[0] > zero, W::Splat(kHeldCompliance) * row.A, zero);
  row.target = row.give * last_impulse - before;
}

/// Returns the displacement of a body from FindClosing.
template <class W>
Twist<W> ClosingOf(const View& m, const Scratch<W>& work, int body) noexcept {
  const W zero = W::Splat(0.0);
  const int number = m.joint_number[body];
  if (number < 0 || number >= m.joint_body_count) return {{zero, zero, zero}, {zero, zero, zero}};
  return Island<W, Pools<JointRow<W>>>::Load(work.joint_memory.change + kDofs * number);
}

/// Rotates the lever arms of a row from the closed pose back to the current pose, so that no row
/// spins a thin rod about its axis.
template <class W>
void TurnLinksBack(const View& m, const Scratch<W>& work, JointRow<W>& row) noexcept {
  for (int k = 0; k < row.link_count; ++k) {
    Link<W, 1>& link = row.links[k];
    link.ang[0] = Turned(-ClosingOf(m, work, link.body).w, link.ang[0]);
    link.turn[0] = work.bodies[link.body].inv_inertia * link.ang[0];
  }
  row.FinishMasses();
}

template <class W>
void FindClosing(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept;

/// Assembles the rows of all joints. With kinematic loops, the constrained rows are evaluated at
/// the nearest closed pose, because redundant rows are exactly dependent only there.
///   reads   pos, bodies[]     writes  joints[], joint_angle
template <class W>
void PrepareJoints(const View& m, const Rows<W>& s, Scratch<W>& work, double step_s) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  const W h = W::Splat(step_s), half_h = W::Splat(0.5 * step_s);
  const W no_limit = W::Splat(JointRow<W>::kNoLimit);
  const W live = Select(s.halted[0] > zero, zero, one);
  if (m.joint_loops) FindClosing(m, s, work);
  for (int i = 0; i < m.joint_count; ++i) {
    const JointTable& j = m.joints[i];
    const BodyWork<W>&a = work.bodies[j.a], &b = work.bodies[j.b];
    const JointPlace<W> place = PlaceOf(m, s, work, j);
    JointPlace<W> closed = place;
    if (m.joint_loops) {
      closed = PlaceAfter(place, ClosingOf(m, work, j.a), ClosingOf(m, work, j.b), one);
    }
    W angle = zero;
    if (j.has_angle) {
      const W turned = half_h * Dot(place.axes_a.r0, b.w0 - a.w0);
      s.joint_angle[i] = angle = HingeAngle(place, s.joint_angle[i] + turned);
    }
    V3<W> turned{zero, zero, zero};
    if (j.has_turn_spring) turned = TurnOf(place);
    for (int r = j.first_row; r < j.first_row + j.row_count; ++r) {
      const JointRowTable& table = m.joint_rows[r];
      HeldRow<W>& row = work.joints[r];
      const bool at_closed = m.joint_loops && table.role == JointRole::kHold;
      JointDirection<W> d = DirectionOf(j, table, at_closed ? closed : place, angle);
      row.joint = i;
      row.lin = d.lin, row.turn = d.turn;
      SetJointLinks(s, work, j, at_closed ? closed : place, d, row);
      if (at_closed) TurnLinksBack(m, work, row);
      row.live = live;
      row.target = row.give = row.rebound = row.held = row.reach = zero;
      row.lower = -no_limit, row.upper = no_limit;
      row.compliant = false;
      switch (table.role) {
        case JointRole::kHold:
          SetHeld(s, work, h * s.joint_load[r], row);
          break;
        case JointRole::kLeast:
        case JointRole::kMost:
          SetStop(s, work, j, table, place, d, angle, s.joint_load[r], h, row);
          break;
        case JointRole::kFriction:
        case JointRole::kTurnFriction:
          row.upper = h * W::Splat(j.friction);
          row.lower = -row.upper;
          break;
        case JointRole::kSpring:
          if (j.has_turn_spring) d.value = Dot(d.turn, turned);
          SetSpring(j, d.value - W::Splat(j.rest), RateOf(place, d, Before(a), Before(b)), h, row);
          break;
      }
      row.l[0] = Select(row.live > zero, Min(Max(h * s.joint_load[r], row.lower), row.upper), zero);
    }
  }
}

template <class W>
void ForgetGains(const View& m, Scratch<W>& work) noexcept {
  const W zero = W::Splat(0.0);
  for (int k = 0; k < m.joint_body_count; ++k) {
    work.joint_memory.gained[k] = V3<W>{zero, zero, zero};
  }
}

/// Returns the total angular momentum from a unit impulse of a row on both bodies, whose points are
/// separated by the gap (eq. 9).
template <class W>
TAUT_INLINE V3<W> GainOf(const JointRow<W>& row, const V3<W>& pos_first,
                         const V3<W>& pos_second) noexcept {
  return Cross(pos_first - pos_second, row.links[0].lin[0]) +
         (row.links[0].ang[0] + row.links[1].ang[0]);
}

/// Argument `skip` or `closed` for no lanes.
template <class W>
struct InNoLane {
  template <class T>
  TAUT_INLINE MaskOf<W> operator()(const T&) const noexcept {
    return MaskOf<W>::Splat(false);
  }
};

/// Returns the lanes in which a body was integrated together with stiff cables. The joints of such
/// bodies are closed, and their momenta are balanced (implicit_joints.inl).
template <class W>
TAUT_INLINE MaskOf<W> EndedImplicitly(const View& m, const Scratch<W>& work, int body) noexcept {
  if (!work.implicit.any || body >= m.body_count) return MaskOf<W>::Splat(false);
  return work.implicit.ended[body] > W::Splat(0.0);
}
/// Same as above for the bodies of a joint.
template <class W>
TAUT_INLINE MaskOf<W> EndedImplicitly(const View& m, const Scratch<W>& work,
                                      const JointTable& j) noexcept {
  return EndedImplicitly(m, work, j.moved_body());
}

/// Returns the lanes in which dampers act on stiff cables at the bodies of a joint.
template <class W>
TAUT_INLINE MaskOf<W> EndedDamped(const View& m, const Scratch<W>& work,
                                  const JointTable& j) noexcept {
  const int body = j.moved_body();
  if (!work.implicit.any || body >= m.body_count) return MaskOf<W>::Splat(false);
  return work.implicit.bodies[body] > W::Splat(1.0);
}

/// Computes the loads of joints from the solver's impulses, and adds these impulses to the angular
/// momenta of the bodies.
template <class W>
void FinishJoints(const View& m, const Rows<W>& s, Scratch<W>& work, double step_s) noexcept {
  const W zero = W::Splat(0.0), inv_h = W::Splat(1.0 / step_s);
  const V3<W> none{zero, zero, zero};
  for (int i = 0; i < m.joint_count; ++i) s.joint_force[i] = s.joint_torque[i] = none;
  for (int r = 0; r < m.joint_row_count; ++r) {
    const HeldRow<W>& row = work.joints[r];
    const W l = Select(row.live > zero, row.l[0], zero), load = inv_h * l;
    for (int k = 0; k < row.link_count; ++k) {
      s.mom[row.links[k].body] += l * row.links[k].ang[0];
    }
    s.joint_load[r] = load + zero;
    s.joint_force[row.joint] += load * row.lin;
    s.joint_torque[row.joint] += load * row.turn;
  }
  ForgetGains(m, work);
  if (m.free_chain_count == 0) return;
  const W h = W::Splat(step_s);
  for (int r = 0; r < m.joint_row_count; ++r) {
    const HeldRow<W>& row = work.joints[r];
    if (m.joint_rows[r].role != JointRole::kHold || row.link_count < 2) continue;
    const int first = row.links[0].body, second = row.links[1].body;
    if (m.HasMotion(first) || m.HasMotion(second)) continue;
    const W l = Select(EndedImplicitly(m, work, first), zero, h * s.joint_load[r]);
    work.joint_memory.gained[m.joint_number[first]] += l * GainOf(row, s.pos[first], s.pos[second]);
  }
}

}  // namespace taut::sim

#include "sim/joints/joint_stops.inl"
