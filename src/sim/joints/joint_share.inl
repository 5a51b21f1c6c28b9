/// Stability limit of joint forces: ratio of joint load to the largest stable load
/// (docs/theory/joints.md, eq. 8).
///
/// A joint force is implicit along its direction. Across it, the force is explicit and acts as a
/// spring with a stiffness proportional to the load; the step must resolve its oscillation. For
/// most worlds a cheap bound per body suffices. If this bound is exceeded, power iteration finds
/// the highest natural frequency that the joints allow. Joints integrated together with stiff
/// cables are implicit in all directions and have no such limit.
#pragma once

#include "sim/data/rows.h"
#include "sim/joints/joint_places.inl"
#include "sim/joints/joints.inl"

namespace taut::sim {

/// Largest ratio over all bodies, and the body with it, per lane.
template <class W>
struct JointShare {
  W share;
  int body[W::kLanes];

  void Raise(MaskOf<W> lanes, W to, int by) noexcept {
    const auto more = lanes & (to > share);
    for (int lane = 0; lane < W::kLanes; ++lane) {
      if (more[lane]) body[lane] = by;
    }
    share = Select(more, to, share);
  }
};

/// Returns tension / length of a distance joint [N/m], its transverse stiffness.
template <class W>
TAUT_INLINE W StiffnessAcross(const V3<W>& force, const V3<W>& gap) noexcept {
  return (W::Splat(0.0) - Dot(force, gap)) / Max(Dot(gap, gap), W::Splat(1e-300));
}

/// Computes an upper bound of every body's ratio from its inertia. Rotation about the principal
/// axes has the matrix I^-1 N with N = (F . r) 1 - F r^T per joint. The eigenvalues of this matrix
/// are at most the largest row sum of absolute values. A distance joint has the transverse
/// stiffness T = tension / length. A body's part of T |d_b - d_a|^2 / 2 is at most T |d|^2, d = v +
/// w x r: 4 T / m and 4 T |r|^2 / I.
template <class W>
JointShare<W> BoundOfShares(const View& m, const Rows<W>& s, Scratch<W>& work,
                            W quarter_h2) noexcept {
  const W zero = W::Splat(0.0), four = W::Splat(4.0), least = W::Splat(1e-300);
  const V3<W> none{zero, zero, zero};
  V3<W>* const turns = work.joint_memory.gained;
  W* const slides = work.joint_memory.moved;
  for (int k = 0; k < m.joint_body_count; ++k) turns[k] = none, slides[k] = zero;
  for (int i = 0; i < m.joint_count; ++i) {
    const JointTable& j = m.joints[i];
    W across = zero;
    if (j.coordinate == JointMeasure::kDistance) {
      const JointPlace<W> p = PlaceOf(m, s, work, j);
      across = four * Abs(StiffnessAcross(s.joint_force[i], p.gap));
    }
    const auto add = [&](int body, const double* own_P) {
      const V3<W> r = simd::Splat3<W>(own_P);
      const V3<W> f = TransposeTimes(work.bodies[body].R, s.joint_force[i]);
      const V3<W> fr{f.x * r.x, f.y * r.y, f.z * r.z}, rr{r.x * r.x, r.y * r.y, r.z * r.z};
      const V3<W> size{Abs(r.x), Abs(r.y), Abs(r.z)};
      const int k = m.joint_number[body];
      turns[k].x += Abs(fr.y + fr.z) + Abs(f.x) * (size.y + size.z) + across * (rr.y + rr.z);
      turns[k].y += Abs(fr.z + fr.x) + Abs(f.y) * (size.z + size.x) + across * (rr.z + rr.x);
      turns[k].z += Abs(fr.x + fr.y) + Abs(f.z) * (size.x + size.y) + across * (rr.x + rr.y);
      slides[k] += across;
    };
    if (j.a_moves) add(j.a, j.own_a_P);
    if (j.b_moves) add(j.b, j.own_b_P);
  }
  JointShare<W> bound{zero, {}};
  for (int k = 0; k < m.joint_body_count; ++k) {
    const int b = m.joint_bodies[k];
    const V3<W>& moments = s.inertia[b];
    const W x = turns[k].x / Max(moments.x, least), y = turns[k].y / Max(moments.y, least),
            z = turns[k].z / Max(moments.z, least);
    const W most = Max(Max(x, y), Max(z, s.inv_mass[b] * slides[k]));
    bound.Raise(!EndedImplicitly(m, work, b), quarter_h2 * most, b);
  }
  return bound;
}

/// Adds the restoring joint forces for displacements `x` to `forces` (6 numbers per body). For a
/// rotation t and a force F at the lever arm r, the restoring torque is t (F . r) - F (r . t): the
/// change of the torque in the body frame.
template <class W>
void PushBack(const View& m, const Rows<W>& s, const Scratch<W>& work, const Row<W>& x,
              const Row<W>& forces) noexcept {
  using Bodies = Island<W, Pools<JointRow<W>>>;
  const W zero = W::Splat(0.0);
  const V3<W> none{zero, zero, zero};
  for (int i = 0; i < m.joint_count; ++i) {
    const JointTable& j = m.joints[i];
    const JointPlace<W> p = PlaceOf(m, s, work, j);
    const V3<W> force = Select3(EndedImplicitly(m, work, j), none, s.joint_force[i]);
    const int a = m.joint_number[j.a], b = m.joint_number[j.b];
    const Twist<W> ta = j.a_moves ? Bodies::Load(x + kDofs * a) : Twist<W>{none, none};
    const Twist<W> tb = j.b_moves ? Bodies::Load(x + kDofs * b) : Twist<W>{none, none};
    V3<W> across = none;
    if (j.coordinate == JointMeasure::kDistance) {
      const V3<W> apart = tb.v + Cross(tb.w, p.own_b) - (ta.v + Cross(ta.w, p.own_a));
      const W along = Dot(apart, p.gap) / Max(Dot(p.gap, p.gap), W::Splat(1e-300));
      across = StiffnessAcross(force, p.gap) * (apart - along * p.gap);
    }
    const auto add = [&](int k, const Twist<W>& t, const V3<W>& arm, const V3<W>& f,
                         const V3<W>& side) {
      W* const to = forces + kDofs * k;
      const V3<W> turn = Dot(f, arm) * t.w - Dot(arm, t.w) * f + Cross(arm, side);
      to[0] += side.x, to[1] += side.y, to[2] += side.z;
      to[3] += turn.x, to[4] += turn.y, to[5] += turn.z;
    };
    if (j.a_moves) add(a, ta, p.own_a, -force, -across);
    if (j.b_moves) add(b, tb, p.own_b, force, across);
  }
}

/// Returns twice the kinetic energy of body k at the velocities `x`.
template <class W>
W Vigour(const Unknown<W>& body, const W* x) noexcept {
  W moment[kDofs];
  Island<W, Pools<JointRow<W>>>::TimesMass(body, x, moment);
  W sum = W::Splat(0.0);
  for (int i = 0; i < kDofs; ++i) sum += x[i] * moment[i];
  return sum;
}

/// Returns h^2 w^2 / 4 for the highest natural frequency w that the constrained rows allow, and the
/// body with the largest amplitude. Method: power iteration x <- A^-1 N x with the system A of eq.
/// 7.
template <class W>
JointShare<W> ShareOfFastest(const View& m, const Rows<W>& s, Scratch<W>& work,
                             W quarter_h2) noexcept {
  constexpr int kRounds = 16;
  const W zero = W::Splat(0.0), one = W::Splat(1.0), least = W::Splat(1e-300);
  JointMemory<W>& mem = work.joint_memory;
  JointSystem<W> system(m, s, work);
  system.IncludeStops();
  system.Assemble();
  const int size = kDofs * m.joint_body_count;
  // Start vector with all bodies. Rotations are scaled by the radius of gyration.
  for (int k = 0; k < m.joint_body_count; ++k) {
    const int b = m.joint_bodies[k];
    const V3<W>& moments = s.inertia[b];
    const W turn = Sqrt(s.mass[b] / Max(Max(moments.x, Max(moments.y, moments.z)), least));
    for (int i = 0; i < kDofs; ++i) {
      const W part = W::Splat((37 * k + 101 * i) % 19 - 9.25);
      mem.change[kDofs * k + i] = i < 3 ? part : turn * part;
    }
  }
  JointShare<W> fastest{zero, {}};
  W length = zero;
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < size + kDofs * m.motion_count; ++i) mem.rhs[i] = zero;
    PushBack(m, s, work, mem.change, mem.rhs);
    system.GiveWay(mem.rhs);
    W sum = zero;
    for (int k = 0; k < m.joint_body_count; ++k) {
      sum += Vigour(mem.bodies[k], mem.rhs + kDofs * k);
    }
    length = Sqrt(sum);
    const W scale = one / Max(length, least);
    for (int i = 0; i < size; ++i) mem.change[i] = scale * mem.rhs[i];
  }
  for (int k = 0; k < m.joint_body_count; ++k) {
    fastest.Raise(MaskOf<W>::Splat(true), Vigour(mem.bodies[k], mem.change + kDofs * k),
                  m.joint_bodies[k]);
  }
  fastest.share = quarter_h2 * length;
  return fastest;
}

