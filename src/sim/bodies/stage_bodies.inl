/// Stages of the rigid bodies: drift, kinematics, kick (docs/theory/integrator.md).
///
///   state   pos x, quat q_WP, vel v, mom L: angular momentum about the center of mass, in W
///
/// Free rotation conserves L and rotates q. The Hamiltonian is H = L^2 / (2 Ix) + a remainder. The
/// remainder is small for rods, because z is the axis of near symmetry (model.cpp). The first term
/// rotates the body about L, the remainder about its y and z axes (docs/theory/integrator.md,
/// I5-I6; after Dullweber, Leimkuhler, McLachlan, J. Chem. Phys. 107, 1997, eq. 2.4). L is
/// conserved up to rounding. The energy of an axisymmetric body is conserved, too, at any spin; for
/// other bodies, the energy error stays bounded.
#pragma once

#include "sim/data/rows.h"

namespace taut::sim {

/// Returns tan(theta / 2). For a rotation vector theta L, pass its squared length as `theta2`; the
/// result is then the factor of L. The series theta/2 (1 + theta^2/12) gives a valid rotation for
/// any theta, with an angle correct to O(theta^5).
template <class W>
TAUT_INLINE W HalfAngle(W theta, W theta2) noexcept {
  return W::Splat(0.5) * theta * (W::Splat(1.0) + W::Splat(1.0 / 12.0) * theta2);
}

/// Rotates the angular momentum in the body frame while the body rotates by theta about one axis.
template <class W>
struct AxisTurn {
  W t, c, s;
  explicit AxisTurn(W theta) noexcept {
    const W one = W::Splat(1.0);
    t = HalfAngle(theta, theta * theta);
    const W tt = t * t;
    const W scale = one / (one + tt);
    c = (one - tt) * scale;
    s = (t + t) * scale;
  }
  void Turn(W& a, W& b) const noexcept {
    const W a1 = c * a + s * b;
    b = c * b - s * a;
    a = a1;
  }
};

/// Normalizes q and returns its squared length. If this length is infinite (possible for finite
/// components), the result is not a rotation.
template <class W>
TAUT_INLINE W NormalizeQuat(Q4<W>& q) noexcept {
  const W square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  const W scale = W::Splat(1.0) / Sqrt(square);
  q = {q.w * scale, q.x * scale, q.y * scale, q.z * scale};
  return square;
}

/// Rotates about a body axis: q <- q (1, t e_axis), not normalized.
template <class W>
TAUT_INLINE void TurnY(Q4<W>& q, W t) noexcept {
  q = {q.w - t * q.y, q.x - t * q.z, q.y + t * q.w, q.z + t * q.x};
}
template <class W>
TAUT_INLINE void TurnZ(Q4<W>& q, W t) noexcept {
  q = {q.w - t * q.z, q.x + t * q.y, q.y - t * q.x, q.z + t * q.w};
}

/// Rotates about u, a fixed direction in W: q <- (1, u) q, not normalized.
template <class W>
TAUT_INLINE void TurnAbout(Q4<W>& q, const V3<W>& u) noexcept {
  q = {q.w - (u.x * q.x + u.y * q.y + u.z * q.z), q.x + (u.x * q.w + u.y * q.z - u.z * q.y),
       q.y + (u.y * q.w + u.z * q.x - u.x * q.z), q.z + (u.z * q.w + u.x * q.y - u.y * q.x)};
}

/// Same rotations, from cosine and sine of half the angle.
template <class W>
TAUT_INLINE void TurnY(Q4<W>& q, W c, W s) noexcept {
  q = {c * q.w - s * q.y, c * q.x - s * q.z, c * q.y + s * q.w, c * q.z + s * q.x};
}
template <class W>
TAUT_INLINE void TurnZ(Q4<W>& q, W c, W s) noexcept {
  q = {c * q.w - s * q.z, c * q.x + s * q.y, c * q.y - s * q.x, c * q.z + s * q.w};
}
template <class W>
TAUT_INLINE void TurnAbout(Q4<W>& q, W c, const V3<W>& u) noexcept {
  q = {c * q.w - (u.x * q.x + u.y * q.y + u.z * q.z), c * q.x + (u.x * q.w + u.y * q.z - u.z * q.y),
       c * q.y + (u.y * q.w + u.z * q.x - u.x * q.z),
       c * q.z + (u.z * q.w + u.x * q.y - u.y * q.x)};
}

/// Angle per half step [rad] above which bodies on hinges use sine and cosine. Below it, they use
/// the series of HalfAngle, with an error of at most 3e-5 of the angle. Hinges need sine and
/// cosine, because their turns are counted.
inline constexpr double kSeriesTurn = 0.25;

/// Cosine and sine of theta / 2 in the lanes `fast`; 1 and HalfAngle in other lanes, to be
/// normalized.
template <class W>
struct HalfTurn {
  W c = W::Splat(1.0), s;
  HalfTurn(W theta, MaskOf<W> fast) noexcept {
    s = HalfAngle(theta, theta * theta);
    if (!Any(fast)) return;
    W sine, cosine;
    simd::SinCosOfTurns(W::Splat(0.25 / simd::kPi) * theta, sine, cosine);
    c = Select(fast, cosine, c), s = Select(fast, sine, s);
  }
  /// Rotates like AxisTurn::Turn, with the same bits where c is 1.
  void Turn(W& a, W& b) const noexcept {
    const W cc = c * c, ss = s * s, scale = W::Splat(1.0) / (cc + ss);
    const W c2 = (cc - ss) * scale, s2 = (c * s + c * s) * scale;
    const W a1 = c2 * a + s2 * b;
    b = c2 * b - s2 * a;
    a = a1;
  }
};

/// Rotates a free body by half a drift. The second half is the mirror image of the first. `R`:
/// rotation matrix of `q`. Returns the result of NormalizeQuat.
enum class Half { kFirst, kSecond };
template <Half kHalf, class W>
TAUT_INLINE W DriftTurn(Q4<W>& q, const M3<W>& R, const V3<W>& L, const V3<W>& inv_inertia,
                        W half_h) noexcept {
  const W zero = W::Splat(0.0);
  const W y = inv_inertia.y - inv_inertia.x, z = inv_inertia.z - inv_inertia.x;
  V3<W> l = TransposeTimes(R, L);
  // Without the rotation about y, the result has the same bits as with a rotation by zero.
  const bool has_y = Any(!(y == zero));
  if (has_y && kHalf == Half::kFirst) {
    const AxisTurn<W> turn(half_h * l.y * y);
    turn.Turn(l.z, l.x);
    TurnY(q, turn.t);
  }
  const AxisTurn<W> turn(half_h * l.z * z);
  if (has_y && kHalf == Half::kSecond) turn.Turn(l.x, l.y);
  TurnZ(q, turn.t);
  if (has_y && kHalf == Half::kSecond) TurnY(q, AxisTurn<W>(half_h * l.y * y).t);
  // A rotation about L does not change l, so it may come last in both halves.
  const W theta = half_h * inv_inertia.x;
  TurnAbout(q, HalfAngle(theta, theta * theta * Dot(L, L)) * L);
  return NormalizeQuat(q);
}

/// DriftTurn for a body on a hinge: exact at any speed, and bit-identical to DriftTurn where it
/// uses the series.
template <Half kHalf, class W>
[[gnu::noinline]] W DriftTurnOnHinge(Q4<W>& q, const M3<W>& R, const V3<W>& L,
                                     const V3<W>& inv_inertia, W half_h) noexcept {
  const W zero = W::Splat(0.0), least = W::Splat(1e-300);
  const W y = inv_inertia.y - inv_inertia.x, z = inv_inertia.z - inv_inertia.x;
  V3<W> l = TransposeTimes(R, L);
  const bool has_y = Any(!(y == zero));
  const W theta = half_h * inv_inertia.x, L2 = Dot(L, L), theta2 = theta * theta * L2;
  const W about_y = half_h * l.y * y, about_z = half_h * l.z * z;
  const W most = Max(theta2, Max(about_y * about_y, about_z * about_z));
  const auto fast = most > W::Splat(kSeriesTurn * kSeriesTurn);
  if (has_y && kHalf == Half::kFirst) {
    const HalfTurn<W> turn(about_y, fast);
    turn.Turn(l.z, l.x);
    TurnY(q, turn.c, turn.s);
  }
  const HalfTurn<W> turn(half_h * l.z * z, fast);
  if (has_y && kHalf == Half::kSecond) turn.Turn(l.x, l.y);
  TurnZ(q, turn.c, turn.s);
  if (has_y && kHalf == Half::kSecond) {
    const HalfTurn<W> last(half_h * l.y * y, fast);
    TurnY(q, last.c, last.s);
  }
  const W size = Sqrt(L2);
  const HalfTurn<W> about(theta * size, fast);
  const W per_size = Select(fast, about.s / Max(size, least), HalfAngle(theta, theta2));
  TurnAbout(q, about.c, per_size * L);
  return NormalizeQuat(q);
}

/// Rotates body b by half a drift; see DriftTurn.
template <Half kHalf, class W>
TAUT_INLINE W DriftTurnOf(const View& m, const Rows<W>& s, int b, Q4<W>& q, const M3<W>& R,
                          W half_h) noexcept {
  if (m.joint_count > 0 && m.hinged[b] != 0) {
    Q4<W> on_hinge = q;  // a copy, so that q can stay in registers
    const W square = DriftTurnOnHinge<kHalf>(on_hinge, R, s.mom[b], s.inv_inertia[b], half_h);
    q = on_hinge;
    return square;
  }
  return DriftTurn<kHalf>(q, R, s.mom[b], s.inv_inertia[b], half_h);
}

/// Stage: first half of the drift.
///   reads   vel, mom     writes  pos, quat
template <class W>
void StageDriftFirst(const View& m, const Rows<W>& s, W half_h) noexcept {
  for (int b = 0; b < m.body_count; ++b) {
    s.pos[b] += half_h * s.vel[b];
    Q4<W> q = s.quat[b];
    DriftTurnOf<Half::kFirst>(m, s, b, q, RotationOf(q), half_h);
    s.quat[b] = q;
  }
}

/// Stage: second half of the drift, the mirror image of the first.
template <class W>
void StageDriftSecond(const View& m, const Rows<W>& s, const Scratch<W>& work, W half_h) noexcept {
  // Adding +0 turns -0 into +0, so that the sign of zero does not depend on other lanes.
  const W zero = W::Splat(0.0);
  for (int b = 0; b < m.body_count; ++b) {
    Q4<W> q = s.quat[b];
    const W square = DriftTurnOf<Half::kSecond>(m, s, b, q, work.bodies[b].R, half_h);
    // + 0, or NaN if q is not a rotation; UpdateStatus checks w.
    s.quat[b] = {q.w + zero * square, q.x + zero, q.y + zero, q.z + zero};
    s.pos[b] += half_h * s.vel[b];
    s.pos[b] += V3<W>{zero, zero, zero};
  }
}

/// Computes the positions of the cable attachments.
///   reads   pos, bodies[].R     writes  spots[]
template <class W>
void StageSpots(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept {
  for (int i = 0; i < m.spot_count; ++i) {
    const AttachmentTable& table = m.spots[i];
    Spot<W>& spot = work.spots[i];
    spot.arm = work.bodies[table.body].R * simd::Splat3<W>(table.p_P);
    spot.p = table.body < m.body_count ? s.pos[table.body] + spot.arm : spot.arm;
  }
}

/// Computes frames, inverse inertias and velocities of all bodies, and initializes forces with
/// weights. `ahead`: time for which velocities are predicted, in units of the previous step; 0: no
/// prediction.
///   reads   quat, vel, mom, old_vel, old_spin, mass, gravity, node_force     writes  bodies[]
template <class W>
void StageKinematics(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                     W ahead) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  const V3<W> none{zero, zero, zero};
  for (int b = 0; b < m.body_count; ++b) {
    BodyWork<W>& body = work.bodies[b];
    body.R = RotationOf(s.quat[b]);
    body.inv_inertia = Congruence(body.R, s.inv_inertia[b]);
    body.v = body.v0 = s.vel[b];
    body.w = body.w0 = body.inv_inertia * s.mom[b];
    body.v_mid = body.v + ahead * (body.v - s.old_vel[b]);
    body.w_mid = body.w + ahead * (body.w - s.old_spin[b]);
    body.force = s.mass[b] * s.gravity[0];
    body.torque = none;
  }
  BodyWork<W>& world = work.bodies[m.body_count];
  world.R = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
  world.inv_inertia = {zero, zero, zero, zero, zero, zero};
  world.v = world.w = world.v0 = world.w0 = world.v_mid = world.w_mid = none;
  world.force = world.torque = none;
  for (int i = 0; i < g.forced_count; ++i) {
    const AttachmentTable& node = m.nodes[g.forced_nodes[i]];
    BodyWork<W>& body = work.bodies[node.body];
    const V3<W> f = s.node_force[g.forced_nodes[i]];
    body.force += f;
    body.torque += Cross(body.R * simd::Splat3<W>(node.p_P), f);
  }
}

/// Computes frames and velocities of all bodies in the current state, for lengths and rates of
/// cables. The bits are the same as from StageKinematics.
///   reads   quat, vel, mom     writes  bodies[].R, .v_mid, .w_mid
template <class W>
void StageSenseBodies(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  const V3<W> none{zero, zero, zero};
  for (int b = 0; b < m.body_count; ++b) {
    BodyWork<W>& body = work.bodies[b];
    body.R = RotationOf(s.quat[b]);
    body.v_mid = s.vel[b] + none;
    body.w_mid = Congruence(body.R, s.inv_inertia[b]) * s.mom[b] + none;
  }
  BodyWork<W>& world = work.bodies[m.body_count];
  world.R = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
  world.v_mid = world.w_mid = none;
}

/// Stage: changes velocities by the accumulated forces (kick).
///   reads   bodies[].force, .torque     writes  bodies[].v, .w, mom
template <class W>
void StageKick(const View& m, const Rows<W>& s, Scratch<W>& work, W h) noexcept {
  for (int b = 0; b < m.body_count; ++b) {
    BodyWork<W>& body = work.bodies[b];
    body.v = body.v0 + (h * s.inv_mass[b]) * body.force;
    s.mom[b] += h * body.torque;
    body.mom_free = s.mom[b];
    body.landed = W::Splat(0.0);
    body.w = body.inv_inertia * s.mom[b];
  }
}

}  // namespace taut::sim
