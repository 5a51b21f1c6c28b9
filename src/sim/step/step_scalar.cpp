#include "sim/step/kernel.inl"

namespace taut::sim {

const Kernel kKernelScalar = MakeKernel<simd::Wide<1>>();

}  // namespace taut::sim
