/// Simulation step: the sequence of its stages (docs/theory/integrator.md). Each step_*.cpp
/// includes this file for one instruction set, with its register width.
///
/// Moreau's midpoint scheme: half a drift, forces and contacts at the middle, half a drift. This
/// code uses no standard library, so that no shared template is compiled with instructions that
/// some machines lack. For the same reason, every function is a template of W or TAUT_INLINE: if
/// several step_*.cpp emit a function, the linker keeps any one of them.
#pragma once

#include "sim/bodies/motion.inl"
#include "sim/bodies/stage_bodies.inl"
#include "sim/cables/dc_motor.inl"
#include "sim/cables/implicit_groups.inl"
#include "sim/cables/stage_cables.inl"
#include "sim/cables/stiff_cables.inl"
#include "sim/contacts/prepare_contact.inl"
#include "sim/contacts/stage_collide.inl"
#include "sim/data/poison.inl"
#include "sim/data/rows.h"
#include "sim/joints/joint_places.inl"
#include "sim/joints/joint_share.inl"
#include "sim/step/stage_sense.inl"
#include "sim/step/stage_solve.inl"

namespace taut::sim {

template <class W>
void SaveStart(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept {
  // Consecutive rows are copied as one block.
  const W* from = s.time.data();
  W* to = work.start;
  size_t count = 0;
  const auto save = [&](const void* row, int more) {
    if (row != from + count) {
      __builtin_memcpy(to, from, count * sizeof(W));
      to += count;
      from = static_cast<const W*>(row);
      count = 0;
    }
    count += static_cast<size_t>(more);
  };
#define TAUT_ROW(name, type, per, role, halted, start) \
  if (Halted::halted == Halted::kGoesBack) save(s.name.data(), m.Count(Per::per) * kWidth##type);
  TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW
  __builtin_memcpy(to, from, count * sizeof(W));
}

/// Restores the state at the start of this step in halted worlds, and removes values that are not
/// finite.
template <class W, class M>
void KeepStart(const View& m, const Rows<W>& s, const Scratch<W>& work, M halted_worlds) noexcept {
  const W* from = work.start;
  const auto keep = [&](Halted what, void* row, int count) {
    if (what == Halted::kStays) return;
    const W value = W::Splat(what == Halted::kForgets ? kNoKey : 0.0);
    W* const to = static_cast<W*>(row);
    for (int i = 0; i < count; ++i) {
      to[i] = Select(halted_worlds, what == Halted::kGoesBack ? from[i] : value, to[i]);
    }
    if (what == Halted::kGoesBack) from += count;
  };
#define TAUT_ROW(name, type, per, role, halted, start) \
  keep(Halted::halted, s.name.data(), m.Count(Per::per) * kWidth##type);
  TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW
}

/// Stores velocities in the state, and data for the predictions of the next step: the forces of
/// this step without impacts.
template <class W>
TAUT_INLINE void StoreBody(const Rows<W>& s, const BodyWork<W>& body, int b,
                           double step_s) noexcept {
  const W zero = W::Splat(0.0);  // adding +0: see StageDriftSecond
  const V3<W> none{zero, zero, zero};
  s.old_vel[b] = s.vel[b];
  s.old_spin[b] = body.w0 + none;
  s.vel[b] = body.v + none;
  s.mom[b] += none;
  s.held_torque[b] = W::Splat(1.0 / step_s) * (s.mom[b] - body.mom_free);
  const auto landed = body.landed > zero;
  if (!Any(landed)) return;
  const V3<W> v_free = body.v0 + (W::Splat(step_s) * s.inv_mass[b]) * body.force;
  const V3<W> w_free = body.inv_inertia * body.mom_free;
  s.old_vel[b] = Select3(landed, s.old_vel[b] + (body.v - v_free) + none, s.old_vel[b]);
  s.old_spin[b] = Select3(landed, s.old_spin[b] + (body.w - w_free) + none, s.old_spin[b]);
  s.held_torque[b] = Select3(landed, none, s.held_torque[b]);
}

/// Stores the state of bodies and the memory of contacts.
template <class W>
void StoreResults(const View& m, const Rows<W>& s, Group& g, const Scratch<W>& work,
                  double step_s) noexcept {
  const W zero = W::Splat(0.0);  // adding +0: see StageDriftSecond
  const V3<W> none{zero, zero, zero};
  const W inv_h = W::Splat(1.0 / step_s);
  for (int b = 0; b < m.body_count; ++b) {
    g.slots_used[b] = work.contact_count[b];
    for (int k = 0; k < work.contact_count[b]; ++k) {
      const int i = m.first_slot[b] + k;
      const Contact<W, 1>& c = work.contacts[i];
      const auto live = c.live > zero;
      s.contact_key[i] = c.key;
      s.contact_force[i] = Select3(live, inv_h * ImpulseOf(c) + none, none);
      s.contact_slip[i] = Select(live & (c.l[0] > zero), c.slip, W::Splat(kSlipUnknown));
      s.contact_arm[i] = c.arm[0];
      s.contact_normal[i] = c.links[0].lin[0];
      s.contact_gap[i] = c.gap;
    }
    StoreBody(s, work.bodies[b], b, step_s);
  }
}

/// Returns the lanes in which a body is below all terrain (kStatusFellOff).
template <class W>
[[gnu::noinline]] MaskOf<W> FellOff(const View& m, const Rows<W>& s) noexcept {
  const W zero = W::Splat(0.0);
  auto fallen = MaskOf<W>::Splat(false);
  for (int b = 0; b < m.body_count; ++b) {
    fallen = fallen | ((s.pos[b].z < W::Splat(m.floor_m)) & (s.inv_mass[b] > zero));
  }
  return fallen & (s.gravity[0].z < zero) & (s.halted[0] == zero);
}

/// Stores the body of a lane that left the terrain, and the nearest surface.
template <class W>
[[gnu::noinline]] void NameFallen(const View& m, const Rows<W>& s, int lane,
                                  LaneStatus& status) noexcept {
  int body = 0;
  while (!(s.pos[body].z[lane] < m.floor_m && s.inv_mass[body][lane] > 0)) ++body;
  const double x = s.pos[body].x[lane], y = s.pos[body].y[lane];
  double least = 0;
  for (int i = 0; i < m.ground_count; ++i) {
    const SurfaceTable& g = *m.shapes[m.first_ground + i].shape_P.surface.table;
    const double dx = x < g.low.x ? g.low.x - x : x > g.high.x ? x - g.high.x : 0.0;
    const double dy = y < g.low.y ? g.low.y - y : y > g.high.y ? y - g.high.y : 0.0;
    if (i > 0 && !(dx * dx + dy * dy < least)) continue;
    least = dx * dx + dy * dy;
    status.ground = i;
  }
  status.body = body;
}

/// Sets the status of all lanes, and halts lanes that are no longer finite.
template <class W>
void UpdateStatus(const View& m, const Rows<W>& s, Group& g, Scratch<W>& work,
                  const SolveResult<W>& solve, const StepSettings& settings, uint32_t overflow,
                  double step_s) noexcept {
  const W zero = W::Splat(0.0);
  W sum = zero;  // 0 while all values are finite
  for (int b = 0; b < m.body_count; ++b) {
    const V3<W>&p = s.pos[b], &v = s.vel[b], &l = s.mom[b];
    sum += zero * (p.x + p.y + p.z + v.x + v.y + v.z + l.x + l.y + l.z + s.quat[b].w);
  }
  for (int c = 0; c < m.cable_count; ++c) sum += zero * s.rest[c];
  for (int i = 0; i < m.span_count; ++i) sum += zero * s.span_rest[i];
  const auto was_halted = s.halted[0] > zero;
  const auto lost = (!(sum == zero)) & (!was_halted);
  const W tolerance = W::Splat(settings.tolerance_m_per_s);
  const auto solved = (solve.residual < tolerance) | (solve.residual == tolerance);
  const auto unsolved = !(solved | was_halted);
  W share = zero;
  for (int i = 0; i < work.stiff_count; ++i) {
    share = Max(ShareOfStableTension(s, work.stiff[i]), share);
  }
  JointShare<W> jointed{zero, {}};
  if (m.joint_count > 0) jointed = ShareOfStableJoints(m, s, work, step_s);
  const auto too_long = (Max(share, jointed.share) > W::Splat(1.0)) & (!was_halted);
  const uint32_t coarse = settings.coarse_cable >= 0 ? ~0u : work.walked_far;
  s.residual[0] = solve.residual;
  s.linear_solves[0] = solve.linear_solves;
  s.relaxation[0] = solve.relaxation;
  auto fallen = MaskOf<W>::Splat(false);
  if (m.ground_count > 0) fallen = FellOff(m, s);
  if (!Any(lost | unsolved | too_long | fallen) && (overflow | coarse) == 0) return;
  for (int lane = 0; lane < W::kLanes; ++lane) {
    if (was_halted[lane]) continue;
    LaneStatus& status = g.status[lane];
    uint32_t bits = 0;
    if (lost[lane]) bits |= kStatusNonFinite;
    if (unsolved[lane]) bits |= kStatusNotConverged;
    if (overflow & (1u << lane)) bits |= kStatusContactOverflow;
    const bool too_coarse = (coarse & (1u << lane)) != 0;
    if (too_long[lane] || too_coarse) bits |= kStatusStepTooLong;
    if (fallen[lane]) bits |= kStatusFellOff;
    if (bits != 0 && status.bits == 0) {
      status.first_time_s = s.time[0][lane];
      status.body = kWorld;
      status.cable = -1;
    }
    if (bits & ~status.bits & kStatusContactOverflow && work.no_room & (1u << lane)) {
      status.cable = work.crowded_cable[lane];
    }
    if (bits & ~status.bits & kStatusNotConverged) status.body = solve.body[lane];
    if (bits & ~status.bits & kStatusStepTooLong && too_coarse) {
      status.cable = settings.coarse_cable >= 0 ? settings.coarse_cable : work.walked_cable[lane];
    } else if (bits & ~status.bits & kStatusStepTooLong && jointed.share[lane] > share[lane]) {
      status.body = jointed.body[lane];
    } else if (bits & ~status.bits & kStatusStepTooLong) {
      for (int i = 0; i < work.stiff_count; ++i) {
        if (ShareOfStableTension(s, work.stiff[i])[lane] == share[lane]) {
          status.cable = work.stiff[i].cable;
        }
      }
    }
    if (bits & ~status.bits & kStatusFellOff) NameFallen(m, s, lane, status);
    if (bits & kStatusNonFinite) {
      for (int c = m.cable_count - 1; c >= 0; --c) {
        const double x = s.rest[c][lane] + s.target[c][lane];
        if (!(x - x == 0)) status.cable = c;
      }
      for (int b = m.body_count - 1; b >= 0; --b) {
        const double x = s.pos[b].x[lane] + s.pos[b].y[lane] + s.pos[b].z[lane] + s.vel[b].x[lane] +
                         s.vel[b].y[lane] + s.vel[b].z[lane] + s.mom[b].x[lane] + s.mom[b].y[lane] +
                         s.mom[b].z[lane];
        if (!(x - x == 0)) status.body = b;
      }
      s.halted[0].Set(lane, 1.0);
    }
    status.bits |= bits;
  }
}

/// Stages of a step, in their order.
enum class Stage {
  kStart,       ///< Saves the state at the start.
  kKinematics,  ///< Half a drift, rotations, inertias in W.
  kCables,      ///< Actuators and cable forces.
  kKick,        ///< Velocities from forces.
  kCollide,     ///< Collision detection.
  kSolve,       ///< Contacts, stiff cables and joints.
  kIntegrate,   ///< Stores the contacts; half a drift.
  kJudge,       ///< Checks the result and updates the status.
  kCount
};

/// Observer that is called at the end of each stage. This class does nothing at no cost; the
/// observer in benchmarks/ measures times.
struct NoWatch {
  TAUT_INLINE void Begin() noexcept {}
  TAUT_INLINE void Mark(Stage) noexcept {}
};

template <class W, class Watch>
void StepOnce(const View& m, const Rows<W>& s, Group& g, const StepSettings& settings,
              Scratch<W>& work, double step_s, Watch& watch) noexcept {
  watch.Begin();
  const W zero = W::Splat(0.0);
  const W h = W::Splat(step_s), half_h = W::Splat(0.5 * step_s);

  // Dampers use mean velocities over the step, predicted from the change in the previous step.
  const W last = s.last_step[0];
  const W ahead = Select(last > zero, half_h / Max(last, W::Splat(1e-300)), zero);

  if (Poison(m, s, g, work)) FindImplicit(m, s, work.implicit, step_s);
  SaveStart(m, s, work);
  watch.Mark(Stage::kStart);
  if (m.joint_count > 0 && Any(last == zero)) StageJointStart(m, s, work);
  StageDriftFirst(m, s, half_h);
  if (m.motion_count > 0) StageMotionPlaces(m, s, work, h);
  StageKinematics(m, s, g, work, ahead);
  if (m.motion_count > 0) StageMotionStart(m, work);
  StageSpots(m, s, work);
  watch.Mark(Stage::kKinematics);
  if (m.motor_count == 0) {
    StageCables<false>(m, s, work, step_s);
  } else {
    StageCables<true>(m, s, work, step_s);
  }
  watch.Mark(Stage::kCables);
  StageKick(m, s, work, h);
  if (m.motion_count > 0) StageMotionKick(m, work);
  watch.Mark(Stage::kKick);
  const uint32_t overflow = StageCollide(m, s, g, work, step_s, Max(h, last)) | work.no_room;
  watch.Mark(Stage::kCollide);
  const SolveResult<W> solve = StageSolve(m, s, g, work, settings, step_s);
  if (m.motor_count > 0) StageMotors(m, s, work, step_s);
  watch.Mark(Stage::kSolve);
  StoreResults(m, s, g, work, step_s);
  StageDriftSecond(m, s, work, half_h);
  if (work.implicit.any) PutImplicitEnds(m, s, work);
  if (m.motion_count > 0) StageMotionEnd(m, s, work, step_s);
  if (m.joint_count > 0) StageJointPlaces(m, s, work, step_s);
  watch.Mark(Stage::kIntegrate);
  UpdateStatus(m, s, g, work, solve, settings, overflow, step_s);

  const auto halted = s.halted[0] > zero;
  if (Any(halted)) KeepStart(m, s, work, halted);
  s.time[0] += Select(halted, zero, h);
  s.last_step[0] = Select(halted, last, h);
  g.sensed = false;
  watch.Mark(Stage::kJudge);
}

template <class W>
size_t ScratchBytes(const View& m) {
  return Scratch<W>::Bytes(m);
}

template <class W>
void LayOutScratch(const View& m, void* scratch) {
  Scratch<W>::LayOut(m, scratch);
}

template <class W, class Watch>
void StepGroup(const View& m, const Layout& layout, Group& g, const StepSettings& settings,
               void* scratch, double step_s, int count) {
  Scratch<W>& work = Scratch<W>::In(scratch);
  const Rows<W> s(m, layout, g);
  Watch watch;
  const double part_s = step_s / settings.substeps;
  FindImplicit(m, s, work.implicit, part_s);
  for (int i = 0; i < count; ++i) {
    const W end = s.time[0] + W::Splat(step_s);
    W solves = W::Splat(0.0);
    for (int k = 0; k < settings.substeps; ++k) {
      StepOnce(m, s, g, settings, work, part_s, watch);
      solves += s.linear_solves[0];
    }
    s.linear_solves[0] = solves;
    s.time[0] = Select(s.halted[0] > W::Splat(0.0), s.time[0], end);
  }
}

template <class W>
void SenseGroup(const View& m, const Layout& layout, Group& g, void* scratch) {
  Scratch<W>& work = Scratch<W>::In(scratch);
  const Rows<W> s(m, layout, g);
  Poison(m, s, g, work);
  StageSenseBodies(m, s, work);
  if (m.motion_count > 0) SenseMotions(m, s, work);
  StageSpots(m, s, work);
  StageSense(m, s, work);
}

template <class W, class Watch = NoWatch>
constexpr Kernel MakeKernel() {
  return {W::kLanes, ScratchBytes<W>, LayOutScratch<W>, StepGroup<W, Watch>, SenseGroup<W>};
}

}  // namespace taut::sim
