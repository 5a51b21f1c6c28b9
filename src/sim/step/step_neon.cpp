#include "sim/step/kernel.inl"

namespace taut::sim {

const Kernel kKernelNeon = MakeKernel<simd::Wide<2>>();

}  // namespace taut::sim
