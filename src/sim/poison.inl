/// Builds with assertions fill with NaN what a step must not read before it has written it, so that
/// a stale value shows as a world that is not finite or as another golden hash.

namespace taut::sim {

/// Called before a step and before sensing. What it fills: scratch, rows of contacts that the last
/// step did not have, and what sensing will write. The lanes behind the last world are worlds, too,
/// and keep their values.
template <class W>
void Poison([[maybe_unused]] const View& m, [[maybe_unused]] const Rows<W>& s,
            [[maybe_unused]] const Group& g, [[maybe_unused]] Scratch<W>& work) noexcept {
#ifndef NDEBUG
  work.Fill(0xff);  // a NaN as double, -1 as int
  const W nan = W::Splat(__builtin_nan(""));
  const V3<W> nan3{nan, nan, nan};
  const auto forget = [&](int i) {
    s.contact_force[i] = s.contact_arm[i] = s.contact_normal[i] = nan3;
    s.contact_key[i] = s.contact_slip[i] = s.contact_bounce[i] = s.contact_gap[i] = nan;
  };
  for (int b = 0; b < m.body_count; ++b) {
    for (int i = m.first_slot[b] + g.slots_used[b]; i < m.first_slot[b + 1]; ++i) forget(i);
  }
  for (int i = g.touches_used; i < m.pair_capacity; ++i) forget(m.slot_count + i);
  for (int c = 0; c < m.cable_count; ++c) {
    s.sense_length[c] = s.sense_rate[c] = s.sense_tension[c] = s.sense_elastic[c] = nan;
  }
#endif
}

}  // namespace taut::sim
