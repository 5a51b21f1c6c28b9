#include "sim/step/kernel.inl"

namespace taut::sim {

const Kernel kKernelAvx512 = MakeKernel<simd::Wide<8>>();

}  // namespace taut::sim
