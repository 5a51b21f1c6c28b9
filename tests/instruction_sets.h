/// Instruction sets for which the step is compiled, in order of width. A machine that lacks the
/// widest falls back to its widest.
#pragma once

#include <ostream>

#include "taut/world_batch.h"

namespace taut::test {

struct InstructionSet {
  const char* name;  ///< Name in TAUT_SIMD.
  Simd simd;
};
/// For GoogleTest
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
