#include "sim/step/kernel.inl"

namespace taut::sim {

const Kernel kKernelSse2 = MakeKernel<simd::Wide<2>>();

}  // namespace taut::sim
