#include "benchmarks/stage_watch.h"

#include "sim/batch_impl.h"

namespace taut {

namespace sim {
std::uint64_t g_stage_ticks[kStages] = {};
}

void BatchInside::Watch(Batch& batch) {
  switch (batch.lanes()) {
    case 8:
      batch.impl_->kernel = &sim::kWatchedAvx512;
      break;
    case 4:
      batch.impl_->kernel = &sim::kWatchedAvx2;
      break;
    case 2:
      batch.impl_->kernel = &sim::kWatchedSse2;
      break;
    default:
      batch.impl_->kernel = &sim::kWatchedScalar;
  }
}

}  // namespace taut
