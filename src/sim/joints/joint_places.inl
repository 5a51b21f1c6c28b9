/// Projection onto joint constraints (docs/theory/joints.md, eq. 7, 7a). At the end of a step, it
/// projects velocities and closes gaps (position projection).
#pragma once

#include "sim/bodies/stage_bodies.inl"
#include "sim/data/rows.h"
#include "sim/joints/joint_system.inl"
#include "sim/solve/common_turn.inl"

namespace taut::sim {

/// Returns the error of a constrained row: its measure; for a distance, the difference from its
/// length.
template <class W>
TAUT_INLINE W MissOf(JointMeasure measure, const JointTable& j, W value) noexcept {
  return measure == JointMeasure::kDistance ? value - W::Splat(j.rest) : value;
}

/// Projects velocities onto the joint constraints, completely or by a fraction (eq. 7a). The
/// projection applies impulses, so momenta are conserved and energy never increases. `given(body)`:
/// velocities of a kinematic body; `skip(joint)`: lanes in which a joint keeps its velocities.
/// Calls took(number of the row in the model, impulse, row) for each row.
template <class W, class F, class S, class G>
void ProjectVelocities(const View& m, const Rows<W>& s, Scratch<W>& work, JointSystem<W>& system,
                       W share, const F& given, const S& skip, const G& took) noexcept {
  const W zero = W::Splat(0.0);
  const V3<W> none{zero, zero, zero};
  const auto twist = [&](int number) {
    const int b = m.joint_bodies[number];
    if (number >= m.joint_body_count) return given(b);
    return Twist<W>{s.vel[b], work.bodies[b].inv_inertia * s.mom[b]};
  };
  system.Solve([&](int r) {
    const JointRow<W>& row = system.row(r);
    W u = zero;
    for (int k = 0; k < row.link_count; ++k) {
      const Twist<W> t = twist(row.links[k].body);
      AddVelocity(row.links[k], t.v, t.w, &u);
    }
    return u;
  });
  for (int r = 0; r < system.rows(); ++r) {
    const JointRow<W>& row = system.row(r);
    const JointTable& j = m.joints[work.joints[system.number(r)].joint];
    const W l = Select(skip(j), zero, share * system.impulse(r));
    for (int k = 0; k < row.link_count; ++k) {
      const Link<W, 1>& link = row.links[k];
      if (link.body >= m.joint_body_count) continue;
      const int b = m.joint_bodies[link.body];
      s.vel[b] += (link.inv_mass * l) * link.lin[0] + none;
      s.mom[b] += l * link.ang[0] + none;
    }
    const bool is_pair = row.link_count == 2 && row.links[0].body < m.joint_body_count &&
                         row.links[1].body < m.joint_body_count;
    if (m.free_chain_count > 0 && is_pair) {
      const int first = row.links[0].body, second = row.links[1].body;
      work.joint_memory.gained[first] +=
          l * GainOf(row, s.pos[m.joint_bodies[first]], s.pos[m.joint_bodies[second]]);
    }
    took(system.number(r), l, row);
  }
}

/// Computes the displacements that close all joints to first order. Result: joint_memory.change.
template <class W>
void FindClosing(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept {
  JointSystem<W> system(m, s, work);
  system.Assemble();
  system.Solve([&](int r) { return system.gap(r); });
}

/// Conserves the angular momentum of an unsupported chain: a common rotation compensates for the
/// change (`gained`).
template <class W>
void KeepMomentumOf(const View& m, const Rows<W>& s, Scratch<W>& work, const int* bodies,
                    int count) noexcept {
  const W zero = W::Splat(0.0);
  const V3<W> none{zero, zero, zero};
  const auto solid = [&](int k) {
    const int b = bodies[k];
    return Solid<W>{s.pos[b], s.mass[b], Congruence(work.bodies[b].R, s.inertia[b])};
  };
  V3<W> gained = none;
  for (int k = 0; k < count; ++k) gained += work.joint_memory.gained[m.joint_number[bodies[k]]];
  const CommonTurn<W> turn(count, solid, -gained);
  for (int k = 0; k < count; ++k) {
    const int b = bodies[k];
    s.vel[b] += turn.VelocityAt(s.pos[b]) + none;
    s.mom[b] += solid(k).inertia * turn.w + none;
  }
}

/// Returns the largest gap of constrained rows and closed joint limits [m], per lane.
/// `skip(joint)`: lanes in which a joint is ignored.
template <class W, class F>
W WorstGap(const View& m, const Rows<W>& s, const Scratch<W>& work, const F& skip) noexcept {
  W worst = W::Splat(0.0);
  for (int i = 0; i < m.joint_count; ++i) {
    const JointTable& j = m.joints[i];
    const auto skipped = skip(j);
    const JointPlace<W> p = PlaceOf(m, s, work, j);
    for (int r = j.first_row; r < j.first_row + j.row_count; ++r) {
      const JointMeasure measure = m.joint_rows[r].measure;
      if (m.joint_rows[r].role != JointRole::kHold) break;
      const W value = DirectionOf(j, measure, p, W::Splat(0.0)).value;
      worst = Max(Select(skipped, W::Splat(0.0), Abs(MissOf(measure, j, value))), worst);
    }
    for (int r = j.first_row; r < j.first_row + j.row_count; ++r) {
      if (!IsStop(m.joint_rows[r].role)) continue;
      const W gap = DirectionOf(j, m.joint_rows[r], p, AngleAt(j, p, s.joint_angle[i])).value;
      const auto closed = IsClosedAtEnd(work.joints[r], gap);
      worst = Max(Select(closed, Abs(gap), W::Splat(0.0)), worst);
    }
  }
  return worst;
}

/// Returns whether an open joint limit has a contact force; bodies may have passed it.
template <class W>
bool StopsCatch(const View& m, const Scratch<W>& work) noexcept {
  const W zero = W::Splat(0.0);
  auto caught = MaskOf<W>::Splat(false);
  for (int r = 0; r < m.joint_row_count; ++r) {
    const HeldRow<W>& row = work.joints[r];
    if (IsStop(m.joint_rows[r].role)) caught = caught | (Presses(row) & (row.held == zero));
  }
  return Any(caught);
}

template <class W>
void TurnJointedBodies(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept {
  for (int k = 0; k < m.joint_body_count; ++k) {
    const int b = m.joint_bodies[k];
    work.bodies[b].R = RotationOf(s.quat[b]);
    work.bodies[b].inv_inertia = Congruence(work.bodies[b].R, s.inv_inertia[b]);
  }
}

/// Displaces the bodies of `lanes` by the smallest amount that closes all gaps to first order.
/// `closed(body)`: lanes in which a body keeps its position.
template <class W, class F>
void CloseGaps(const View& m, const Rows<W>& s, Scratch<W>& work, JointSystem<W>& system,
               MaskOf<W> in_lanes, const F& closed) noexcept {
  const W zero = W::Splat(0.0);  // adding +0: see StageDriftSecond
  const V3<W> none{zero, zero, zero};
  system.Solve([&](int r) { return system.gap(r); });
  for (int k = 0; k < m.joint_body_count; ++k) {
    const int b = m.joint_bodies[k];
    const auto lanes = in_lanes & !closed(b);
    Twist<W> change = system.change(k);
    change.v = Select3(lanes, change.v, none), change.w = Select3(lanes, change.w, none);
    s.pos[b] += change.v + none;
    Q4<W> q = s.quat[b];
    TurnAbout(q, W::Splat(0.5) * change.w);
    NormalizeQuat(q);
    s.quat[b] = {Select(lanes, q.w, s.quat[b].w) + zero, Select(lanes, q.x, s.quat[b].x) + zero,
                 Select(lanes, q.y, s.quat[b].y) + zero, Select(lanes, q.z, s.quat[b].z) + zero};
    const V3<W> turned = Turned(change.w, s.mom[b]);
    work.joint_memory.gained[k] += (turned - s.mom[b]) + Cross(change.v, s.mass[b] * s.vel[b]);
    s.mom[b] = Select3(lanes, turned, s.mom[b]) + none;
    work.joint_memory.moved[k] = Norm1(change.v) + W::Splat(m.bound_m[b]) * Norm1(change.w);
  }
  TurnJointedBodies(m, s, work);
  for (int chain = 0; chain < m.free_chain_count; ++chain) {
    KeepMomentumOf(m, s, work, m.free_chain_bodies + m.free_chains[chain],
                   m.free_chains[chain + 1] - m.free_chains[chain]);
  }
  const auto moved = [&](int b) {
    const int k = m.joint_number[b];
    return k < 0 || k >= m.joint_body_count ? zero : work.joint_memory.moved[k];
  };
  for (int pair = 0; pair < m.world_pair_count; ++pair) {
    s.clearance[pair] -= moved(m.world_pairs[pair].a) + moved(m.world_pairs[pair].b);
  }
  for (int pair = 0; pair < work.moving_count; ++pair) {
    const MovingPair& bodies = work.moving_pairs[pair];
    s.clearance[m.world_pair_count + pair] -= moved(bodies.a) + moved(bodies.b);
  }
}

/// Adds the force and work of a kinematic body's motion under an impulse at the end of the step.
template <class W>
void AddToMotion(const View& m, const Rows<W>& s, const Scratch<W>& work, const Link<W, 1>& link,
                 W impulse, W inv_h) noexcept {
  const int b = m.joint_bodies[link.body];
  const int i = m.motion_of_body[b];
  s.motion_force[i] -= (inv_h * impulse) * link.lin[0];
  s.motion_torque[i] -= (inv_h * impulse) * link.ang[0];
  const BodyWork<W>& body = work.bodies[b];
  const W work_done = impulse * (Dot(link.lin[0], body.v) + Dot(link.ang[0], body.w));
  s.motion_work[i] -= Select(s.halted[0] > W::Splat(0.0), W::Splat(0.0), work_done);
}

/// Stage: projects the initial velocities from a file or program, at the start of a world's first
/// step.
///   reads   pos, quat     writes  vel, mom, bodies[].R
template <class W>
void StageJointStart(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  for (int b = 0; b < m.body_count; ++b) {
    work.bodies[b].R = RotationOf(s.quat[b]);
    work.bodies[b].inv_inertia = Congruence(work.bodies[b].R, s.inv_inertia[b]);
  }
  work.bodies[m.body_count].R = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
  ForgetGains(m, work);
  JointSystem<W> system(m, s, work);
  system.Assemble();
  const auto given = [&](int b) {
    const Motion<W> now = MotionAt(m, m.motions[m.motion_of_body[b]], s.time[0]);
    return Twist<W>{now.v, now.w};
  };
  ProjectVelocities(m, s, work, system, Select(s.last_step[0] == zero, one, zero), given,
                    InNoLane<W>(), [](int, const W&, const JointRow<W>&) {});
}

/// Updates hinge angles to the current pose, at time `t` after the last update.
template <class W>
void FollowHinges(const View& m, const Rows<W>& s, const Scratch<W>& work, W t) noexcept {
  for (int i = 0; i < m.joint_count; ++i) {
    const JointTable& j = m.joints[i];
    if (!j.has_angle) continue;
    const BodyWork<W>&a = work.bodies[j.a], &b = work.bodies[j.b];
    const JointPlace<W> p = PlaceOf(m, s, work, j);
    const W turned = t * Dot(p.axes_a.r0, b.w - a.w);
    s.joint_angle[i] = HingeAngle(p, s.joint_angle[i] + turned);
  }
}

/// Stage: projects half of the velocity error and closes the gaps left by the drifts. Angular
/// momenta rotate with their bodies; otherwise a thin rod would spin about its axis.
///   reads   pos, quat, joints[]     writes  pos, quat, vel, mom, bodies[].R, clearance,
///   joint_angle, joint_force, joint_torque, motion_force, motion_torque, motion_work
template <class W>
void StageJointPlaces(const View& m, const Rows<W>& s, Scratch<W>& work, double step_s) noexcept {
  // A full projection would lose three times as much energy. Without projection, the error would
  // change its sign at every step.
  constexpr double kShare = 0.5;
  constexpr double kClosed_m = 1e-10;
  // Between bodies with stiff cables, a small gap is due to the compliance of the joint, and
  // closing it would stretch the cables. Wider gaps were set by a program.
  constexpr double kCompliant_m = 1e-5;
  constexpr int kRounds = 3;
  const W inv_h = W::Splat(1.0 / step_s);
  TurnJointedBodies(m, s, work);
  FollowHinges(m, s, work, W::Splat(0.5 * step_s));
  auto compliant = MaskOf<W>::Splat(false);
  if (work.implicit.any) {
    compliant = WorstGap(m, s, work, InNoLane<W>()) < W::Splat(kCompliant_m);
  }
  const auto closed = [&](const auto& of) { return compliant & EndedImplicitly(m, work, of); };
  JointSystem<W> system(m, s, work);
  auto lanes = MaskOf<W>::Splat(true);
  for (int round = 0; round < kRounds && Any(lanes); ++round) {
    if (round == 0) system.IncludeHeldStops();
    system.Assemble();
    if (round == 0) {
      const auto given = [&](int b) { return Twist<W>{work.bodies[b].v, work.bodies[b].w}; };
      const auto took = [&](int r, W impulse, const JointRow<W>& row) {
        const HeldRow<W>& middle = work.joints[r];
        const W load = inv_h * impulse;
        s.joint_force[middle.joint] += load * middle.lin;
        s.joint_torque[middle.joint] += load * middle.turn;
        for (int k = 0; k < row.link_count; ++k) {
          if (row.links[k].body < m.joint_body_count) continue;
          AddToMotion(m, s, work, row.links[k], impulse, inv_h);
        }
      };
      const auto conserves = [&](const JointTable& j) {
        return EndedImplicitly(m, work, j) & !EndedDamped(m, work, j);
      };
      ProjectVelocities(m, s, work, system, W::Splat(kShare), given, conserves, took);
      system.IncludeStops();
      if (StopsCatch(m, work)) system.Assemble();
    }
    CloseGaps(m, s, work, system, lanes, closed);
    ForgetGains(m, work);
    lanes = lanes & (WorstGap(m, s, work, closed) > W::Splat(kClosed_m));
  }
  FollowHinges(m, s, work, W::Splat(0.0));
}

}  // namespace taut::sim
