#include "benchmarks/stage_watch.h"

#include "base/assert.h"

namespace taut {

namespace sim {
std::uint64_t g_stage_ticks[kStages] = {};

namespace {
const Kernel* WatchedKernel(int lanes) {
  switch (lanes) {
#ifdef TAUT_HAS_AVX512
    case 8:
      return &kWatchedAvx512;
#endif
#ifdef TAUT_HAS_AVX2
    case 4:
      return &kWatchedAvx2;
#endif
#ifdef TAUT_HAS_SSE2
    case 2:
      return &kWatchedSse2;
#endif
#ifdef TAUT_HAS_NEON
    case 2:
      return &kWatchedNeon;
#endif
    case 1:
      return &kWatchedScalar;
    default:
      return nullptr;
  }
}
}  // namespace

bool HasWatch(int lanes) { return WatchedKernel(lanes) != nullptr; }
}  // namespace sim

void BatchInside::Watch(WorldBatch& batch) {
  TAUT_ASSERT(sim::HasWatch(batch.lanes()));
  batch.impl_->kernel = sim::WatchedKernel(batch.lanes());
}

}  // namespace taut
