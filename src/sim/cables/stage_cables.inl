/// Cable stage of a step: actuators, cable forces and cable wrapping (docs/theory/cables.md).
///
///   k, b    stiffness [N/m], damping [N s/m]
///   l, dl   length along all attachments [m], its rate [m/s]
///   L       rest length [m]
///   T       tension [N]
#pragma once

#include "math/cable_law.h"
#include "sim/cables/cable_follow.inl"
#include "sim/cables/cable_pulls.inl"
#include "sim/cables/cable_wheels.inl"
#include "sim/cables/cable_wrapping.inl"
#include "sim/cables/dc_motor.inl"
#include "sim/cables/stiff_cables.inl"
#include "sim/data/rows.h"

namespace taut::sim {

template <class W>
struct CableForce {
  W tension, elastic;
};

/// Tension law (Mirletz et al. 2015, eq. 1): T = k (l - L) + b dl while l > L, never negative;
/// otherwise 0. The clamped law limits the damper force to +- the spring force.
template <class W>
TAUT_INLINE CableForce<W> TensionOf(W k, W b, W l, W dl, W rest, bool clamped) noexcept {
  const W zero = W::Splat(0.0);
  const W stretch = l - rest;
  const W spring = math::CableLaw{k}.Force(stretch);
  W damper = b * dl;
  if (clamped) damper = Max(Min(damper, spring), -spring);
  const auto taut = stretch > zero;
  return {Select(taut, Max(spring + damper, zero), zero), Select(taut, spring, zero)};
}

/// Returns position and expected velocity of an attachment.
template <class W>
TAUT_INLINE AttachmentWork<W> Attachment(const AttachmentTable& table,
                                         const Scratch<W>& work) noexcept {
  const BodyWork<W>& body = work.bodies[table.body];
  const Spot<W>& spot = work.spots[table.spot];
  AttachmentWork<W> here;
  here.arm = spot.arm;
  here.p = spot.p;
  here.v = body.v_mid + Cross(body.w_mid, here.arm);
  return here;
}

/// Returns length and rate of a cable, and sets `ends` to its path points. `kTwo`: the cable has
/// two path points, which must stay in registers; therefore only inlined functions receive them.
template <bool kTwo, class W>
TAUT_INLINE PathLength<V3<W>> MeasureCable(const View& m, const Rows<W>& s, const CableTable& cable,
                                           int attachment_count, Scratch<W>& work,
                                           AttachmentWork<W>* ends) noexcept {
  const AttachmentTable* const tables = m.attachments + cable.first_attachment;
  for (int i = 0; i < attachment_count; ++i) ends[i] = Attachment(tables[i], work);
  if constexpr (!kTwo) {
    if (cable.touch >= 0) return MeasureTouching(m, s, cable, work, ends);
    if (cable.wheel_count > 0) {
      PutOnWheels(m, s, cable, work, work.spots, ends);
      return MeasurePath(attachment_count, ends, cable.wheel_count, work.wheels);
    }
  }
  return MeasurePath(attachment_count, ends);
}

/// Moves a rest length toward its target for one step, within the limits of the actuator. Limits
/// are per second, so results do not depend on the step. Force limit as in NTRT: the rest length
/// never becomes so short that the spring force exceeds the limit. Returns the mean rest length
/// over the step, since a motor stops when it reaches its target.
template <class W>
TAUT_INLINE W Actuate(const CableTable& cable, W k, W l, W target, W h, W inv_h, W& rest,
                      W& rate) noexcept {
  const LimitTable& limit = cable.actuator;
  const W zero = W::Splat(0.0), before = rest;
  if (limit.kind == ActuatorDef::Kind::kNone) return rest;
  if (limit.kind == ActuatorDef::Kind::kIdeal) {
    rate = (target - rest) * inv_h;
    rest = target;
    return rest;
  }
  const W least_rest = W::Splat(limit.min_rest_length_m);
  const W goal = Max(Max(target, l - W::Splat(limit.max_force_n) / k), least_rest);
  const W way = goal - rest;
  const W distance = Abs(way);
  const W top = W::Splat(limit.max_speed_m_per_s);
  const W arriving = distance * inv_h;  // rate that reaches the goal at the end of this step
  const bool accelerates_at_once = limit.max_acceleration_m_per_s2 > 1e300;
  const W a = W::Splat(limit.max_acceleration_m_per_s2);
  W speed = Min(arriving, top);
  if (!accelerates_at_once) {
    // Braking distance: v h + v^2 / (2 a) <= distance.
    speed = Min(speed, Sqrt(a * a * h * h + (a + a) * distance) - a * h);
  }
  W wish = Select(way < zero, -speed, speed);
  wish = Select((l < W::Splat(limit.min_length_m)) & (way < zero), zero, wish);
  if (!accelerates_at_once) wish = Max(Min(wish, rate + a * h), rate - a * h);
  const auto arrives = Abs(wish) == arriving;
  rate = wish;
  rest = Max(Select(arrives & !(wish == zero), goal, rest + h * wish), least_rest);
  // Fraction of the step with motion; with limited acceleration, the whole step.
  const W share = accelerates_at_once ? speed * W::Splat(cable.inv_max_speed) : W::Splat(1.0);
  return rest - W::Splat(0.5) * share * (rest - before);
}

/// Data shared by all cables in a step.
template <class W>
struct CableStep {
  W h, inv_h;
  MaskOf<W> goes_on;  ///< Lanes with a previous step, whose tensions are known.
  W push;  ///< Half a step in lanes with dampers, where tensions are iterated; otherwise 0.
  W room;  ///< Negative if a cable may become slack or taut [m^2].
};

/// Computes length, actuator and spring of a cable. `damped`: there are dampers in some lane.
/// `kMotors`, here and below: the model has DC motors.
template <bool kTwo, bool kMotors, class W>
TAUT_INLINE void MeetCable(const View& m, const Rows<W>& s, Scratch<W>& work, int c, bool damped,
                           CableStep<W>& step) noexcept {
  const W zero = W::Splat(0.0), h = step.h;
  const CableTable& cable = m.cables[c];
  CableWork<W>& row = work.cables[c];
  W l;
  if constexpr (kTwo) {
    AttachmentWork<W> ends[2];
    l = MeasureCable<true>(m, s, cable, 2, work, ends).l;
    LinkCable<true>(m, s, work, cable, ends, row);
  } else {
    l = cable.touch >= 0
            ? FollowBends(m, s, work, cable, h)
            : MeasureCable<false>(m, s, cable, cable.attachment_count, work, work.attachments).l;
    KeepWheels(s, cable, work);
    LinkCable<false>(m, s, work, cable, work.attachments, row);
  }
  W k = s.stiffness[c], b = s.damping[c], mean, rate;
  if (kMotors && cable.motor >= 0) {
    mean = DriveMotor(m, s, work, c, k, b, l, MeanRate<kTwo>(work, row), h);
    rate = s.rest_rate[c];
    const W share = work.motors[cable.motor].share;
    k = k * share;
    b = b * share;
  } else {
    W rest = s.rest[c];
    rate = s.rest_rate[c];
    mean = Actuate(cable, k, l, s.target[c], h, step.inv_h, rest, rate);
    s.rest[c] = rest;
    s.rest_rate[c] = rate;
  }
  const W stretch = l - mean;
  const auto stiff = s.stiff_k[c] > work.implicit.limit[c];
  row.soft = !stiff;
  row.spring = Max(math::CableLaw{k}.Force(stretch), zero);
  const bool any_stiff = Any(stiff);
  if (damped || any_stiff) FinishLinks<kTwo>(work, row);
  if (any_stiff) {
    AddStiffCable(m, s, work, c, row, k, b, l, stretch, h, stiff);
    if (!Any(row.soft)) return;
  }
  const W dl = MeanRate<kTwo>(work, row);
  row.stretch = stretch;
  const W way = h * (dl - rate);
  step.room = Min(step.room, stretch * stretch - way * way);
  if (!damped) {
    row.damped = MaskOf<W>::Splat(false);
    return;
  }
  // In the first step, the tension is the spring force, so that bodies in equilibrium do not move.
  row.tension = Select(step.goes_on, s.tension[c], row.spring);
  row.damping = b;
  // Undamped or slack cables have exactly the spring force. Stiff cables keep their tension.
  row.damped = stiff | ((row.damping > zero) & (row.spring > zero));
  row.share = W::Splat(1.0) / (W::Splat(1.0) + step.push * row.damping * row.A);
  if (any_stiff) row.share = Select(stiff, zero, row.share);
  row.upper = W::Splat(1e300);
  if (cable.clamped_damping) row.upper = Select(stiff, row.upper, row.spring + row.spring);
  RelaxCable<kTwo>(work, row, dl, step.push);
}

/// Computes the final tension of soft cables that become slack or taut in this step: the mean
/// spring force over the step, implicit in the final length (docs/theory/cables.md, eq. 11).
/// Explicit steps conserve v^2 + w^2 x^2 / (1 - w^2 h^2 / 4) (eq. 11a), so the spring must store
/// this energy. Otherwise each snatch would gain or lose energy.
template <bool kMotors, class W>
[[gnu::noinline, gnu::cold]] void SettleKinks(const View& m, const Rows<W>& s, Scratch<W>& work,
                                              CableStep<W> step) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  // Rates have changed since `room` was computed. Only lanes with negative `room` count, so that
  // results do not depend on other lanes.
  const auto asks = step.room < zero;
  for (int c = 0; c < m.cable_count; ++c) {
    CableWork<W>& row = work.cables[c];
    const W dl = MeanRate<false>(work, row);
    const W way = step.h * (dl - s.rest_rate[c]);
    const auto near = asks & row.soft & (row.stretch * row.stretch < way * way);
    if (!Any(near)) continue;
    if (m.cables[c].joins_two) {
      FinishLinks<true>(work, row);
    } else {
      FinishLinks<false>(work, row);
    }
    AttachmentWork<W>* const ends = work.attachments;
    const W length =
        MeasureCable<false>(m, s, m.cables[c], m.cables[c].attachment_count, work, ends).l;
    const W before = RateBefore(work, row.links.data(), row.link_count);
    W k = s.stiffness[c], b = s.damping[c];
    if (kMotors && m.cables[c].motor >= 0) {
      const W share = work.motors[m.cables[c].motor].share;
      k = k * share;
      b = b * share;
    }
    const W spring = W::Splat(0.25) * step.h * step.h * math::CableLaw{k}.Slope(row.stretch);
    CableRow<W> law;
    law.A = row.A;
    SetCableLaw(m, s, work, c, length, row.stretch, before, step.h, spring / (one - spring * law.A),
                b, law);
    // The mean rate includes the latest tension or, without dampers, the tension of the previous
    // step.
    const W last = Select(step.goes_on, s.tension[c], zero);
    const W u = before - (dl + dl), now = step.h * Select(step.push > zero, row.tension, last);
    W l;
    const auto crosses = near & law.Project(&u, &now, one, &l).crosses;
    row.damped = row.damped & !crosses;
    row.spring = Select(crosses, step.inv_h * l, row.spring);
  }
}

