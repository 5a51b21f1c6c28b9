#include "plant/lane_kernel.inl"

namespace taut::plant {

const LaneKernel kLanesAvx512 = MakeLaneKernel<simd::Wide<8>>();

}  // namespace taut::plant
