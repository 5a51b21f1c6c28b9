/// Initialization of a contact for a step: directions, inverse masses, biases, warm start
/// (docs/theory/contact.md, sections 1 to 3).
#pragma once

#include "math/scalar.h"
#include "sim/constraint/links.h"
#include "sim/contacts/contact_friction.h"
#include "sim/contacts/friction.inl"
#include "sim/data/contacts.h"
#include "sim/data/rows.h"
#include "simd/vec3.h"

namespace taut::sim {

/// Fraction of its speed at which a penetrating contact may separate.
inline constexpr double kPushOutShare = 1e-3;
template <class Num>
TAUT_INLINE V3<Num> PointVelocity(const V3<Num>& v, const V3<Num>& w, const V3<Num>& arm) noexcept {
  return v + Cross(w, arm);
}

/// Computes two unit tangents. With one friction direction, the first tangent is along the sliding
/// velocity without contact, as in Bullet. Tangents from a plane or friction.inl (frame >= 0)
/// remain.
template <class Num, int kLinks>
TAUT_INLINE void MakeTangents(Contact<Num, kLinks>& c, const V3<Num>& velocity) noexcept {
  const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
  V3<Num>* const d = c.links[0].lin;
  // Start from an axis of W that is not along the normal.
  const auto steep = Abs(d[0].x) < Num::Splat(0.6);
  V3<Num> t = Select3(steep, V3<Num>{one, zero, zero}, V3<Num>{zero, one, zero});
  t -= Dot(t, d[0]) * d[0];
  if (c.one_direction) {
    const V3<Num> slide = velocity - Dot(velocity, d[0]) * d[0];
    t = Select3(Dot(slide, slide) > Num::Splat(1e-20), slide, t);
  }
  const V3<Num> t1 = (one / Sqrt(Dot(t, t))) * t;
  const auto own = c.frame < zero;
  d[1] = Select3(own, t1, d[1]);
  d[2] = Select3(own, Cross(d[0], t1), d[2]);
}

/// Computes lever arms and inverse masses of a link with known directions.
template <class Num>
TAUT_INLINE void FinishLink(Link<Num, 3>& link, int body, Num inv_mass, const S3<Num>& inv_inertia,
                            const V3<Num>& arm) noexcept {
  link.body = body;
  link.inv_mass = inv_mass;
  for (int r = 0; r < 3; ++r) {
    link.ang[r] = Cross(arm, link.lin[r]);
    link.turn[r] = inv_inertia * link.ang[r];
  }
}

/// Like FinishLink for the directions z, x, y; the bits are the same except for signs of zeros.
template <class Num>
TAUT_INLINE void FinishUprightLink(Link<Num, 3>& link, int body, Num inv_mass, const S3<Num>& i,
                                   const V3<Num>& arm) noexcept {
  const Num zero = Num::Splat(0.0);
  link.body = body;
  link.inv_mass = inv_mass;
  link.ang[0] = {arm.y, -arm.x, zero};
  link.ang[1] = {zero, arm.z, -arm.y};
  link.ang[2] = {-arm.z, zero, arm.x};
  link.turn[0] = {i.xx * arm.y - i.xy * arm.x, i.xy * arm.y - i.yy * arm.x,
                  i.xz * arm.y - i.yz * arm.x};
  link.turn[1] = {i.xy * arm.z - i.xz * arm.y, i.yy * arm.z - i.yz * arm.y,
                  i.yz * arm.z - i.zz * arm.y};
  link.turn[2] = {i.xz * arm.x - i.xx * arm.z, i.yz * arm.x - i.xy * arm.z,
                  i.zz * arm.x - i.xz * arm.z};
}

/// Returns the velocity along one direction of a contact.
template <class Num, int kLinks>
TAUT_INLINE Num RowVelocity(const Contact<Num, kLinks>& c, int row, const V3<Num>& va,
                            const V3<Num>& wa, const V3<Num>& vb, const V3<Num>& wb) noexcept {
  Num u = Dot(c.links[0].lin[row], va) + Dot(c.links[0].ang[row], wa);
  if (kLinks == 2) {
    const Link<Num, 3>& other = c.links[kLinks - 1];
    u += Dot(other.lin[row], vb) + Dot(other.ang[row], wb);
  }
  return u;
}

/// Completes a detected contact: directions, links, biases, coefficients, and the warm start from
/// `memory`. `a`, `b`: its bodies, with their numbers and inverse masses; `b` only with two links.
template <class Num, int kLinks>
TAUT_INLINE void PrepareContact(Contact<Num, kLinks>& c, const ContactMemory<Num>& memory,
                                const BodyWork<Num>& a, int body_a, Num inv_mass_a,
                                const BodyWork<Num>& b, int body_b, Num inv_mass_b,
                                Num friction_scale, double step_s) noexcept {
  constexpr bool kPair = kLinks == 2;
  const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
  const Num h = Num::Splat(step_s), inv_h = Num::Splat(1.0 / step_s);
  if (kPair || Any(c.frame < zero)) {
    V3<Num> free = PointVelocity(a.v, a.w, c.arm[0]);
    if (kPair) free -= PointVelocity(b.v, b.w, c.arm[kLinks - 1]);
    MakeTangents(c, free);
  }
  c.link_count = kLinks;
  if (!kPair && c.upright) {
    FinishUprightLink(c.links[0], body_a, inv_mass_a, a.inv_inertia, c.arm[0]);
  } else {
    FinishLink(c.links[0], body_a, inv_mass_a, a.inv_inertia, c.arm[0]);
  }
  if (kPair) {
    Link<Num, 3>& other = c.links[kLinks - 1];
    for (int r = 0; r < 3; ++r) other.lin[r] = -c.links[0].lin[r];
    FinishLink(other, body_b, inv_mass_b, b.inv_inertia, c.arm[kLinks - 1]);
  }
  c.FinishMasses();

  // An approaching contact may at most close. A penetrating contact separates no faster than the
  // forces of this step can stop again, plus a thousandth of its speed, so that no body flies off.
  // Position projection (solve/position_projection.inl) removes the remaining penetration.
  const Num before = c.before = RowVelocity(c, 0, a.v0, a.w0, b.v0, b.w0);
  const Num change = before - RowVelocity(c, 0, a.v, a.w, b.v, b.w), kick = Max(change, zero);
  const Num slowly = Num::Splat(kPushOutShare) * Abs(before);
  c.bias[0] = Max(c.gap * inv_h, zero - (Num::Splat(0.5) * kick + slowly));
  c.lands = Select(before < -Abs(change), one, zero);
  c.deep = Select((c.live > zero) & (c.gap < zero), Min(c.gap - h * c.bias[0], zero), zero);
  c.bias[1] = c.bias[2] = zero;
  c.slip = zero;
  c.mu = c.kinetic_friction;
  const auto breaks_away = c.static_friction > c.kinetic_friction;
  if (Any(breaks_away)) {
    const Num u1 = RowVelocity(c, 1, a.v0, a.w0, b.v0, b.w0);
    const Num u2 = RowVelocity(c, 2, a.v0, a.w0, b.v0, b.w0);
    const auto moving = u1 * u1 + u2 * u2 > Num::Splat(kSlidingMPerS * kSlidingMPerS);
    const Num slip = Select(memory.slip < zero, Select(moving, one, zero), memory.slip);
    c.slip = Select(breaks_away, slip, zero);
    c.mu = Select(c.slip > zero, c.kinetic_friction, c.static_friction);
  }
  c.mu = friction_scale * c.mu;
  c.l[0] = Max(h * Dot(memory.force, c.links[0].lin[0]), zero) * c.live;
  c.l[1] = h * Dot(memory.force, c.links[0].lin[1]) * c.live;
  c.l[2] = c.one_direction ? zero : h * Dot(memory.force, c.links[0].lin[2]) * c.live;
  if (c.directed) FinishDirected(c);
}

/// Determines whether a contact slid in this step; this selects its coefficient in the next step.
/// `u`: velocities of the contact.
template <class Num, int kLinks>
TAUT_INLINE void JudgeSlip(Contact<Num, kLinks>& c, const Num* u) noexcept {
  const Num u1 = u[1] + c.bias[1], u2 = u[2] + c.bias[2];
  const auto slides = u1 * u1 + u2 * u2 > Num::Splat(kSlidingMPerS * kSlidingMPerS);
  const Num slip = Select(slides, Num::Splat(1.0), Num::Splat(0.0));
  c.slip = Select(c.static_friction > c.kinetic_friction, slip, c.slip);
}

/// Returns the impulse of a contact in W.
template <class Num, int kLinks>
TAUT_INLINE V3<Num> ImpulseOf(const Contact<Num, kLinks>& c) noexcept {
  const V3<Num>* const d = c.links[0].lin;
  return c.l[0] * d[0] + c.l[1] * d[1] + c.l[2] * d[2];
}

}  // namespace taut::sim
