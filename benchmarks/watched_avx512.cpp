#include "benchmarks/stage_watch.inl"

namespace taut::sim {

const Kernel kWatchedAvx512 = MakeKernel<simd::Wide<8>, StageWatch>();

}  // namespace taut::sim
