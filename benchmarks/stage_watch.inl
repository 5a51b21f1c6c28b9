/// The step of one instruction set with a watch; see stage_watch.h.
#pragma once

#include <time.h>

#include "benchmarks/stage_watch.h"
#include "sim/step/kernel.inl"

namespace taut::sim {

static_assert(kStages == static_cast<int>(Stage::kCount));

/// Returns a counter with a constant rate, independent of the processor's clock frequency.
TAUT_INLINE uint64_t Ticks() noexcept {
#if defined(__x86_64__)
  return __builtin_ia32_rdtsc();
#elif defined(__aarch64__)
  uint64_t ticks;
  __asm__ volatile("mrs %0, cntvct_el0" : "=r"(ticks));
  return ticks;
#else
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<uint64_t>(now.tv_sec) * 1000000000u + static_cast<uint64_t>(now.tv_nsec);
#endif
}

struct StageWatch {
  uint64_t last = 0;
  TAUT_INLINE void Begin() noexcept { last = Ticks(); }
  TAUT_INLINE void Mark(Stage stage) noexcept {
    const uint64_t now = Ticks();
    g_stage_ticks[static_cast<int>(stage)] += now - last;
    last = now;
  }
};

}  // namespace taut::sim
