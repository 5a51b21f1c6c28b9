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
  const int capacity = static_cast<int>(m.first_pair_id) + W::kLanes * m.pair_capacity;
  for (int i = g.contact_count; i < capacity; ++i) {
    g.contact_ids[i] = 0xffffffffu;
    s.cache_force[i] = s.cache_arm[i] = s.cache_normal[i] = nan3;
    s.cache_slip[i] = s.cache_bounce[i] = s.cache_live[i] = s.cache_gap[i] = nan;
  }
  for (int c = 0; c < m.cable_count; ++c) {
    s.sense_length[c] = s.sense_rate[c] = s.sense_tension[c] = s.sense_elastic[c] = nan;
  }
#endif
}

}  // namespace taut::sim
