#include "plant/lane_kernel.inl"

namespace taut::plant {

const LaneKernel kLanesSimd128 = MakeLaneKernel<simd::Wide<2>>();

}  // namespace taut::plant
