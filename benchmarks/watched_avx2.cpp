#include "benchmarks/stage_watch.inl"

namespace taut::sim {

const Kernel kWatchedAvx2 = MakeKernel<simd::Wide<4>, StageWatch>();

}  // namespace taut::sim
