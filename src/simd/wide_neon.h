/// NEON instructions that AArch64 compilers do not generate from wide.h; included only by wide.h.
/// Every AArch64 machine has NEON, so neither flags nor checks are needed. Max and Min are not
/// here; wide.h explains why.
#pragma once

#include <arm_neon.h>

#include "simd/wide.h"

namespace taut::simd {

TAUT_INLINE Wide<2> Sqrt(Wide<2> a) noexcept {
  return {(Wide<2>::Vector)vsqrtq_f64((float64x2_t)a.v)};
}
/// A lane of a mask is 0 or -1, so the sum is 0 if no lane is set. This is the shortest path from
/// NEON to a scalar register.
TAUT_INLINE bool Any(Mask<2> m) noexcept { return vaddvq_s64((int64x2_t)m.v) != 0; }

}  // namespace taut::simd
