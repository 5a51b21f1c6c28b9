/// States of an implicitly integrated island: start, ends of its stages, conserved quantities
/// (docs/theory/cables.md, eq. 12e).
#pragma once

#include "sim/bodies/stage_bodies.inl"
#include "sim/data/implicit_memory.h"
#include "sim/data/island.h"
#include "sim/data/of_lane.h"
#include "sim/solve/common_turn.inl"
#include "sim/solve/implicit_island.inl"
#include "sim/solve/implicit_newton.inl"
#include "simd/vec3.h"

namespace taut::sim {

template <class W>
void ImplicitIsland<W>::LoadStart(int body, ImplicitBody<Num>& b) const noexcept {
  const auto* const mom = reinterpret_cast<const V3<W>*>(work_.start + 10 * m_.body_count);
  b.x = StartPosition(body);
  b.q = StartRotation(body);
  b.v = OfLane<Num>(work_.bodies[body].v0, lane_);
  b.w = OfLane<Num>(work_.bodies[body].w0, lane_);
  b.L = OfLane<Num>(mom[body], lane_);
}

template <class W>
void ImplicitIsland<W>::KeepMomentum() noexcept {
  const Num zero = Num::Splat(0.0), half = Num::Splat(0.5);
  if (joints_.HasSupport()) return;
  for (int i = 0; i < cables_.point_count; ++i) {
    if (mem_.points[i].body < 0) return;
  }
  for (int i = 0; i < island_.rows; ++i) {
    if (Any(!(mem_.total[i] == zero))) return;
  }
  V3<Num> missing{zero, zero, zero};
  for (int k = 0; k < count(); ++k) {
    ImplicitBody<Num>& b = mem_.body[k];
    if (!b.turns) continue;
    b.inertia = Congruence(RotationOf(b.q), b.moments);
    ImplicitBody<Num> start;
    LoadStart(island_.bodies[k].body, start);
    missing += Cross(start.x, b.mass * start.v) + start.L;
    missing += half * Cross(start.x + b.x, b.force) + b.torque;
    missing -= Cross(b.x, b.mass * b.v) + b.L;
  }
  const auto solid = [&](int k) {
    const ImplicitBody<Num>& b = mem_.body[k];
    Solid<Num> all{b.x, b.mass, b.inertia};
    if (!b.turns) all = {b.x, zero, {zero, zero, zero, zero, zero, zero}};
    return all;
  };
  const CommonTurn<Num> turn(count(), solid, missing);
  for (int k = 0; k < count(); ++k) {
    ImplicitBody<Num>& b = mem_.body[k];
    if (!b.turns) continue;
    b.v += turn.VelocityAt(b.x);
    b.L += b.inertia * turn.w;
    b.w += turn.w;
  }
}

template <class W>
void ImplicitIsland<W>::Energy(Num& kinetic, Num& elastic) const noexcept {
  const Num zero = Num::Splat(0.0), half = Num::Splat(0.5);
  kinetic = elastic = zero;
  for (int k = 0; k < count(); ++k) {
    const ImplicitBody<Num>& b = mem_.body[k];
    if (b.turns) kinetic += half * (b.mass * Dot(b.v, b.v) + Dot(b.w, b.L));
  }
  for (int c = 0; c < cables_.cable_count; ++c) {
    const ImplicitCable<Num>& cable = mem_.list[c];
    const Num s = Max(cable.l0 - cable.rest, zero);
    elastic += half * cable.k * s * s;
  }
}

template <class W>
bool ImplicitIsland<W>::Gains() const noexcept {
  constexpr double kOfKinetic = 1e-9, kOfElastic = 1e-13;
  const Num half = Num::Splat(0.5), h = Num::Splat(step_s_);
  Num kinetic, elastic, work = Num::Splat(0.0);
  Energy(kinetic, elastic);
  for (int k = 0; k < count(); ++k) {
    const ImplicitBody<Num>& b = mem_.body[k];
    if (!b.turns) continue;
    ImplicitBody<Num> start;
    LoadStart(island_.bodies[k].body, start);
    work += Dot(b.force, b.x - start.x) / h + half * Dot(b.torque, b.w + start.w);
  }
  for (int c = 0; c < cables_.cable_count; ++c) {
    work -= mem_.list[c].impulse * mem_.list[c].rate;
  }
  const Num before = kinetic_ + elastic_,
            room = Num::Splat(kOfKinetic) * kinetic_ + Num::Splat(kOfElastic) * elastic_;
  return Any((kinetic + elastic) - before > work + room);
}

template <class W>
void ImplicitIsland<W>::EndStage(double passed) noexcept {
  const Num zero = Num::Splat(0.0), half = Num::Splat(0.5), q = Num::Splat(passed - 1);
  const bool more = passed > 1;
  Num* const pushed = mem_.back;
  for (int i = 0; i < size(); ++i) pushed[i] = zero;
  if (more) AddImpulses(pushed);
  const Num* const U = mem_.U;
  for (int k = 0; k < count(); ++k) {
    ImplicitBody<Num>& b = mem_.body[k];
    const V3<Num> v{U[6 * k], U[6 * k + 1], U[6 * k + 2]};
    const V3<Num> w{U[6 * k + 3], U[6 * k + 4], U[6 * k + 5]};
    const V3<Num> v0 = b.v, L0 = b.L;
    b.v = b.ahead * v + b.behind * v0;
    b.w = b.ahead * w + b.behind * b.w;
    if (!b.turns) continue;
    b.x = b.x1;
    TurnAbout(b.q, b.half);
    NormalizeQuat(b.q);
    b.L = b.L1;
    if (!more) continue;
    // Contact impulses have ended; forces continue.
    const Num* const p = pushed + kDofs * k;
    const V3<Num> hit{p[0], p[1], p[2]}, spun{p[3], p[4], p[5]};
    b.v += q * ((b.v - v0) - (Num::Splat(1.0) / b.mass) * hit);
    b.L += q * ((b.L - L0) - spun);
    b.x += (q * stage_.h) * v;
    TurnAbout(b.q, (half * q * stage_.h) * w);
    NormalizeQuat(b.q);
  }
  joints_.EndStage(stage_, passed);
  for (int c = 0; c < cables_.cable_count; ++c) {
    ImplicitCable<Num>& cable = mem_.list[c];
    const Num way = Num::Splat(passed) * stage_.h;
    cable.impulse += way * cable.tension;
    cable.elastic_impulse += way * cable.elastic;
    cable.rest += way * cable.rate;
  }
}

}  // namespace taut::sim