/// Stage: actuators change the rest lengths, cables pull on bodies.
///   reads   pos, bodies[], target     writes  rest, rest_rate, tension, bodies[].force, .torque
///           (adds), cables[], stiff[]
///   order   cables ascending, then descending, which fixes the order of all sums
/// The force belongs to the middle of the step: path at the middle, mean rest length, and mean of
/// the rates at the start and the end (docs/theory/integrator.md, eq. I7). The warm start predicts
/// the mean velocities from the previous step, including its tensions. Two Gauss-Seidel passes over
/// the cables replace these tensions by new ones. In lanes with an unstable explicit spring, the
/// solver computes the tension (stiff_cables.inl).
template <bool kMotors, class W>
void StageCables(const View& m, const Rows<W>& s, Scratch<W>& work, double step_s) noexcept {
  const W zero = W::Splat(0.0);
  work.stiff_count = work.link_count = 0;
  work.no_room = work.walked_far = 0;
  work.start_known = false;
  auto damps = MaskOf<W>::Splat(false);
  for (int c = 0; c < m.cable_count && Any(!damps); ++c) damps = damps | (s.damping[c] > zero);
  const bool damped = Any(damps);
  CableStep<W> step{W::Splat(step_s), W::Splat(1.0 / step_s), s.last_step[0] > zero,
                    Select(damps, W::Splat(0.5 * step_s), zero), W::Splat(1e300)};
  if constexpr (kMotors) LoadSupplies(m, s, work, step.h);
  for (int c = 0; c < m.cable_count; ++c) {
    if (m.cables[c].joins_two) {
      MeetCable<true, kMotors>(m, s, work, c, damped, step);
    } else if (m.cables[c].span_count > 0) {
      MeetChain(m, s, work, c, step.h, step.inv_h);
    } else {
      MeetCable<false, kMotors>(m, s, work, c, damped, step);
    }
  }
  if (Any(step.room < zero)) SettleKinks<kMotors>(m, s, work, step);
  if (!damped) {
    for (int c = 0; c < m.cable_count; ++c) {
      work.cables[c].tension = work.cables[c].spring;
      PullCable<false, false>(s, work, c);
    }
    return;
  }
  if (work.stiff_count == 0 && m.chain_count == 0) {
    RelaxBack<true>(m, s, work, step.push);
  } else {
    RelaxBack<false>(m, s, work, step.push);
  }
}

}  // namespace taut::sim

#include "sim/cables/cable_chains.inl"
