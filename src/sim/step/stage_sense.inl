/// Stage: cable readings.
#pragma once

#include "sim/cables/cable_chains.inl"
#include "sim/cables/stage_cables.inl"
#include "sim/cables/stiff_cables.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Computes the readings of one cable at the end of the step. `ends`: buffer for its attachments.
/// With a compile-time number of two attachments, the buffer stays in registers.
template <bool kTwo, class W>
TAUT_INLINE void SenseCable(const View& m, const Rows<W>& s, Scratch<W>& work, int c,
                            int attachment_count, AttachmentWork<W>* ends) noexcept {
  const auto [l, dl] = MeasureCable<kTwo>(m, s, m.cables[c], attachment_count, work, ends);
  const CableForce<W> f =
      TensionOf(s.stiffness[c], s.damping[c], l, dl, s.rest[c], m.cables[c].clamped_damping);
  s.sense_length[c] = l;
  s.sense_rate[c] = dl;
  s.sense_tension[c] = f.tension;
  s.sense_elastic[c] = f.elastic;
}

/// Replaces the forces of stiff cables by their averages over the last step (docs/theory/cables.md,
/// eq. 8). Instantaneous forces may alternate between zero and twice the average: the implicit
/// midpoint rule conserves the energy of vibrations shorter than the step, and only their mean acts
/// on bodies.
template <class W>
[[gnu::noinline]] void SenseMeans(const View& m, const Rows<W>& s) noexcept {
  const auto known = (s.mean_step[0] > W::Splat(0.0)) & (s.mean_step[0] == s.last_step[0]);
  if (!Any(known)) return;
  const W limit = SoftLimit(Select(known, s.mean_step[0], W::Splat(1.0)));
  for (int c = 0; c < m.cable_count; ++c) {
    if (m.cables[c].span_count > 0) continue;
    const auto mean = known & (s.stiff_k[c] > limit);
    s.sense_tension[c] = Select(mean, s.tension[c], s.sense_tension[c]);
    s.sense_elastic[c] = Select(mean, s.mean_elastic[c], s.sense_elastic[c]);
  }
}

/// Stage: lengths, rates and forces of cables at the end of the step.
///   reads   pos, bodies[] (of the current state), tension, mean_*     writes  sense_*
template <class W>
void StageSense(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept {
  for (int c = 0; c < m.cable_count; ++c) {
    const int count = m.cables[c].attachment_count;
    if (count == 2 && m.cables[c].touch < 0) {
      AttachmentWork<W> ends[2];
      SenseCable<true>(m, s, work, c, 2, ends);
    } else {
      SenseCable<false>(m, s, work, c, count, work.attachments);
      if (m.cables[c].span_count > 0) SenseChain(m, s, work, c);
    }
  }
  SenseMeans(m, s);
}

}  // namespace taut::sim
