#include "sim/batch/kernels.h"

#include <algorithm>
#include <iterator>

namespace taut::sim {
namespace {

constexpr std::string_view kBuilt[] = {
    "scalar",
#ifdef TAUT_HAS_SSE2
    "sse2",
#endif
#ifdef TAUT_HAS_NEON
    "neon",
#endif
#ifdef TAUT_HAS_SIMD128
    "simd128",
#endif
#ifdef TAUT_HAS_AVX2
    "avx2",
#endif
#ifdef TAUT_HAS_AVX512
    "avx512",
#endif
};

}  // namespace

const Kernel* KernelOf(Simd simd) {
  switch (simd) {
#ifdef TAUT_HAS_AVX512
    case Simd::kAvx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                     __builtin_cpu_supports("avx512vl")
                 ? &kKernelAvx512
                 : nullptr;
#endif
#ifdef TAUT_HAS_AVX2
    case Simd::kAvx2:
      return __builtin_cpu_supports("avx2") ? &kKernelAvx2 : nullptr;
#endif
#ifdef TAUT_HAS_SSE2
    case Simd::kSse2:
      return &kKernelSse2;
#endif
#ifdef TAUT_HAS_NEON
    case Simd::kNeon:
      return &kKernelNeon;
#endif
#ifdef TAUT_HAS_SIMD128
    case Simd::kSimd128:
      return &kKernelSimd128;
#endif
    case Simd::kScalar:
      return &kKernelScalar;
    default:
      return nullptr;
  }
}

bool IsBuilt(std::string_view name) { return std::ranges::find(kBuilt, name) != std::end(kBuilt); }

}  // namespace taut::sim
