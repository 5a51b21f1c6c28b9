/// Copies an island of one lane to the memory of the solver, and the solution back (LaneSolve).
#pragma once

#include "sim/data/rows.h"
#include "sim/solve/lane_solve.inl"

namespace taut::sim {

template <class W>
bool LaneSolve<W>::Gather(int root) noexcept {
  count_ = 0;
  for (int b = root; b < m_.body_count; ++b) {
    if (mem_.root[b] != root) continue;
    mem_.bodies[count_] = b;
    mem_.local[b] = count_++;
  }
  island_root_ = root;
  Order();
  Island<L, StepPools<L>>& island = mem_.island;
  for (int k = 0; k < count_; ++k) GatherBody(mem_.bodies[mem_.order[k]], island.bodies[k]);
  island.body_count = count_;
  for (int i = 0; i < m_.motion_count; ++i) {  // prescribed
    const int b = m_.motions[i].body, k = island.body_count++;
    mem_.local[b] = mem_.place[k] = k;
    GatherBody(b, island.bodies[k]);
  }
  GatherContacts(island.pools);
  GatherCables(island.pools);
  GatherJoints(island.pools, island.pools);
  GatherChains(island.pools);
  island.rows = island.pools.rows();
  GatherImpulses();
  return island.rows > 0 || (work_.implicit.any && IsImplicit());
}

template <class W>
void LaneSolve<W>::GatherImpulses() noexcept {
  Island<L, StepPools<L>>& island = mem_.island;
  int row = 0;
  Pool<ContactPoint<L, 2>>& contacts = island.pools;
  for (int i = 0; i < contacts.count; ++i) {
    for (int k = 0; k < 3; ++k) island.m.l[row++] = contacts.items[i].l[k];
  }
  Pool<CableRow<L>>& cables = island.pools;
  for (int i = 0; i < cables.count; ++i) island.m.l[row++] = cables.items[i].l[0];
  Pool<JointRow<L>>& joints = island.pools;
  for (int i = 0; i < joints.count; ++i) island.m.l[row++] = joints.items[i].l[0];
  Pool<TurnFriction<L>>& frictions = island.pools;
  for (int i = 0; i < frictions.count; ++i) {
    for (int k = 0; k < 3; ++k) {
      island.m.l[row++] = OfLane<L>(work_.joints[friction_source_[i] + k].l[0], lane_);
    }
  }
  Pool<CableChain<L>>& chains = island.pools;
  for (int i = 0; i < chains.count; ++i) {
    for (int k = 0; k < chains.items[i].rows; ++k) island.m.l[row++] = chains.items[i].spans[k].l;
  }
}

template <class W>
void LaneSolve<W>::GatherBody(int body, Unknown<L>& out) const noexcept {
  const BodyWork<W>& b = work_.bodies[body];
  out.body = body;
  out.size = kDofs;
  out.mass = OfLane<L>(s_.mass[body], lane_);
  out.inv_mass = OfLane<L>(s_.inv_mass[body], lane_);
  out.inv_inertia = OfLane<L>(b.inv_inertia, lane_);
  const M3<L> R{OfLane<L>(b.R.r0, lane_), OfLane<L>(b.R.r1, lane_), OfLane<L>(b.R.r2, lane_)};
  out.inertia = Congruence(R, OfLane<L>(s_.inertia[body], lane_));
  const V3<L> none{L::Splat(0.0), L::Splat(0.0), L::Splat(0.0)};
  out.free = {OfLane<L>(b.v, lane_), OfLane<L>(b.w, lane_)};
  if (displaces_) out.free = {none, none};
  out.before = {OfLane<L>(b.v0, lane_), OfLane<L>(b.w0, lane_)};
}

template <class W>
template <int R, int S>
void LaneSolve<W>::GatherLink(const Link<W, R>& from, Link<L, S>& to, int first) const noexcept {
  to.body = Number(from.body);
  to.inv_mass = OfLane<L>(from.inv_mass, lane_);
  for (int r = 0; r < R; ++r) {
    to.lin[first + r] = OfLane<L>(from.lin[r], lane_);
    to.ang[first + r] = OfLane<L>(from.ang[r], lane_);
    to.turn[first + r] = OfLane<L>(from.turn[r], lane_);
  }
}

/// Copies inverse masses computed for all lanes at once (prepare_contact.inl).
template <class W>
void LaneSolve<W>::GatherMasses(const Contact<W, 1>& from, ContactPoint<L, 2>& to) const noexcept {
  to.wnn = OfLane<L>(from.wnn, lane_), to.wt = OfLane<L>(from.wt, lane_);
  to.inv_wnn = OfLane<L>(from.inv_wnn, lane_), to.inv_wt = OfLane<L>(from.inv_wt, lane_);
  to.w1n = OfLane<L>(from.w1n, lane_), to.w2n = OfLane<L>(from.w2n, lane_);
  to.w11 = OfLane<L>(from.w11, lane_), to.w12 = OfLane<L>(from.w12, lane_);
  to.w22 = OfLane<L>(from.w22, lane_);
}

template <class W>
void LaneSolve<W>::GatherContacts(Pool<ContactPoint<L, 2>>& pool) noexcept {
  pool.count = 0;
  for (int i = 0; i < count_; ++i) {
    const int body = mem_.bodies[i];
    for (int k = 0; k < work_.contact_count[body]; ++k) {
      const int slot = m_.first_slot[body] + k;
      const Contact<W, 1>& from = work_.contacts[slot];
      if (!(from.live[lane_] > 0)) continue;
      ContactPoint<L, 2>& to = pool.items[pool.count];
      mem_.source[pool.count++] = slot;
      to.live = OfLane<L>(from.live, lane_);
      to.mu = OfLane<L>(from.mu, lane_);
      to.restitution = OfLane<L>(from.restitution, lane_);
      to.before = OfLane<L>(from.before, lane_);
      for (int r = 0; r < 3; ++r) {
        to.bias[r] = OfLane<L>(from.bias[r], lane_);
        to.l[r] = OfLane<L>(from.l[r], lane_);
      }
      to.one_direction = from.one_direction;
      to.link_count = 1;
      GatherLink(from.links[0], to.links[0]);
      GatherMasses(from, to);
      if (displaces_) Displacing(to, from.deep[lane_], from.gap[lane_]);
    }
  }
  for (int i = 0; i < work_.touch_count[lane_]; ++i) {
    const Contact<L, 2>& from = mem_.pairs[i];
    if (mem_.root[from.links[0].body] != island_root_) continue;
    ContactPoint<L, 2>& to = pool.items[pool.count];
    mem_.source[pool.count++] = m_.slot_count + i;
    to = from;
    for (Link<L, 3>& link : to.links) link.body = Number(link.body);
    if (displaces_) Displacing(to, from.deep[0], from.gap[0]);
  }
  cable_source_ = mem_.source.From(pool.count);
}

template <class W>
void LaneSolve<W>::GatherCables(Pool<CableRow<L>>& pool) noexcept {
  pool.count = 0;
  int link_count = 0;
  for (int i = 0; i < work_.stiff_count; ++i) {
    const StiffCable<W>& from = work_.stiff[i];
    if (!IsOn(from) || IsImplicit(from)) continue;
    CableRow<L>& to = pool.items[pool.count];
    const Row<Link<L, 1>> links = mem_.links.From(link_count);
    to.links = links;
    to.link_count = 0;
    bool pulls = false;
    for (int k = 0; k < from.link_count; ++k) {
      const int body = from.links[k].body;
      const bool mine = Moves(body) && mem_.root[body] == island_root_;
      if ((!mine && !m_.HasMotion(body)) || !IsOn(from, k)) continue;
      pulls = pulls || mine;
      GatherLink(from.links[k], links[to.link_count++]);
    }
    if (!pulls) continue;
    link_count += to.link_count;
    cable_source_[pool.count++] = i;
    to.TakeLaw(from, [&](W x) { return OfLane<L>(x, lane_); });
    to.FinishMasses();
  }
  joint_source_ = cable_source_.From(pool.count);
}

template <class W>
void LaneSolve<W>::GatherJoints(Pool<JointRow<L>>& pool,
                                Pool<TurnFriction<L>>& frictions) noexcept {
  pool.count = 0;
  for (int i = 0; i < m_.joint_row_count; ++i) {
    const HeldRow<W>& from = work_.joints[i];
    if (!(from.live[lane_] > 0) || mem_.root[from.links[0].body] != island_root_) continue;
    if (m_.joint_rows[i].role == JointRole::kTurnFriction) continue;
    if (IsImplicitJoint(from.joint)) continue;
    JointRow<L>& to = pool.items[pool.count];
    joint_source_[pool.count++] = i;
    to.link_count = from.link_count;
    for (int k = 0; k < from.link_count; ++k) GatherLink(from.links[k], to.links[k]);
    to.TakeLaw(from, [&](W x) { return OfLane<L>(x, lane_); });
    if (displaces_) to.Hold();
  }
  friction_source_ = joint_source_.From(pool.count);
  GatherFrictions(frictions);
  chain_source_ = friction_source_.From(frictions.count);
}

/// Copies the friction of ball joints. Three rows form one law, except in displacement solves.
template <class W>
void LaneSolve<W>::GatherFrictions(Pool<TurnFriction<L>>& pool) noexcept {
  pool.count = 0;
  if (m_.turn_friction_count == 0 || displaces_) return;
  for (int i = 0; i < m_.joint_row_count; ++i) {
    if (m_.joint_rows[i].role != JointRole::kTurnFriction) continue;
    const HeldRow<W>* const from = work_.joints + i;
    i += 2;
    if (!(from->live[lane_] > 0) || mem_.root[from->links[0].body] != island_root_) continue;
    TurnFriction<L>& to = pool.items[pool.count];
    friction_source_[pool.count++] = i - 2;
    to.limit = OfLane<L>(from->upper, lane_);
    to.link_count = from->link_count;
    for (int k = 0; k < to.link_count; ++k) {
      for (int r = 0; r < 3; ++r) GatherLink(from[r].links[k], to.links[k], r);
    }
    to.FinishMasses();
  }
}

template <class W>
void LaneSolve<W>::Scatter() noexcept {
  const Island<L, StepPools<L>>& island = mem_.island;
  const L* l = island.m.l;
  const Pool<ContactPoint<L, 2>>& contacts = island.pools;
  for (int i = 0; i < contacts.count; ++i) {
    const int from = mem_.source[i];
    for (int k = 0; k < 3; ++k) {
      if (from < m_.slot_count) {
        SetLane(work_.contacts[from].l[k], l[0], lane_);
      } else {
        mem_.pairs[from - m_.slot_count].l[k] = l[0];
      }
      ++l;
    }
  }
  const Pool<CableRow<L>>& cables = island.pools;
  for (int i = 0; i < cables.count; ++i) {
    SetLane(work_.stiff[cable_source_[i]].l[0], *l++, lane_);
  }
  const Pool<JointRow<L>>& joints = island.pools;
  for (int i = 0; i < joints.count; ++i) {
    SetLane(work_.joints[joint_source_[i]].l[0], *l++, lane_);
  }
  const Pool<TurnFriction<L>>& frictions = island.pools;
  for (int i = 0; i < frictions.count; ++i) {
    for (int k = 0; k < 3; ++k) {
      SetLane(work_.joints[friction_source_[i] + k].l[0], *l++, lane_);
    }
  }
  const Pool<CableChain<L>>& chains = island.pools;
  for (int i = 0; i < chains.count; ++i) {
    ChainSpan<W>* const spans = work_.spans + m_.cables[chain_source_[i]].first_span;
    for (int k = 0; k < chains.items[i].rows; ++k) SetLane(spans[k].l, *l++, lane_);
  }
  for (int b = 0; b < count_; ++b) {
    const Twist<L> t = island.Load(island.m.v + kDofs * b);
    BodyWork<W>& body = work_.bodies[island.bodies[b].body];
    SetLane(body.v, t.v, lane_);
    SetLane(body.w, t.w, lane_);
  }
}

}  // namespace taut::sim
