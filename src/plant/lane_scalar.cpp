#include "plant/lane_kernel.inl"

namespace taut::plant {

const LaneKernel kLanesScalar = MakeLaneKernel<simd::Wide<1>>();

const LaneKernel& LaneKernelOf(int lanes) {
  switch (lanes) {
#ifdef TAUT_HAS_AVX512
    case 8:
      return kLanesAvx512;
#endif
#ifdef TAUT_HAS_AVX2
    case 4:
      return kLanesAvx2;
#endif
#ifdef TAUT_HAS_SSE2
    case 2:
      return kLanesSse2;
#endif
#ifdef TAUT_HAS_NEON
    case 2:
      return kLanesNeon;
#endif
#ifdef TAUT_HAS_SIMD128
    case 2:
      return kLanesSimd128;
#endif
    default:
      return kLanesScalar;
  }
}

}  // namespace taut::plant
