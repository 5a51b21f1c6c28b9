#include "sim/batch/kernels.h"

namespace taut::sim {
namespace {

struct BuiltKernel {
  std::string_view name;
  Simd simd;
  const Kernel* kernel;
};

constexpr BuiltKernel kBuilt[] = {
    {"scalar", Simd::kScalar, &kKernelScalar},
#ifdef TAUT_HAS_SSE2
    {"sse2", Simd::kSse2, &kKernelSse2},
#endif
#ifdef TAUT_HAS_NEON
    {"neon", Simd::kNeon, &kKernelNeon},
#endif
#ifdef TAUT_HAS_SIMD128
    {"simd128", Simd::kSimd128, &kKernelSimd128},
#endif
#ifdef TAUT_HAS_AVX2
    {"avx2", Simd::kAvx2, &kKernelAvx2},
#endif
#ifdef TAUT_HAS_AVX512
    {"avx512", Simd::kAvx512, &kKernelAvx512},
#endif
};

/// Returns whether this machine can run an instruction set of this program.
bool RunsHere([[maybe_unused]] Simd simd) {
#ifdef TAUT_HAS_AVX512
  if (simd == Simd::kAvx512) {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
  }
#endif
#ifdef TAUT_HAS_AVX2
  if (simd == Simd::kAvx2) return __builtin_cpu_supports("avx2");
#endif
  return true;
}

}  // namespace

const Kernel* KernelOf(Simd simd) {
  for (const BuiltKernel& one : kBuilt) {
    if (one.simd == simd) return RunsHere(simd) ? one.kernel : nullptr;
  }
  return nullptr;
}

bool IsBuilt(std::string_view name) {
  for (const BuiltKernel& one : kBuilt) {
    if (one.name == name) return true;
  }
  return false;
}

}  // namespace taut::sim
