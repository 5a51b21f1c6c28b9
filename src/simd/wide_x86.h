/// SSE2, AVX2 and AVX-512 instructions that x86-64 compilers do not generate from wide.h; included
/// only by wide.h.
#pragma once

#include <immintrin.h>

#include "simd/wide.h"

namespace taut::simd {

TAUT_INLINE Wide<2> Sqrt(Wide<2> a) noexcept {
  return {(Wide<2>::Vector)_mm_sqrt_pd((__m128d)a.v)};
}
TAUT_INLINE bool Any(Mask<2> m) noexcept { return _mm_movemask_pd((__m128d)m.v) != 0; }
TAUT_INLINE Wide<2> Max(Wide<2> a, Wide<2> b) noexcept {
  return {(Wide<2>::Vector)_mm_max_pd((__m128d)a.v, (__m128d)b.v)};
}
TAUT_INLINE Wide<2> Min(Wide<2> a, Wide<2> b) noexcept {
  return {(Wide<2>::Vector)_mm_min_pd((__m128d)a.v, (__m128d)b.v)};
}

#ifdef __AVX2__
TAUT_INLINE Wide<4> Sqrt(Wide<4> a) noexcept {
  return {(Wide<4>::Vector)_mm256_sqrt_pd((__m256d)a.v)};
}
TAUT_INLINE bool Any(Mask<4> m) noexcept { return _mm256_movemask_pd((__m256d)m.v) != 0; }
TAUT_INLINE Wide<4> Max(Wide<4> a, Wide<4> b) noexcept {
  return {(Wide<4>::Vector)_mm256_max_pd((__m256d)a.v, (__m256d)b.v)};
}
TAUT_INLINE Wide<4> Min(Wide<4> a, Wide<4> b) noexcept {
  return {(Wide<4>::Vector)_mm256_min_pd((__m256d)a.v, (__m256d)b.v)};
}
#endif

#ifdef __AVX512DQ__
TAUT_INLINE Wide<8> Sqrt(Wide<8> a) noexcept {
  return {(Wide<8>::Vector)_mm512_maskz_sqrt_pd(0xff, (__m512d)a.v)};
}
TAUT_INLINE bool Any(Mask<8> m) noexcept { return _mm512_movepi64_mask((__m512i)m.v) != 0; }
TAUT_INLINE Wide<8> Max(Wide<8> a, Wide<8> b) noexcept {
  return {(Wide<8>::Vector)_mm512_maskz_max_pd(0xff, (__m512d)a.v, (__m512d)b.v)};
}
TAUT_INLINE Wide<8> Min(Wide<8> a, Wide<8> b) noexcept {
  return {(Wide<8>::Vector)_mm512_maskz_min_pd(0xff, (__m512d)a.v, (__m512d)b.v)};
}
#endif

}  // namespace taut::simd
