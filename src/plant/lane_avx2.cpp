#include "plant/lane_kernel.inl"

namespace taut::plant {

const LaneKernel kLanesAvx2 = MakeLaneKernel<simd::Wide<4>>();

}  // namespace taut::plant
