/// Stage: what can be seen of the cables.

namespace taut::sim {

/// One cable of the stage below; `ends` is room for its attachments: known to be two, they stay in
/// registers.
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

/// Stage: what sensors see of the cables at the end of a step.
///   reads   pos, bodies[] (of the current state)     writes  sense_*
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
}

}  // namespace taut::sim
