/// Stiff cables: the implicit tension is the mean of the spring force over the stretch from the
/// start to the end of the step (docs/theory/cables.md, eq. 8-11). The work of this tension equals
/// the change of the spring energy, even if the cable becomes slack or taut.
///
/// Cables that would be unstable with explicit forces at this step are solved together with the
/// contacts. Soft cables are explicit, except in a step in which they become slack or taut.
#pragma once

#include "math/cable_law.h"
#include "sim/cables/cable_wheels.inl"
#include "sim/cables/cable_wrapping.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Returns the largest K of a stable explicit spring at this step [1/s^2].
template <class W>
TAUT_INLINE W SoftLimit(W h) noexcept {
  return W::Splat(kSoftSpring) / (h * h);
}

/// Computes the attachment positions at the start of the step from the poses stored by SaveStart.
template <class W>
void MeasureStart(const View& m, Scratch<W>& work) noexcept {
  const auto* const pos = reinterpret_cast<const V3<W>*>(work.start);
  const auto* const quat = reinterpret_cast<const Q4<W>*>(pos + m.body_count);
  M3<W> R = work.bodies[m.body_count].R;
  int body = m.body_count;
  for (int i = 0; i < m.spot_count; ++i) {
    const AttachmentTable& table = m.spots[i];
    if (table.body == m.body_count) {
      work.start_spots[i] = simd::Splat3<W>(table.p_P);
      continue;
    }
    if (table.body != body) R = RotationOf(quat[table.body]);
    body = table.body;
    work.start_spots[i] = pos[body] + R * simd::Splat3<W>(table.p_P);
  }
  work.start_known = true;
}

template <class W>
TAUT_INLINE W StartLength(const View& m, const Rows<W>& s, Scratch<W>& work,
                          const CableTable& cable) noexcept {
  if (!work.start_known) MeasureStart(m, work);
  const AttachmentTable* const tables = m.attachments + cable.first_attachment;
  if (cable.touch >= 0) return StartLengthOverBends(m, s, work, cable);
  if (cable.wheel_count > 0) return StartLengthOnWheels(m, s, work, cable);
  return MeasureThrough<V3<W>>(cable.attachment_count,
                               [&](int i) { return work.start_spots[tables[i].spot]; })
      .l;
}

/// Returns the lengthening rate of a cable from the velocities before the step.
template <class W>
TAUT_INLINE W RateBefore(const Scratch<W>& work, const Link<W, 1>* links, int count) noexcept {
  W rate = W::Splat(0.0);
  for (int i = 0; i < count; ++i) {
    const BodyWork<W>& body = work.bodies[links[i].body];
    rate -= Dot(links[i].lin[0], body.v0) + Dot(links[i].ang[0], body.w0);
  }
  return rate;
}

/// Sets the law of a cable over the step from its length and stretch at the middle. Extrapolation
/// from the middle gives the lengths at start and end. The extrapolation error at the start, where
/// the true length is known, also corrects the end (eq. 10).
template <class W>
TAUT_INLINE void SetCableLaw(const View& m, const Rows<W>& s, Scratch<W>& work, int c, W length,
                             W stretch, W rate, W h, W spring, W damping,
                             CableRow<W>& row) noexcept {
  const CableTable& cable = m.cables[c];
  const W half_h = W::Splat(0.5) * h, inv_half = W::Splat(1.0) / half_h;
  const W wound = s.rest_rate[c];
  const W mid = stretch + (StartLength(m, s, work, cable) - (length - half_h * rate));
  const W z = inv_half * mid;
  row.SetLaw(z - (rate - wound), z - wound, spring, half_h * damping, wound + wound);
  row.upper = W::Splat(1e300);
  if (!cable.clamped_damping) return;
  // Twice the spring part of the impulse, predicted with the rate before the step.
  const W twice = row.SpringImpulse(row.start + W::Splat(2.0) * (rate - wound));
  row.upper = Select(damping > W::Splat(0.0), twice + twice, row.upper);
}

/// Adds a stiff cable to the rows of the solver. `k`, `b`: effective stiffness and damping within a
/// step.
template <class W>
void AddStiffCable(const View& m, const Rows<W>& s, Scratch<W>& work, int c,
                   const CableWork<W>& linked, W k, W b, W length, W stretch, W h,
                   MaskOf<W> on) noexcept {
  const W zero = W::Splat(0.0);
  StiffCable<W>& row = work.stiff[work.stiff_count++];
  row.cable = c;
  row.live = Select(on, W::Splat(1.0), zero);
  row.links = linked.links;
  row.link_count = linked.link_count;
  const W rate = RateBefore(work, row.links, row.link_count);
  const W spring = W::Splat(0.25) * h * h * math::CableLaw{k}.Slope(stretch);
  SetCableLaw(m, s, work, c, length, stretch, rate, h, spring, b, row);
  row.FinishMasses();
  row.across = W::Splat(0.25) * h * h * s.stiff_k[c] / (s.stiffness[c] * length);
  row.l[0] = Select(on, Min(h * s.tension[c], row.upper), zero);
}

/// Returns the tension of a stiff cable relative to the largest stable tension (eq. 12). The
/// explicit transverse force causes the limit; along the cable, any tension is stable.
template <class W>
W ShareOfStableTension(const Rows<W>& s, const StiffCable<W>& row) noexcept {
  return Select(row.live > W::Splat(0.0), s.tension[row.cable] * row.across, W::Splat(0.0));
}

/// Sets tensions, their spring parts and angular momenta from the impulses of the solver.
template <class W>
void FinishStiffCables(const Rows<W>& s, Scratch<W>& work, double step_s) noexcept {
  const W zero = W::Splat(0.0), inv_h = W::Splat(1.0 / step_s);
  for (int i = 0; i < work.stiff_count; ++i) {
    const StiffCable<W>& row = work.stiff[i];
    const auto live = row.live > zero;
    W u = zero;
    for (int k = 0; k < row.link_count; ++k) {
      const BodyWork<W>& body = work.bodies[row.links[k].body];
      AddVelocity(row.links[k], body.v, body.w, &u);
      s.mom[row.links[k].body] += row.l[0] * row.links[k].ang[0];
    }
    const W elastic = inv_h * row.SpringImpulse(row.end - u);
    s.tension[row.cable] = Select(live, inv_h * row.l[0], s.tension[row.cable]);
    s.mean_elastic[row.cable] = Select(live, elastic, s.mean_elastic[row.cable]);
    s.mean_step[0] = Select(live, W::Splat(step_s), s.mean_step[0]);
  }
}

}  // namespace taut::sim
