#include "benchmarks/stage_watch.inl"

namespace taut::sim {

const Kernel kWatchedScalar = MakeKernel<simd::Wide<1>, StageWatch>();

}  // namespace taut::sim
