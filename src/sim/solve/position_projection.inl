/// Position projection: smallest displacements that remove penetration immediately, as velocities
/// times the step, without friction and cables (docs/theory/contact.md, eq. 8). Velocities do not
/// change, only potential energy; angular momenta rotate with their bodies. Runs lane by lane,
/// because it is rarely needed.
#pragma once

#include "sim/bodies/stage_bodies.inl"
#include "sim/contacts/prepare_contact.inl"
#include "sim/contacts/slots.inl"
#include "sim/data/rows.h"
#include "sim/solve/common_turn.inl"
#include "sim/solve/gather_island.inl"
#include "sim/solve/island_solver.inl"
#include "sim/solve/lane_solve.inl"

namespace taut::sim {

template <class W>
int LaneSolve<W>::PushOut() noexcept {
  displaces_ = true;
  int linear_solves = 0;
  FindIslands([&](int body) { return IsDeep(body); });
  for (int body = 0; body < m_.body_count; ++body) {
    if (mem_.root[body] != body || !Gather(body)) continue;
    SolverWork work{0, settings_.max_linear_solves};
    mem_.island.Judge();
    SolveInStages(mem_.island, Target{settings_.tolerance_m_per_s}, work);
    linear_solves += work.linear_solves;
    V3<L> gained{L::Splat(0.0), L::Splat(0.0), L::Splat(0.0)};
    for (int b = 0; b < count_; ++b) gained += Displace(b);
    if (IsAlone()) KeepMomentum(gained);
  }
  LookAgain(m_, s_, work_, lane_);
  return linear_solves;
}

template <class W>
bool LaneSolve<W>::IsDeep(int body) const noexcept {
  bool deep = false;
  for (int k = 0; k < work_.contact_count[body]; ++k) {
    deep = deep || work_.contacts[m_.first_slot[body] + k].deep[lane_] < 0;
  }
  for (int i = 0; i < work_.touch_count[lane_]; ++i) {
    const Contact<L, 2>& c = mem_.pairs[i];
    deep = deep || (c.links[0].body == body && Any(c.deep < L::Splat(0.0)));
  }
  return deep;
}

template <class W>
void LaneSolve<W>::Displacing(ContactPoint<L, 2>& c, double deep, double gap) const noexcept {
  const L zero = L::Splat(0.0);
  c.bias[0] = L::Splat(deep < 0 ? deep : gap < 0 ? 0 : gap) / h_;
  c.bias[1] = c.bias[2] = c.mu = zero;
  for (L& l : c.l) l = zero;
}

/// Returns whether only contacts and joints between moving bodies of the island displaced the
/// island.
template <class W>
bool LaneSolve<W>::IsAlone() const noexcept {
  const Pool<ContactPoint<L, 2>>& contacts = mem_.island.pools;
  bool alone = true;
  for (int i = 0; i < contacts.count; ++i) {
    const ContactPoint<L, 2>& c = contacts.items[i];
    const bool both = c.link_count == 2 && Moves(Body(c, 0)) && Moves(Body(c, 1));
    alone = alone && (both || !Any(mem_.island.m.l[3 * i] > L::Splat(0.0)));
  }
  const Pool<JointRow<L>>& joints = mem_.island.pools;
  for (int i = 0; i < joints.count; ++i) {
    const JointRow<L>& row = joints.items[i];
    alone = alone && row.link_count == 2 && Moves(mem_.island.bodies[row.links[1].body].body);
  }
  return alone;
}

/// Returns the angular momentum that contacts with the world, stiff cables and joints will still
/// add to a body in this step.
template <class W>
V3<simd::Lane<W>> LaneSolve<W>::Pending(int body) const noexcept {
  V3<L> sum{L::Splat(0.0), L::Splat(0.0), L::Splat(0.0)};
  for (int k = 0; k < work_.contact_count[body]; ++k) {
    const Contact<W, 1>& c = work_.contacts[m_.first_slot[body] + k];
    if (c.live[lane_] > 0) sum += OfLane<L>(Cross(c.arm[0], ImpulseOf(c)), lane_);
  }
  for (int i = 0; i < work_.stiff_count; ++i) {
    const StiffCable<W>& cable = work_.stiff[i];
    if (!(cable.live[lane_] > 0)) continue;
    for (int k = 0; k < cable.link_count; ++k) {
      if (cable.links[k].body != body) continue;
      sum += OfLane<L>(cable.l[0] * cable.links[k].ang[0], lane_);
    }
  }
  for (int c = 0; m_.chain_count > 0 && c < m_.cable_count; ++c) {
    const CableTable& cable = m_.cables[c];
    const RowLink<W>* const links = work_.chain_links + cable.first_link;
    for (int k = 0; cable.span_count > 0 && k < work_.chain_link_count[c]; ++k) {
      if (links[k].body != body) continue;
      sum += OfLane<L>(work_.spans[cable.first_span + links[k].row].l * links[k].ang[0], lane_);
    }
  }
  for (int i = 0; i < m_.joint_row_count; ++i) {
    const HeldRow<W>& row = work_.joints[i];
    if (!(row.live[lane_] > 0)) continue;
    for (int k = 0; k < row.link_count; ++k) {
      if (row.links[k].body == body) sum += OfLane<L>(row.l[0] * row.links[k].ang[0], lane_);
    }
  }
  return sum;
}

/// Displaces a body of the island; its angular momentum rotates with it. Returns the resulting
/// change of the total angular momentum.
template <class W>
V3<simd::Lane<W>> LaneSolve<W>::Displace(int number) noexcept {
  const Unknown<L>& unknown = mem_.island.bodies[number];
  const int body = unknown.body;
  BodyWork<W>& work = work_.bodies[body];
  const Twist<L> t = mem_.island.Load(mem_.island.m.v + kDofs * number);
  const V3<L> dx = h_ * t.v;
  SetLane(s_.pos[body], OfLane<L>(s_.pos[body], lane_) + dx, lane_);
  Q4<L> q = OfLane<L>(s_.quat[body], lane_);
  TurnAbout(q, (L::Splat(0.5) * h_) * t.w);
  NormalizeQuat(q);
  SetLane(s_.quat[body], q, lane_);
  if (work_.implicit.any) DisplaceEnd(body, dx, (L::Splat(0.5) * h_) * t.w);
  const M3<L> before{OfLane<L>(work.R.r0, lane_), OfLane<L>(work.R.r1, lane_),
                     OfLane<L>(work.R.r2, lane_)};
  const M3<L> R = RotationOf(q);
  SetLane(work.R.r0, R.r0, lane_);
  SetLane(work.R.r1, R.r1, lane_);
  SetLane(work.R.r2, R.r2, lane_);
  const V3<L> pending = Pending(body);
  const V3<L> spin = OfLane<L>(s_.mom[body], lane_) + pending;
  const V3<L> turned = R * TransposeTimes(before, spin);
  SetLane(s_.mom[body], turned - pending, lane_);
  return turned - spin + Cross(dx, unknown.mass * OfLane<L>(work.v, lane_));
}

/// Conserves the angular momentum of an isolated island: a common rotation compensates for the
/// change.
template <class W>
void LaneSolve<W>::KeepMomentum(const V3<L>& gained) noexcept {
  const auto solid = [&](int b) {
    const Unknown<L>& body = mem_.island.bodies[b];
    return Solid<L>{OfLane<L>(s_.pos[body.body], lane_), body.mass, body.inertia};
  };
  const CommonTurn<L> turn(count_, solid, -gained);
  for (int b = 0; b < count_; ++b) {
    const Unknown<L>& body = mem_.island.bodies[b];
    V3<W>& v = work_.bodies[body.body].v;
    SetLane(v, OfLane<L>(v, lane_) + turn.VelocityAt(solid(b).x), lane_);
    V3<W>& momentum = s_.mom[body.body];
    SetLane(momentum, OfLane<L>(momentum, lane_) + body.inertia * turn.w, lane_);
  }
}

}  // namespace taut::sim
