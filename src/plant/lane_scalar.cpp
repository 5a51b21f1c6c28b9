#include "plant/lane_kernel.inl"

namespace taut::plant {

const LaneKernel kLanesScalar = MakeLaneKernel<simd::Wide<1>>();

const LaneKernel& LaneKernelOf(int lanes) {
  switch (lanes) {
    case 8:
      return kLanesAvx512;
    case 4:
      return kLanesAvx2;
    case 2:
      return kLanesSse2;
    default:
      return kLanesScalar;
  }
}

}  // namespace taut::plant
