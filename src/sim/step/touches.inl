/// Contacts of two moving bodies in one lane: preparation before the solve, results after it.
#pragma once

#include "sim/cables/implicit_groups.inl"
#include "sim/contacts/consistent_biases.inl"
#include "sim/contacts/friction.inl"
#include "sim/contacts/moving_pairs.h"
#include "sim/contacts/prepare_contact.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Returns the contact point of two bodies in their present poses. The lever arms are from the time
/// of contact. For two moving bodies, a mean is used, because two different points would change the
/// angular momentum.
template <class W, class L>
V3<L> MeetingPoint(const Rows<W>& s, const TouchPoint& point, const int* bodies,
                   const BodyWork<L>* at, int lane) noexcept {
  const V3<L> p = simd::Splat3<L>(point.point);
  if (!(point.when_s > 0)) return p;
  const bool a_moves = s.inv_mass[bodies[0]][lane] > 0, b_moves = s.inv_mass[bodies[1]][lane] > 0;
  const double share = a_moves && b_moves ? 0.5 : a_moves ? 1.0 : 0.0;
  const V3<L> way = L::Splat(share) * at[0].v + L::Splat(1.0 - share) * at[1].v;
  return p - L::Splat(point.when_s) * way;
}

/// Adds biases for sticking to a kinematic body. Its points move along an arc until the middle of
/// the next step, like points of the other body (contact.md, eq. 12a). Both must agree along the
/// surface (motion.md, eq. 4).
template <class W, class L>
void FollowMotion(const Scratch<W>& work, int lane, Contact<L, 2>& c, L h) noexcept {
  const L half_h = L::Splat(0.5) * h, sixth_h2 = L::Splat(1.0 / 6.0) * h * h;
  const auto bend = [&](int k) {
    const V3<L> w = OfLane<L>(work.bodies[c.links[k].body].w_mid, lane);
    const V3<L> once = Cross(w, Cross(w, c.arm[k]));
    return half_h * once + sixth_h2 * Cross(w, once);
  };
  const V3<L> apart = bend(0) - bend(1);
  for (int r = 1; r < 3; ++r) {
    if (r == 2 && c.one_direction) continue;
    c.bias[r] += Dot(c.links[0].lin[r], apart);
  }
}

/// Prepares the contacts of moving bodies of a lane, with warm starts identified by their keys.
template <class W>
void PrepareTouches(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work, int lane,
                    double step_s) noexcept {
  using L = simd::Lane<W>;
  int memory_at = m.slot_count;
  const int memory_end = m.slot_count + g.touches_used;
  for (int i = 0; i < work.touch_count[lane]; ++i) {
    const TouchingPair& touch = work.touches[lane * m.pair_capacity + i];
    const ShapePairTable pair = PairOf(m, touch.a, touch.b, touch.key);
    const TouchPoint& point = touch.point;
    const int bodies[2] = {m.shapes[pair.a].body, m.shapes[pair.b].body};
    Contact<L, 2>& c = work.lane.pairs[i];
    BodyWork<L> body[2];
    for (int k = 0; k < 2; ++k) {
      const BodyWork<W>& from = work.bodies[bodies[k]];
      body[k].v = OfLane<L>(from.v, lane), body[k].w = OfLane<L>(from.w, lane);
      body[k].v0 = OfLane<L>(from.v0, lane), body[k].w0 = OfLane<L>(from.w0, lane);
      body[k].inv_inertia = OfLane<L>(from.inv_inertia, lane);
    }
    const V3<L> at = MeetingPoint(s, point, bodies, body, lane);
    for (int k = 0; k < 2; ++k) c.arm[k] = at - OfLane<L>(s.pos[bodies[k]], lane);
    const double key = pair.id + static_cast<uint32_t>(point.feature);
    c.key = L::Splat(key);
    c.live = L::Splat(1.0);
    c.frame = L::Splat(kNoKey);
    c.gap = L::Splat(point.gap_m);
    c.static_friction = L::Splat(pair.static_friction);
    c.kinetic_friction = L::Splat(pair.kinetic_friction);
    c.restitution = L::Splat(pair.restitution);
    c.one_direction = m.along_slip;
    c.directed = false;
    c.links[0].lin[0] = simd::Splat3<L>(point.normal);
    c.links[0].lin[1] = c.links[0].lin[2] = c.links[0].lin[0];  // PrepareContact sets lin[1..2]
    ContactMemory<L> memory = ContactMemory<L>::None();
    while (memory_at < memory_end && s.contact_key[memory_at][lane] >= 0 &&
           s.contact_key[memory_at][lane] < key) {
      ++memory_at;
    }
    if (memory_at < memory_end && s.contact_key[memory_at][lane] == key) {
      memory.force = OfLane<L>(s.contact_force[memory_at], lane);
      memory.slip = OfLane<L>(s.contact_slip[memory_at], lane);
    }
    if (m.friction != nullptr) AskFriction(m, s, g, work, bodies, memory, lane, 0, c);
    PrepareContact(c, memory, body[0], bodies[0], OfLane<L>(s.inv_mass[bodies[0]], lane), body[1],
                   bodies[1], OfLane<L>(s.inv_mass[bodies[1]], lane),
                   OfLane<L>(s.friction_scale[0], lane), step_s);
    if (work.implicit.any) {
      const auto on = [&](int b) { return work.implicit.bodies[b][lane] > 0; };
      LeaveSlowly(c, MaskOf<L>::Splat(on(bodies[0]) || on(bodies[1])), step_s);
    }
  }
  for (int first = 0, next = 0; first < work.touch_count[lane]; first = next) {
    const Contact<L, 2>* const c = work.lane.pairs;
    while (next < work.touch_count[lane] && c[next].links[0].body == c[first].links[0].body &&
           c[next].links[1].body == c[first].links[1].body) {
      ++next;
    }
    if (next - first > 1) FitBiases(work.lane.pairs + first, next - first, MaskOf<L>::Splat(true));
    for (int i = first; m.HasMotion(c[first].links[1].body) && i < next; ++i) {
      const TouchingPair& pair = work.touches[lane * m.pair_capacity + i];
      if (m.Rolls(pair.a, pair.b)) continue;
      FollowMotion(work, lane, work.lane.pairs[i], L::Splat(step_s));
    }
  }
}

