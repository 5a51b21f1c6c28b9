/// Stage: impulses of contacts, stiff cables and joints (docs/theory/contact.md, sections 4 and 5).
/// One solve in three places: bodies that only stand on the world, and worlds that hang together by
/// stiff cables, in all lanes at once; all else, and what those did not get, lane by lane.
#pragma once

#include "sim/cables/cable_chains.inl"
#include "sim/cables/follow_arcs.inl"
#include "sim/cables/implicit_groups.inl"
#include "sim/cables/stiff_cables.inl"
#include "sim/contacts/fit_biases.inl"
#include "sim/contacts/friction.inl"
#include "sim/contacts/prepare_contact.inl"
#include "sim/data/rows.h"
#include "sim/joints/joints.inl"
#include "sim/solve/body_dual.inl"
#include "sim/solve/lane_solve.inl"
#include "sim/solve/packed_contacts.inl"
#include "sim/solve/world_dual.inl"

namespace taut::sim {

template <class W>
struct SolveResult {
  W residual;  ///< How far a lane is from solved [m/s].
  W linear_solves;
  W relaxation;         ///< Largest relaxation of inconsistent biases [m/s].
  int body[W::kLanes];  ///< Where it is furthest.
};

/// What a body's slot remembers, by its key. Both sides have their keys rising in every lane; the
/// cursor stays behind the slots that no lane needs any more.
template <class W>
TAUT_INLINE ContactMemory<W> Recall(const Rows<W>& s, const Contact<W, 1>& c, int first, int used,
                                    int& cursor) noexcept {
  ContactMemory<W> found = ContactMemory<W>::None();
  auto missing = c.live > W::Splat(0.0);
  while (cursor < used && !Any(missing & !(s.contact_key[first + cursor] < c.key))) ++cursor;
  for (int i = first + cursor; i < first + used && Any(missing); ++i) {
    const auto here = missing & (s.contact_key[i] == c.key);
    if (Any(here)) {
      found.force = Select3(here, s.contact_force[i], found.force);
      found.slip = Select(here, s.contact_slip[i], found.slip);
    }
    missing = missing & !here & (s.contact_key[i] < c.key);
  }
  return found;
}

/// Contacts with the world get their equations and start from the impulses of the step before.
template <class W>
void PrepareContacts(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                     double step_s) noexcept {
  for (int b = 0; b < m.body_count; ++b) {
    int cursor = 0;
    for (int k = 0; k < work.contact_count[b]; ++k) {
      Contact<W, 1>& c = work.contacts[m.first_slot[b] + k];
      const auto memory = Recall(s, c, m.first_slot[b], g.slots_used[b], cursor);
      const BodyWork<W>& body = work.bodies[b];
      if (m.friction != nullptr) AskFrictions(m, s, g, work, b, memory, c);
      PrepareContact(c, memory, body, b, s.inv_mass[b], body, b, s.inv_mass[b], s.friction_scale[0],
                     step_s);
    }
  }
}

/// Biases of bodies with more than two contacts, or that are not islands of their own: two
/// contacts by themselves are solved to the last digit as they are.
template <class W, class M>
void FitWorldBiases(const View& m, Scratch<W>& work, M tied) noexcept {
  constexpr int kFewest = 3;
  const W zero = W::Splat(0.0);
  // Over facets and ridges the gaps of one body need not be those of any motion.
  const double most = m.has_ground ? kDisagreementMPerS : kFittedMPerS;
  for (int b = 0; b < m.body_count; ++b) {
    const int count = work.contact_count[b];
    if (count < 2) continue;
    Contact<W, 1>* const contacts = work.contacts + m.first_slot[b];
    auto lanes = tied | (work.unsolved[b] > zero);
    if (count >= kFewest) lanes = lanes | (contacts[kFewest - 1].live > zero);
    if (Any(lanes)) FitBiases(contacts, count, lanes, most);
  }
}

/// Biases of contacts with the world that follow the body's arc, and agree.
/// Not where bodies touch others that move: biases that agree on a body contradict each other
/// around a loop of bodies, and heaps are left unsolved by it.
template <class W, class M>
void FinishWorldBiases(const View& m, const Rows<W>& s, Scratch<W>& work, M tied,
                       double step_s) noexcept {
  const W zero = W::Splat(0.0);
  const bool in_several_directions = m.plane_count > 1 || m.world_pair_count > 0;
  for (int b = 0; b < m.body_count; ++b) {
    const int count = work.contact_count[b];
    if (count == 0) continue;
    const auto lanes = tied | !(work.unsolved[b] > zero);
    if (!Any(lanes)) continue;
    Contact<W, 1>* const contacts = work.contacts + m.first_slot[b];
    FollowArcs(s, work.bodies[b], b, contacts, count, lanes, W::Splat(step_s));
    if (in_several_directions) AgreeBiases(contacts, count, lanes);
  }
}

/// Which lanes' bodies are left to the lane's own solve from the start: those that have joints or
/// touch moving bodies, and all of a world with stiff cables that is not solved in lanes.
template <class W, class M>
void MarkUnsolved(const View& m, Scratch<W>& work, M alone) noexcept {
  const W mark = Select(alone, W::Splat(1.0), W::Splat(0.0));
  for (int b = 0; b < m.body_count; ++b) work.unsolved[b] = mark;
  for (int k = 0; k < m.joint_body_count; ++k) work.unsolved[m.joint_bodies[k]] = W::Splat(1.0);
  for (int lane = 0; lane < W::kLanes; ++lane) {
    for (int i = 0; i < work.touch_count[lane]; ++i) {
      const ShapePairTable& pair = m.shape_pairs[work.touches[lane * m.pair_capacity + i].pair];
      work.unsolved[m.shapes[pair.a].body].Set(lane, 1.0);
      const int b = m.shapes[pair.b].body;
      if (!m.HasMotion(b)) work.unsolved[b].Set(lane, 1.0);
    }
  }
}

/// Lanes whose worlds, if cables tie them, may be solved all at once. `touches`: of moving bodies.
template <class W>
MaskOf<W> MayGoToDual(const View& m, const Scratch<W>& work, W touches) noexcept {
  const W zero = W::Splat(0.0);
  if (work.dual.capacity == 0 || m.chain_count > 0) return MaskOf<W>::Splat(false);
  if (!m.has_ground) return touches == zero;
  W contacts = zero;
  for (int b = 0; b < m.body_count; ++b) {
    for (int k = 0; k < work.contact_count[b]; ++k) {
      contacts += work.contacts[m.first_slot[b] + k].live;
    }
  }
  return (touches == zero) & !(contacts > W::Splat(work.dual.packed_capacity));
}

/// Bodies whose contacts with the world are islands.
template <class W, class M>
void SolveBodies(const View& m, Scratch<W>& work, Target target, M lanes,
                 SolveResult<W>& result) noexcept {
  const W zero = W::Splat(0.0);
  for (int b = 0; b < m.body_count; ++b) {
    const int count = work.contact_count[b];
    if (count == 0) continue;
    Contact<W, 1>* const rows = work.contacts + m.first_slot[b];
    const auto left = work.unsolved[b] > zero;
    auto mine = lanes & !left;
    auto crowded = M::Splat(false);
    if (count > kMaxDualContacts) crowded = rows[kMaxDualContacts].live > zero;
    mine = mine & !crowded;
    M failed = lanes & crowded;
    if (Any(mine)) {
      failed = failed | SolveBody(work.bodies[b], rows,
                                  count < kMaxDualContacts ? count : kMaxDualContacts, target, mine,
                                  result.residual, result.linear_solves);
    }
    if (Any(failed)) work.unsolved[b] = Select(failed, W::Splat(1.0), work.unsolved[b]);
  }
}

/// Where, by the places of now, a touching point of two bodies is. Levers are those of the moment
/// of touch; of two moving bodies, in the mean: a pair needs one point, or its impulses would
/// change the angular momentum.
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

/// What sticks to a body with a motion is a point of it that goes on along an arc until the middle
/// of the next step, as points on the other body do (contact.md, eq. 12a): along the surface they
/// are to stay together.
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

/// A lane's touches as contacts, from what they remember.
template <class W>
void PrepareTouches(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work, int lane,
                    double step_s) noexcept {
  using L = simd::Lane<W>;
  int memory_at = m.slot_count;
  const int memory_end = m.slot_count + g.touches_used;
  for (int i = 0; i < work.touch_count[lane]; ++i) {
    const TouchingPair& touch = work.touches[lane * m.pair_capacity + i];
    const ShapePairTable& pair = m.shape_pairs[touch.pair];
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
    c.links[0].lin[1] = c.links[0].lin[2] = c.links[0].lin[0];  // to be made
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
      if (m.shape_pairs[work.touches[lane * m.pair_capacity + i].pair].rolls) continue;
      FollowMotion(work, lane, work.lane.pairs[i], L::Splat(step_s));
    }
  }
}

