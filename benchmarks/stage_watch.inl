/// The step of one instruction set with a watch; see stage_watch.h.
#include "benchmarks/stage_watch.h"
#include "sim/kernel.inl"

namespace taut::sim {

static_assert(kStages == static_cast<int>(Stage::kCount));

struct StageWatch {
  uint64_t last = 0;
  TAUT_INLINE void Begin() noexcept { last = __builtin_ia32_rdtsc(); }
  TAUT_INLINE void Mark(Stage stage) noexcept {
    const uint64_t now = __builtin_ia32_rdtsc();
    g_stage_ticks[static_cast<int>(stage)] += now - last;
    last = now;
  }
};

}  // namespace taut::sim
