/// Evaluation of friction laws with more than two coefficients per pair (friction.h), before the
/// contact equations are set up. Converts between SIMD numbers and scalar code. The functions are
/// not inlined, so that they cost no registers in models without such laws.
#pragma once

#include "sim/contacts/contact_friction.h"
#include "sim/data/rows.h"

namespace taut::sim {

template <class Num>
TAUT_INLINE void Take(const V3<Num>& from, int lane, double out[3]) noexcept {
  out[0] = from.x[lane], out[1] = from.y[lane], out[2] = from.z[lane];
}
template <class Num>
TAUT_INLINE void Put(const double from[3], int lane, V3<Num>& out) noexcept {
  out.x.Set(lane, from[0]), out.y.Set(lane, from[1]), out.z.Set(lane, from[2]);
}
/// Adds sign (v + w x arm) to `out`, in one lane.
template <class W>
TAUT_INLINE void AddPointVelocity(const V3<W>& v, const V3<W>& w, int lane, const double arm[3],
                                  double sign, double out[3]) noexcept {
  double u[3], turn[3];
  Take(v, lane, u), Take(w, lane, turn);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] += sign * (u[i] + (turn[j] * arm[k] - turn[k] * arm[j]));
  }
}

/// Computes coefficients and directions of the contact `c` of one lane. `at`: lane of the contact
/// in `Num`, or 0 if `Num` has one lane. `bodies`: bodies of its links.
template <class W, class Num, int kLinks>
[[gnu::noinline]] void AskFriction(const View& m, const Rows<W>& s, const Group& g,
                                   const Scratch<W>& work, const int (&bodies)[kLinks],
                                   const ContactMemory<Num>& memory, int lane, int at,
                                   Contact<Num, kLinks>& c) noexcept {
  SlidingContact asked{};
  asked.key = c.key[at];
  asked.world = g.first_world + lane;
  asked.time_s = s.time[0][lane];
  asked.b_moves = kLinks == 2;
  for (int k = 0; k < kLinks; ++k) {
    const BodyWork<W>& body = work.bodies[bodies[k]];
    const double sign = k == 0 ? 1.0 : -1.0;
    double arm[3];
    Take(c.arm[k], at, arm);
    AddPointVelocity(body.v_mid, body.w_mid, lane, arm, sign, asked.slip);
    AddPointVelocity(body.v0, body.w0, lane, arm, sign, asked.before);
    AddPointVelocity(body.v, body.w, lane, arm, sign, asked.free);
    double* const turn = k == 0 ? asked.turn_a : asked.turn_b;
    Take(body.R.r0, lane, turn), Take(body.R.r1, lane, turn + 3), Take(body.R.r2, lane, turn + 6);
    if (k > 0) continue;
    Take(s.pos[bodies[0]], lane, asked.point);
    for (int i = 0; i < 3; ++i) asked.point[i] += arm[i];
  }
  Take(c.links[0].lin[0], at, asked.normal);
  Take(memory.force, at, asked.force);
  FrictionOf(m, asked);
  // A NaN coefficient would have no effect, since it acts like a cone without limit.
  if (asked.lost) s.mom[bodies[0]].x.Set(lane, __builtin_nan(""));
  c.static_friction.Set(at, asked.static_friction);
  c.kinetic_friction.Set(at, asked.kinetic_friction);
  if (!asked.directed) return;
  c.directed = true;
  c.upright = false;
  c.frame.Set(at, kFirstDirectedFrame + asked.key);
  Put(asked.along, at, c.links[0].lin[1]);
  Put(asked.across, at, c.links[0].lin[2]);
}

/// Evaluates a contact with the world in all lanes that have it.
template <class W>
[[gnu::noinline]] void AskFrictions(const View& m, const Rows<W>& s, const Group& g,
                                    const Scratch<W>& work, int body,
                                    const ContactMemory<W>& memory, Contact<W, 1>& c) noexcept {
  for (int lane = 0; lane < W::kLanes; ++lane) {
    if (c.live[lane] > 0) AskFriction(m, s, g, work, {body}, memory, lane, lane, c);
  }
}

/// Corrects the inverse masses; `ContactPoint::FinishMasses` assumes tangents of length 1. Lanes
/// without directions keep their bits.
template <class Num, int kLinks>
[[gnu::noinline]] void FinishDirected(Contact<Num, kLinks>& c) noexcept {
  const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
  const auto directed = !(c.frame < Num::Splat(kFirstDirectedFrame));
  const V3<Num>* const d = c.links[0].lin;
  const Num long1 = Select(directed, Dot(d[1], d[1]), one);
  const Num long2 = Select(directed, Dot(d[2], d[2]), one);
  for (int i = 0; i < c.link_count; ++i) {
    c.w11 += c.links[i].inv_mass * (long1 - one);
    c.w22 += c.links[i].inv_mass * (long2 - one);
  }
  c.wt = c.one_direction ? c.w11 : Max(c.w11, c.w22) + Abs(c.w12);
  c.inv_wt = one / c.wt;
  // The impulses of the law are those along the tangents, divided by the lengths of the tangents.
  c.l[1] = Select(long1 > zero, c.l[1] / Select(long1 > zero, long1, one), zero);
  c.l[2] = Select(long2 > zero, c.l[2] / Select(long2 > zero, long2, one), zero);
}

}  // namespace taut::sim
