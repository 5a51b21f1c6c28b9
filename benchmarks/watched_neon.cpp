#include "benchmarks/stage_watch.inl"

namespace taut::sim {

const Kernel kWatchedNeon = MakeKernel<simd::Wide<2>, StageWatch>();

}  // namespace taut::sim