/// What a lane's touches came to, into momenta and memory.
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

template <class W>
bool AnyDeep(const Scratch<W>& work, int lane, double deepest_m) noexcept {
  bool deep = deepest_m < 0;
  for (int i = 0; i < work.touch_count[lane]; ++i) {
    deep = deep || work.lane.pairs[i].deep[0] < 0;
  }
  return deep;
}

/// Lanes whose bodies are not all solved, one after the other.
template <class W>
void SolveLanes(const View& m, const Rows<W>& s, Group& g, Scratch<W>& work,
                const StepSettings& settings, double step_s, SolveResult<W>& result) noexcept {
  W unsolved = W::Splat(0.0), deepest = unsolved;
  for (int b = 0; b < m.body_count; ++b) {
    unsolved += work.unsolved[b];
    for (int k = 0; k < work.contact_count[b]; ++k) {
      deepest = Min(work.contacts[m.first_slot[b] + k].deep, deepest);
    }
  }
  int touches = 0;
  for (int lane = 0; lane < W::kLanes; ++lane) {
    const bool halted = s.halted[0][lane] > 0;
    if (work.touch_count[lane] > touches) touches = work.touch_count[lane];
    if (!(unsolved[lane] > 0 || deepest[lane] < 0) || halted) continue;
    PrepareTouches(m, s, g, work, lane, step_s);
    LaneSolve<W> solver(m, s, work, settings, lane, step_s);
    const LaneResult lane_result = solver.Solve();
    result.linear_solves.Set(lane, result.linear_solves[lane] + lane_result.linear_solves);
    result.relaxation.Set(lane, lane_result.relaxation);
    if (!(lane_result.residual <= result.residual[lane])) {
      result.residual.Set(lane, lane_result.residual);
      result.body[lane] = lane_result.body;
    }
    FinishTouches(m, s, work, lane, step_s);
    if (AnyDeep(work, lane, deepest[lane])) {
      const int linear_solves = solver.PushOut();
      result.linear_solves.Set(lane, result.linear_solves[lane] + linear_solves);
    }
  }
  // Every lane must know where its list ends.
  if (g.touches_used == 0 && touches == 0) return;
  g.touches_used = touches;
  for (int lane = 0; lane < W::kLanes; ++lane) {
    for (int i = work.touch_count[lane]; i < touches; ++i) {
      s.contact_key[m.slot_count + i].Set(lane, kNoKey);
    }
  }
}

