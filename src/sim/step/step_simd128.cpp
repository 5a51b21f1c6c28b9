#include "sim/step/kernel.inl"

namespace taut::sim {

const Kernel kKernelSimd128 = MakeKernel<simd::Wide<2>>();

}  // namespace taut::sim
