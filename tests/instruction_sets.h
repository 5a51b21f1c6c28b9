/// The instruction sets that the step is compiled for, in rising width. Of these, a machine may
/// lack the widest: it falls back to what it has.
#pragma once

#include <ostream>

#include "taut/batch.h"

namespace taut::test {

struct InstructionSet {
  const char* name;  ///< As TAUT_SIMD calls it.
  Simd simd;
};
/// For GoogleTest.
inline void PrintTo(const InstructionSet& set, std::ostream* out) { *out << set.name; }

inline constexpr InstructionSet kInstructionSets[] = {
    {"scalar", Simd::kScalar},
#ifdef TAUT_HAS_NEON
    {"neon", Simd::kNeon},
#endif
#ifdef TAUT_HAS_SIMD128
    {"simd128", Simd::kSimd128},
#endif
#ifdef TAUT_HAS_SSE2
    {"sse2", Simd::kSse2},
#endif
#ifdef TAUT_HAS_AVX2
    {"avx2", Simd::kAvx2},
#endif
#ifdef TAUT_HAS_AVX512
    {"avx512", Simd::kAvx512},
#endif
};

}  // namespace taut::test
