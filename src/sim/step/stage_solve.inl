/// Stage: solve for the impulses of contacts, stiff cables and joints, with warm starts
/// (docs/theory/contact.md, sections 4 and 5). Bodies that touch only the world, and worlds of
/// bodies connected by stiff cables, are solved in all lanes at once. All other or unsolved
/// constraints are solved lane by lane.
#pragma once

#include "sim/cables/cable_chains.inl"
#include "sim/cables/implicit_groups.inl"
#include "sim/cables/second_order_sticking.inl"
#include "sim/cables/stiff_cables.inl"
#include "sim/contacts/consistent_biases.inl"
#include "sim/contacts/friction.inl"
#include "sim/contacts/prepare_contact.inl"
#include "sim/data/rows.h"
#include "sim/joints/joints.inl"
#include "sim/solve/body_dual.inl"
#include "sim/solve/lane_solve.inl"
#include "sim/solve/packed_contacts.inl"
#include "sim/solve/world_dual.inl"
#include "sim/solve/world_primal.inl"
#include "sim/step/touches.inl"

namespace taut::sim {

template <class W>
struct SolveResult {
  W residual;  ///< Residual per lane [m/s].
  W linear_solves;
  W relaxation;         ///< Largest relaxation of inconsistent contacts [m/s].
  int body[W::kLanes];  ///< Body with the largest residual.
};

/// Returns the memory of a contact in a slot of a body, by its key. Keys ascend in the slots and in
/// the memory of every lane; the cursor skips slots that no lane needs any more.
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

/// Prepares contacts with the world, with a warm start from the impulses of the previous step.
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

/// Fits the contact biases of each body to rigid motions (docs/theory/contact.md, eq. 12): bodies
/// with three or more contacts, and bodies in islands of several bodies. Without this fit, two
/// contacts of a body that is an island by itself are solved up to rounding.
template <class W, class M>
void FitWorldBiases(const View& m, Scratch<W>& work, M tied) noexcept {
  constexpr int kFewest = 3;
  const W zero = W::Splat(0.0);
  // On facets and ridges, the gaps of a body may not match any rigid motion.
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

/// Corrects the biases of contacts with the world (docs/theory/contact.md): for sticking along arcs
/// (eq. 12a), and for jammed bodies (eq. 12b). Bodies that touch moving bodies are excluded:
/// corrected biases would be inconsistent around a loop of bodies, and the solver would not
/// converge for heaps.
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

/// Marks bodies for the lane-by-lane solver: bodies with contacts with moving bodies, bodies with
/// joints, and all bodies of a world with stiff cables, except in lanes in which the joints or
/// cables are solved in lanes (`jointed`, `alone`: lanes in which they are not).
template <class W, class M>
void MarkUnsolved(const View& m, Scratch<W>& work, M alone, M jointed) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  const W mark = Select(alone, one, zero), joint_mark = Select(alone | jointed, one, zero);
  for (int b = 0; b < m.body_count; ++b) work.unsolved[b] = mark;
  for (int k = 0; k < m.joint_body_count; ++k) work.unsolved[m.joint_bodies[k]] = joint_mark;
  for (int lane = 0; lane < W::kLanes; ++lane) {
    for (int i = 0; i < work.touch_count[lane]; ++i) {
      const TouchingPair& pair = work.touches[lane * m.pair_capacity + i];
      work.unsolved[m.shapes[pair.a].body].Set(lane, 1.0);
      const int b = m.shapes[pair.b].body;
      if (!m.HasMotion(b)) work.unsolved[b].Set(lane, 1.0);
    }
  }
}

/// Returns the lanes in which a world with stiff cables may be solved with all rows at once.
/// `touches`: contacts of moving bodies.
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

/// Solves bodies whose contacts with the world form islands.
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

template <class W>
bool AnyDeep(const Scratch<W>& work, int lane, double deepest_m) noexcept {
  bool deep = deepest_m < 0;
  for (int i = 0; i < work.touch_count[lane]; ++i) {
    deep = deep || work.lane.pairs[i].deep[0] < 0;
  }
  return deep;
}

/// Solves lanes with unsolved bodies one after the other, and applies position projection.
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
  // Ends the list of contacts of moving bodies in every lane.
  if (g.touches_used == 0 && touches == 0) return;
  g.touches_used = touches;
  for (int lane = 0; lane < W::kLanes; ++lane) {
    for (int i = work.touch_count[lane]; i < touches; ++i) {
      s.contact_key[m.slot_count + i].Set(lane, kNoKey);
    }
  }
}

/// Stage: solve.
///   reads   contacts[], touches[] (geometry), stiff cables, pos, memory of the previous step
///   writes bodies[].v, .w, impulses, mom, memory of contacts of moving bodies, joint_*
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
  auto primal = MaskOf<W>::Splat(false);
  if (m.world_pattern->count > 0) primal = busy & (touches == zero) & !by_lane;
  MarkUnsolved(m, work, cabled & !dual & !primal, !primal);
  const auto tied = m.joint_count > 0 ? busy : cabled;
  FitWorldBiases(m, work, tied);
  FinishWorldBiases(m, s, work, tied & !by_lane, step_s);
  SolveBodies(m, work, target, busy & !cabled & !primal, result);
  if (Any(primal)) {
    const auto failed = WorldPrimal<W>(m, s, work)
                            .Solve(target, settings.max_linear_solves, primal, result.residual,
                                   result.linear_solves);
    for (int b = 0; b < m.body_count; ++b) {
      work.unsolved[b] = Select(failed, W::Splat(1.0), work.unsolved[b]);
    }
  }
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