/// Stage: solve.
///   reads   contacts[], touches[] (geometry), stiff cables, pos, memory of the step before
///   writes  bodies[].v, .w, impulses, mom, memory of touches, joint_*
template <class W>
SolveResult<W> StageSolve(const View& m, const Rows<W>& s, Group& g, Scratch<W>& work,
                          const StepSettings& settings, double step_s) noexcept {
  const W zero = W::Splat(0.0);
  const Target target{settings.tolerance_m_per_s};
  SolveResult<W> result{zero, zero, zero, {}};
  for (int& body : result.body) body = kWorld;
  PrepareContacts(m, s, g, work, step_s);
  if (m.joint_count > 0) PrepareJoints(m, s, work, step_s);
  const auto busy = s.halted[0] == zero;
  W cables = zero, touches = zero;
  for (int i = 0; i < work.stiff_count; ++i) cables += work.stiff[i].live;
  if (m.chain_count > 0) cables = W::Splat(1.0);
  for (int lane = 0; lane < W::kLanes; ++lane) touches.Set(lane, work.touch_count[lane]);
  const auto cabled = busy & (cables > zero);
  auto dual = cabled & MayGoToDual(m, work, touches);
  auto by_lane = MaskOf<W>::Splat(false);
  if (work.implicit.any) {
    by_lane = StartImplicit(m, work);
    LeaveWorldSlowly(m, work, step_s);
  }
  dual = dual & !by_lane;
  MarkUnsolved(m, work, cabled & !dual);
  const auto tied = m.joint_count > 0 ? busy : cabled;
  FitWorldBiases(m, work, tied);
  FinishWorldBiases(m, s, work, tied & !by_lane, step_s);
  SolveBodies(m, work, target, busy & !cabled, result);
  if (Any(dual)) {
    const auto solve = [&](auto contacts) {
      return WorldDual<W, decltype(contacts)>(m, s, work, contacts)
          .Solve(target, dual, result.residual, result.linear_solves);
    };
    const auto failed =
        m.has_ground ? solve(PackedContacts<W>(m, work, dual)) : solve(ContactsInSlots<W>(m, work));
    for (int b = 0; b < m.body_count; ++b) {
      work.unsolved[b] = Select(failed, W::Splat(1.0), work.unsolved[b]);
    }
  }
  SolveLanes(m, s, g, work, settings, step_s, result);
  for (int b = 0; b < m.body_count; ++b) {
    for (int k = 0; k < work.contact_count[b]; ++k) {
      Contact<W, 1>& c = work.contacts[m.first_slot[b] + k];
      s.mom[b] += Cross(c.arm[0], ImpulseOf(c));
      W u[3] = {zero, zero, zero};
      work.bodies[b].landed = Max(Select(c.l[0] > zero, c.lands, zero), work.bodies[b].landed);
      if (!Any(c.static_friction > c.kinetic_friction)) continue;
      AddVelocity(c.links[0], work.bodies[b].v, work.bodies[b].w, u);
      JudgeSlip(c, u);
    }
  }
  FinishStiffCables(s, work, step_s);
  if (m.chain_count > 0) FinishChains(m, s, work, step_s);
  if (m.joint_count > 0) FinishJoints(m, s, work, step_s);
  return result;
}

}  // namespace taut::sim
