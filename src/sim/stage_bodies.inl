/// Stages of the rigid bodies: drift, kinematics, kick (docs/theory/integrator.md).
///
///   state   pos x, quat q_WP, vel v, mom L: angular momentum about the centre of mass, in W
///
/// Free rotation keeps L and turns q. It is split into rotations about the body's principal axes
/// (Dullweber, Leimkuhler, McLachlan, J. Chem. Phys. 107, 1997, eq. 2.4), x y z in the first half
/// of a step and z y x in the second, which is symmetric: L is kept to round-off and the energy's
/// error stays bounded however fast a thin rod spins about its own axis.

namespace taut::sim {

/// Where a body's angular momentum turns as the body turns by theta about one axis.
/// tan(theta / 2) is taken as theta/2 (1 + theta^2/12): a rotation for any theta, and its angle
/// is right to O(theta^5).
template <class W>
struct AxisTurn {
  W t, c, s;
  explicit AxisTurn(W theta) noexcept {
    const W one = W::Splat(1.0);
    t = W::Splat(0.5) * theta * (one + W::Splat(1.0 / 12.0) * theta * theta);
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

template <class W>
TAUT_INLINE void NormalizeQuat(Q4<W>& q) noexcept {
  const W scale = W::Splat(1.0) / Sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  q = {q.w * scale, q.x * scale, q.y * scale, q.z * scale};
}

/// q <- q (1, t e_axis), not normalised.
template <class W>
TAUT_INLINE void TurnX(Q4<W>& q, W t) noexcept {
  q = {q.w - t * q.x, q.x + t * q.w, q.y + t * q.z, q.z - t * q.y};
}
template <class W>
TAUT_INLINE void TurnY(Q4<W>& q, W t) noexcept {
  q = {q.w - t * q.y, q.x - t * q.z, q.y + t * q.w, q.z + t * q.x};
}
template <class W>
TAUT_INLINE void TurnZ(Q4<W>& q, W t) noexcept {
  q = {q.w - t * q.z, q.x + t * q.y, q.y - t * q.x, q.z + t * q.w};
}

/// Stage: first half of the drift.
///   reads   vel, mom     writes  pos, quat
template <class W>
void StageDriftFirst(const View& m, const Rows<W>& s, W half_h) noexcept {
  for (int b = 0; b < m.body_count; ++b) {
    s.pos[b] += half_h * s.vel[b];
    V3<W> l = TransposeTimes(RotationOf(s.quat[b]), s.mom[b]);
    Q4<W> q = s.quat[b];
    const AxisTurn<W> x(half_h * l.x * s.inv_inertia[b].x);
    x.Turn(l.y, l.z);
    TurnX(q, x.t);
    const AxisTurn<W> y(half_h * l.y * s.inv_inertia[b].y);
    y.Turn(l.z, l.x);
    TurnY(q, y.t);
    const AxisTurn<W> z(half_h * l.z * s.inv_inertia[b].z);
    TurnZ(q, z.t);
    NormalizeQuat(q);
    s.quat[b] = q;
  }
}

/// Stage: second half of the drift, the mirror image of the first.
template <class W>
void StageDriftSecond(const View& m, const Rows<W>& s, const Scratch<W>& work, W half_h) noexcept {
  const W zero = W::Splat(0.0);  // x + 0 turns -0 into 0: lanes must not differ in the sign of zero
  for (int b = 0; b < m.body_count; ++b) {
    V3<W> l = TransposeTimes(work.bodies[b].R, s.mom[b]);
    Q4<W> q = s.quat[b];
    const AxisTurn<W> z(half_h * l.z * s.inv_inertia[b].z);
    z.Turn(l.x, l.y);
    TurnZ(q, z.t);
    const AxisTurn<W> y(half_h * l.y * s.inv_inertia[b].y);
    y.Turn(l.z, l.x);
    TurnY(q, y.t);
    const AxisTurn<W> x(half_h * l.x * s.inv_inertia[b].x);
    TurnX(q, x.t);
    NormalizeQuat(q);
    s.quat[b] = {q.w + zero, q.x + zero, q.y + zero, q.z + zero};
    s.pos[b] += half_h * s.vel[b];
    s.pos[b] += V3<W>{zero, zero, zero};
  }
}

/// Frames, inverse inertias and velocities of all bodies; forces start at weight. `ahead` is how
/// far the expected velocities look ahead, in steps before this one (0: not at all).
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

/// Frames and velocities of all bodies as they are, with the same bits as StageKinematics: what a
/// cable's length and rate follow from.
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

/// Stage: forces become velocities.
///   reads   bodies[].force, .torque     writes  bodies[].v, .w, mom
template <class W>
void StageKick(const View& m, const Rows<W>& s, Scratch<W>& work, W h) noexcept {
  for (int b = 0; b < m.body_count; ++b) {
    BodyWork<W>& body = work.bodies[b];
    body.v = body.v0 + (h * s.inv_mass[b]) * body.force;
    s.mom[b] += h * body.torque;
    body.w = body.inv_inertia * s.mom[b];
  }
}

}  // namespace taut::sim
