#include "benchmarks/stage_watch.h"

namespace taut {

namespace sim {
std::uint64_t g_stage_ticks[kStages] = {};
}

void BatchInside::Watch(WorldBatch& batch) {
  switch (batch.lanes()) {
#ifdef TAUT_HAS_AVX512
    case 8:
      batch.impl_->kernel = &sim::kWatchedAvx512;
      break;
#endif
#ifdef TAUT_HAS_AVX2
    case 4:
      batch.impl_->kernel = &sim::kWatchedAvx2;
      break;
#endif
#ifdef TAUT_HAS_SSE2
    case 2:
      batch.impl_->kernel = &sim::kWatchedSse2;
      break;
#endif
#ifdef TAUT_HAS_NEON
    case 2:
      batch.impl_->kernel = &sim::kWatchedNeon;
      break;
#endif
    default:
      batch.impl_->kernel = &sim::kWatchedScalar;
  }
}

}  // namespace taut
