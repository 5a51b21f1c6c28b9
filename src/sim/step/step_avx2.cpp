#include "sim/step/kernel.inl"

namespace taut::sim {

const Kernel kKernelAvx2 = MakeKernel<simd::Wide<4>>();

}  // namespace taut::sim