/// Applies the impulses of the contacts of moving bodies to the momenta of a lane, and stores these
/// impulses in the contact memory.
template <class W>
void FinishTouches(const View& m, const Rows<W>& s, Scratch<W>& work, int lane,
                   double step_s) noexcept {
  using L = simd::Lane<W>;
  const L inv_h = L::Splat(1.0 / step_s);
  for (int i = 0; i < work.touch_count[lane]; ++i) {
    Contact<L, 2>& c = work.lane.pairs[i];
    L u[3] = {L::Splat(0.0), L::Splat(0.0), L::Splat(0.0)};
    const V3<L> impulse = ImpulseOf(c);
    for (int k = 0; k < 2; ++k) {
      const int body = c.links[k].body;
      AddVelocity(c.links[k], OfLane<L>(work.bodies[body].v, lane),
                  OfLane<L>(work.bodies[body].w, lane), u);
      const V3<L> turned = Cross(c.arm[k], impulse), before = OfLane<L>(s.mom[body], lane);
      SetLane(s.mom[body], k == 0 ? before + turned : before - turned, lane);
    }
    if (m.HasMotion(c.links[1].body)) {
      BodyWork<W>& body = work.bodies[c.links[1].body];
      SetLane(body.force, OfLane<L>(body.force, lane) - inv_h * impulse, lane);
      SetLane(body.torque, OfLane<L>(body.torque, lane) - inv_h * Cross(c.arm[1], impulse), lane);
    }
    JudgeSlip(c, u);
    for (int k = 0; k < 2 && Any((c.lands > L::Splat(0.0)) & (c.l[0] > L::Splat(0.0))); ++k) {
      work.bodies[c.links[k].body].landed.Set(lane, 1.0);
    }
    const int slot = m.slot_count + i;
    s.contact_key[slot].Set(lane, c.key[0]);
    SetLane(s.contact_force[slot], inv_h * impulse, lane);
    s.contact_slip[slot].Set(lane, c.l[0][0] > 0 ? c.slip[0] : kSlipUnknown);
    SetLane(s.contact_arm[slot], c.arm[0], lane);
    SetLane(s.contact_normal[slot], c.links[0].lin[0], lane);
    s.contact_gap[slot].Set(lane, c.gap[0]);
  }
}

}  // namespace taut::sim
