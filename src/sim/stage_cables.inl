/// Stages of the cables: actuators and forces, sensors (docs/theory/cables.md).
///
///   k, b    stiffness [N/m], damping [N s/m]
///   l, dl   length along all attachments [m], its rate [m/s]
///   L       rest length [m]
///   T       tension [N]

namespace taut::sim {

template <class W>
struct CableForce {
  W tension, elastic;
};

/// Paper eq. (1): T = k (l - L) + b dl while l > L, never negative, otherwise 0.
/// With the clamped law the damper's part is limited to +- the spring's.
template <class W>
TAUT_INLINE CableForce<W> TensionOf(W k, W b, W l, W dl, W rest, bool clamped) noexcept {
  const W zero = W::Splat(0.0);
  const W stretch = l - rest;
  const W spring = k * stretch;
  W damper = b * dl;
  if (clamped) damper = Max(Min(damper, spring), -spring);
  const auto taut = stretch > zero;
  return {Select(taut, Max(spring + damper, zero), zero), Select(taut, spring, zero)};
}

/// Where an attachment is and how fast it is expected to move.
template <class W>
TAUT_INLINE AttachmentWork<W> Attachment(const View& m, const AttachmentTable& table,
                                         const V3<W>* origin, const Scratch<W>& work) noexcept {
  const BodyWork<W>& body = work.bodies[table.body];
  AttachmentWork<W> here;
  here.arm = body.R * simd::Splat3<W>(table.p_P);
  here.p = table.body < m.body_count ? origin[table.body] + here.arm : here.arm;
  here.v = body.v_mid + Cross(body.w_mid, here.arm);
  return here;
}

/// Length and rate of a cable; fills `ends` with its attachments.
template <class W>
TAUT_INLINE PathLength<V3<W>> MeasureCable(const View& m, const CableTable& cable,
                                           int attachment_count, const V3<W>* origin,
                                           const Scratch<W>& work,
                                           AttachmentWork<W>* ends) noexcept {
  const AttachmentTable* const tables = m.attachments + cable.first_attachment;
  for (int i = 0; i < attachment_count; ++i) ends[i] = Attachment(m, tables[i], origin, work);
  return MeasurePath(attachment_count, ends);
}

/// A rest length follows its target for one step, within the actuator's limits. Limits are per
/// second, so nothing depends on the step. The force limit is NTRT's: never wind past the rest
/// length at which the spring would exceed it. Returns the rest length's mean over the step: a
/// motor runs until it arrives, and then stands.
template <class W>
TAUT_INLINE W Actuate(const CableTable& cable, W k, W l, W target, W h, W inv_h, W& rest,
                      W& rate) noexcept {
  const ActuatorDef& limit = cable.actuator;
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
  const W arriving = distance * inv_h;  // the rate that ends this step at the goal
  const bool accelerates_at_once = limit.max_acceleration_m_per_s2 > 1e300;
  const W a = W::Splat(limit.max_acceleration_m_per_s2);
  W speed = Min(arriving, top);
  if (!accelerates_at_once) {
    // No faster than can still be braked: v h + v^2 / (2 a) <= distance.
    speed = Min(speed, Sqrt(a * a * h * h + (a + a) * distance) - a * h);
  }
  W wish = Select(way < zero, -speed, speed);
  wish = Select((l < W::Splat(limit.min_length_m)) & (way < zero), zero, wish);
  if (!accelerates_at_once) wish = Max(Min(wish, rate + a * h), rate - a * h);
  const auto arrives = Abs(wish) == arriving;
  rate = wish;
  rest = Max(Select(arrives & !(wish == zero), goal, rest + h * wish), least_rest);
  // The share of the step in which it runs; with limited acceleration, taken as all of it.
  const W share = accelerates_at_once ? speed * W::Splat(cable.inv_max_speed) : W::Splat(1.0);
  return rest - W::Splat(0.5) * share * (rest - before);
}

/// One cable of the stage below. `ends` is room for its attachments: known to be two, they stay
/// in registers.
template <class W>
TAUT_INLINE void PullCable(const View& m, const Rows<W>& s, Scratch<W>& work, int c,
                           int attachment_count, AttachmentWork<W>* ends, W h, W inv_h) noexcept {
  const W zero = W::Splat(0.0);
  const CableTable& cable = m.cables[c];
  const auto [l, dl] = MeasureCable(m, cable, attachment_count, s.pos.data(), work, ends);
  W rest = s.rest[c], rate = s.rest_rate[c];
  const W mean = Actuate(cable, s.stiffness[c], l, s.target[c], h, inv_h, rest, rate);
  s.rest[c] = rest;
  s.rest_rate[c] = rate;
  W T = TensionOf(s.stiffness[c], s.damping[c], l, dl, mean, cable.clamped_damping).tension;
  const auto stiff =
      (h * h * s.stiff_k[c] > W::Splat(kSoftSpring)) | (h * s.stiff_b[c] > W::Splat(kSoftDamper));
  if (Any(stiff)) {
    for (int i = 0; i < attachment_count; ++i) work.attachments[i] = ends[i];
    AddStiffCable(m, s, work, c, l, l - mean, h, Select(stiff, W::Splat(1.0), zero));
    T = Select(stiff, zero, T);
    s.tension[c] = Select(stiff, s.tension[c], T);
    if (!Any(!stiff)) return;
  } else {
    s.tension[c] = T;
  }
  const AttachmentTable* const tables = m.attachments + cable.first_attachment;
  PullBodies(attachment_count, ends, T,
             [&](int i) -> BodyWork<W>& { return work.bodies[tables[i].body]; });
}

/// Stage: actuators move the rest lengths, cables pull on bodies.
///   reads   pos, bodies[], target     writes  rest, rest_rate, tension, bodies[].force, .torque
///           (adds), stiff[]
///   order   cables ascending within a group: sums do not depend on anything else
/// The force is that of the middle of the step: geometry and expected velocities there, and the
/// rest length's mean over the step. Lanes in which that would not be stable leave the
/// cable to the solver (stiff_cables.inl).
template <class W>
void StageCables(const View& m, const Rows<W>& s, Scratch<W>& work, double step_s) noexcept {
  const W h = W::Splat(step_s), inv_h = W::Splat(1.0 / step_s);
  work.stiff_count = work.link_count = 0;
  for (int c = 0; c < m.cable_count; ++c) {
    const int count = m.cables[c].attachment_count;
    if (count == 2) {
      AttachmentWork<W> ends[2];
      PullCable(m, s, work, c, 2, ends, h, inv_h);
    } else {
      PullCable(m, s, work, c, count, work.attachments, h, inv_h);
    }
  }
}

/// One cable of the stage below; `ends` as in PullCable.
template <class W>
TAUT_INLINE void SenseCable(const View& m, const Rows<W>& s, const Scratch<W>& work, int c,
                            int attachment_count, AttachmentWork<W>* ends) noexcept {
  const auto [l, dl] = MeasureCable(m, m.cables[c], attachment_count, s.pos.data(), work, ends);
  const CableForce<W> f =
      TensionOf(s.stiffness[c], s.damping[c], l, dl, s.rest[c], m.cables[c].clamped_damping);
  s.sense_length[c] = l;
  s.sense_rate[c] = dl;
  s.sense_tension[c] = f.tension;
  s.sense_elastic[c] = f.elastic;
}

/// Stage: what sensors see of the cables at the end of a step.
///   reads   pos, bodies[] (of the current state)     writes  sense_*
template <class W>
void StageSense(const View& m, const Rows<W>& s, const Scratch<W>& work) noexcept {
  for (int c = 0; c < m.cable_count; ++c) {
    const int count = m.cables[c].attachment_count;
    if (count == 2) {
      AttachmentWork<W> ends[2];
      SenseCable(m, s, work, c, 2, ends);
    } else {
      SenseCable(m, s, work, c, count, work.attachments);
    }
  }
}

}  // namespace taut::sim
