/// Kinematic bodies in a step: prescribed poses and velocities, and their work
/// (docs/theory/motion.md).
#pragma once

#include "sim/data/rows.h"

namespace taut::sim {

template <class W>
void PutPlace(const Rows<W>& s, int body, const Motion<W>& at) noexcept {
  const W zero = W::Splat(0.0);  // adding +0: see StageDriftSecond
  s.pos[body] = at.pos + V3<W>{zero, zero, zero};
  s.quat[body] = {at.quat.w + zero, at.quat.x + zero, at.quat.y + zero, at.quat.z + zero};
}

/// Stage: moves kinematic bodies to the middle of the step, after the first half of the drift.
///   reads   time     writes  pos, quat, motions[]
template <class W>
void StageMotionPlaces(const View& m, const Rows<W>& s, Scratch<W>& work, W h) noexcept {
  const W half_h = W::Splat(0.5) * h, t = s.time[0];
  for (int i = 0; i < m.motion_count; ++i) {
    MotionWork<W>& motion = work.motions[i];
    const Motion<W> start = MotionAt(m, m.motions[i], t);
    const Motion<W> middle = MotionAt(m, m.motions[i], t + half_h);
    motion.v0 = start.v, motion.w0 = start.w;
    motion.v_mid = middle.v, motion.w_mid = middle.w;
    motion.end = MotionAt(m, m.motions[i], t + h);
    PutPlace(s, m.motions[i].body, middle);
  }
}

/// Replaces the zero velocities of kinematic bodies from StageKinematics by the prescribed ones,
/// and zeroes the forces and torques on these bodies, before contacts, cables and joints add
/// theirs.
///   reads   motions[]     writes  bodies[].v0, .w0, .v_mid, .w_mid, .force, .torque
template <class W>
void StageMotionStart(const View& m, Scratch<W>& work) noexcept {
  const W zero = W::Splat(0.0);
  const V3<W> none{zero, zero, zero};
  for (int i = 0; i < m.motion_count; ++i) {
    const MotionWork<W>& motion = work.motions[i];
    BodyWork<W>& body = work.bodies[m.motions[i].body];
    body.v = body.v0 = motion.v0, body.w = body.w0 = motion.w0;
    body.v_mid = motion.v_mid, body.w_mid = motion.w_mid;
    body.force = body.torque = none;
  }
}

/// Sets the velocities at the end of the step, after the kick.
///   reads   motions[]     writes  bodies[].v, .w
template <class W>
void StageMotionKick(const View& m, Scratch<W>& work) noexcept {
  for (int i = 0; i < m.motion_count; ++i) {
    BodyWork<W>& body = work.bodies[m.motions[i].body];
    body.v = work.motions[i].end.v, body.w = work.motions[i].end.w;
  }
}

/// Adds velocity changes of kinematic bodies to the bounds of their displacement, since an
/// accelerating body moves farther than its initial velocity implies.
template <class W>
void BoundMotions(const View& m, const Rows<W>& s, Scratch<W>& work, W h, W since_last) noexcept {
  for (int i = 0; i < m.motion_count; ++i) {
    const int b = m.motions[i].body;
    BodyWork<W>& body = work.bodies[b];
    const W reach = W::Splat(m.bound_m[b]);
    body.turns += h * (Norm1(body.v - body.v0) + reach * Norm1(body.w - body.w0));
    body.turned +=
        since_last * (Norm1(body.v_mid - s.old_vel[b]) + reach * Norm1(body.w_mid - s.old_spin[b]));
  }
}

/// Stage: computes the work of kinematic bodies against all forces on them at the middle of the
/// step. Then sets their poses at the end of the step, after the second half of the drift.
///   reads   motions[], bodies[], stiff[], joints[]     writes  pos, quat, vel, mom, old_*,
///   motion_*
template <class W>
void StageMotionEnd(const View& m, const Rows<W>& s, Scratch<W>& work, double step_s) noexcept {
  const W zero = W::Splat(0.0), h = W::Splat(step_s), inv_h = W::Splat(1.0 / step_s);
  const V3<W> none{zero, zero, zero};
  const auto halted = s.halted[0] > zero;
  for (int i = 0; i < m.motion_count; ++i) {
    const int b = m.motions[i].body;
    BodyWork<W>& body = work.bodies[b];
    V3<W> force = body.force, torque = body.torque;
    const auto add = [&](const Link<W, 1>* links, int count, W load) {
      for (int k = 0; k < count; ++k) {
        if (links[k].body != b) continue;
        force += load * links[k].lin[0], torque += load * links[k].ang[0];
      }
    };
    for (int k = 0; k < work.stiff_count; ++k) {
      const StiffCable<W>& cable = work.stiff[k];
      add(cable.links, cable.link_count, Select(cable.live > zero, inv_h * cable.l[0], zero));
    }
    for (int r = 0; r < m.joint_row_count; ++r) {
      add(work.joints[r].links, work.joints[r].link_count, s.joint_load[r]);
    }
    s.motion_force[i] = none - force, s.motion_torque[i] = none - torque;
    const W work_done = zero - h * (Dot(force, body.v_mid) + Dot(torque, body.w_mid));
    s.motion_work[i] += Select(halted, zero, work_done);
    const Motion<W>& end = work.motions[i].end;
    PutPlace(s, b, end);
    body.R = RotationOf(end.quat);
    s.vel[b] = end.v + none;
    s.mom[b] = s.held_torque[b] = none;
    s.old_vel[b] = body.v0 + none, s.old_spin[b] = body.w0 + none;
  }
}

/// Sets the velocities of kinematic bodies for readings.
template <class W>
void SenseMotions(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept {
  for (int i = 0; i < m.motion_count; ++i) {
    BodyWork<W>& body = work.bodies[m.motions[i].body];
    const Motion<W> now = MotionAt(m, m.motions[i], s.time[0]);
    body.v_mid = now.v, body.w_mid = now.w;
  }
}

}  // namespace taut::sim
