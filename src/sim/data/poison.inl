/// NaN poisoning of memory that a step must write before it reads it, in builds without NDEBUG. Use
/// of a stale value then makes a world not finite or changes a golden hash.
#pragma once

#include "sim/data/rows.h"

namespace taut::sim {

/// Fills scratch memory, contact rows unused in the last step, and reading rows with NaN, before a
/// step and before an update of readings. Unused lanes of the last group
/// also contain a valid state (batch.cpp), which is kept. Returns whether the memory was filled.
template <class W>
bool Poison([[maybe_unused]] const View& m, [[maybe_unused]] const Rows<W>& s,
            [[maybe_unused]] const Group& g, [[maybe_unused]] Scratch<W>& work) noexcept {
#ifndef NDEBUG
  work.Fill(m, 0xff);  // NaN as double, -1 as int
  const W nan = W::Splat(__builtin_nan(""));
  const auto fill = [nan](void* row, int first, int end) {
    for (int i = first; i < end; ++i) static_cast<W*>(row)[i] = nan;
  };
  const auto forget = [&](void* row, int width) {
    for (int b = 0; b < m.body_count; ++b) {
      const int first = m.first_slot[b] + g.slots_used[b];
      fill(row, width * first, width * m.first_slot[b + 1]);
    }
    fill(row, width * (m.slot_count + g.touches_used), width * m.ContactCapacity());
  };
#define TAUT_ROW(name, type, per, role, halted, start)                \
  if (Per::per == Per::kContact) forget(s.name.data(), kWidth##type); \
  if (Role::role == Role::kSensed) fill(s.name.data(), 0, m.Count(Per::per) * kWidth##type);
  TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW
  return true;
#else
  return false;
#endif
}

}  // namespace taut::sim
