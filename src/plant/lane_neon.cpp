#include "plant/lane_kernel.inl"

namespace taut::plant {

const LaneKernel kLanesNeon = MakeLaneKernel<simd::Wide<2>>();

}  // namespace taut::plant
