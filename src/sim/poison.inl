/// Builds without NDEBUG fill with NaN what a step must not read before it has written it, so that
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
  const int capacity = m.ContactCapacity(W::kLanes);
  for (int i = g.contact_count; i < capacity; ++i) g.contact_ids[i] = 0xffffffffu;
  const auto fill = [nan](void* row, int first, int end) {
    for (int i = first; i < end; ++i) static_cast<W*>(row)[i] = nan;
  };
#define TAUT_ROW(name, type, per, role, halted, start)                          \
  if (Per::per == Per::kContact) {                                              \
    fill(s.name.data(), g.contact_count* kWidth##type, capacity* kWidth##type); \
  }                                                                             \
  if (Role::role == Role::kSensed) fill(s.name.data(), 0, m.Count(Per::per, 0) * kWidth##type);
  TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW
#endif
}

}  // namespace taut::sim