/// Increases `worst` to at least (w h)^2 for rotation about a hinge whose distance from the center
/// of mass exceeds 1e-3 of the radius of gyration. The motion along the arc is accurate to second
/// order only.
template <class W>
void RaiseByRotors(const View& m, const Rows<W>& s, const Scratch<W>& work, W h2,
                   JointShare<W>& worst) noexcept {
  constexpr double kBeside2 = 1e-6;
  for (int i = 0; i < m.joint_count; ++i) {
    const JointTable& j = m.joints[i];
    if (!j.has_angle) continue;
    const JointPlace<W> p = PlaceOf(m, s, work, j);
    const V3<W>& axis = p.axes_a.r0;
    const auto raise = [&](int b, const V3<W>& own) {
      const V3<W> beside = Cross(axis, own);
      const S3<W> inertia = Congruence(work.bodies[b].R, s.inertia[b]);
      const W spin = Dot(axis, work.bodies[b].inv_inertia * s.mom[b]);
      const auto off =
          s.mass[b] * Dot(beside, beside) > W::Splat(kBeside2) * Dot(axis, inertia * axis);
      worst.Raise(off, h2 * spin * spin, b);
    };
    if (j.a_moves) raise(j.a, p.own_a);
    if (j.b_moves) raise(j.b, p.own_b);
  }
}

/// Returns the ratio per lane; above 1, the step is too long.
template <class W>
JointShare<W> ShareOfStableJoints(const View& m, const Rows<W>& s, Scratch<W>& work,
                                  double step_s) noexcept {
  const W quarter_h2 = W::Splat(0.25 * step_s * step_s), one = W::Splat(1.0);
  JointShare<W> worst = BoundOfShares(m, s, work, quarter_h2);
  const auto beyond = worst.share > one;
  if (Any(beyond)) {
    const JointShare<W> exact = ShareOfFastest(m, s, work, quarter_h2);
    for (int lane = 0; lane < W::kLanes; ++lane) {
      if (beyond[lane]) worst.body[lane] = exact.body[lane];
    }
    worst.share = Select(beyond, exact.share, worst.share);
  }
  RaiseByRotors(m, s, work, W::Splat(step_s * step_s), worst);
  return worst;
}

}  // namespace taut::sim
