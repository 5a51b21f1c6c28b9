/// SIMD instructions that the WebAssembly compiler does not generate from wide.h; included only by
/// wide.h. `pmax` and `pmin` are the x86-64 instructions with swapped operands: pmax(x, y) = x < y
/// ? y : x.
#pragma once

#include <wasm_simd128.h>

#include "simd/wide.h"

namespace taut::simd {

TAUT_INLINE Wide<2> Sqrt(Wide<2> a) noexcept {
  return {(Wide<2>::Vector)wasm_f64x2_sqrt((v128_t)a.v)};
}
TAUT_INLINE bool Any(Mask<2> m) noexcept { return wasm_v128_any_true((v128_t)m.v); }
TAUT_INLINE Wide<2> Max(Wide<2> a, Wide<2> b) noexcept {
  return {(Wide<2>::Vector)wasm_f64x2_pmax((v128_t)b.v, (v128_t)a.v)};
}
TAUT_INLINE Wide<2> Min(Wide<2> a, Wide<2> b) noexcept {
  return {(Wide<2>::Vector)wasm_f64x2_pmin((v128_t)b.v, (v128_t)a.v)};
}

}  // namespace taut::simd
