/// What AArch64's compilers do not find by themselves; included by wide.h alone. Every such machine
/// has NEON, so no flags and no questions are needed. Max and Min are not here: see wide.h.
#pragma once

#include <arm_neon.h>

#include "simd/wide.h"

namespace taut::simd {

TAUT_INLINE Wide<2> Sqrt(Wide<2> a) noexcept {
  return {(Wide<2>::Vector)vsqrtq_f64((float64x2_t)a.v)};
}
/// A lane of a mask is 0 or -1: their sum is 0 for none, and it is the shortest way out of NEON.
TAUT_INLINE bool Any(Mask<2> m) noexcept { return vaddvq_s64((int64x2_t)m.v) != 0; }

}  // namespace taut::simd
