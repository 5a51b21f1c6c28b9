/// Sine and cosine of SIMD numbers.
#pragma once

#include "math/angle.h"
#include "simd/wide.h"

namespace taut::simd {

using taut::Atan2;
using taut::kPi;
using taut::Round;

/// Computes sine and cosine of 2 pi `turns` for |turns| < 2^48, with an error of about 2 units in
/// the last place of 1. Uses only + - *.
template <class W>
TAUT_INLINE void SinCosOfTurns(W turns, W& sine, W& cosine) noexcept {
  constexpr int kTerms = 8;  // (pi / 4)^17 / 17! < 1e-16
  const W one = W::Splat(1.0), zero = W::Splat(0.0);
  const W part = turns - Round(turns), quarters = Round(W::Splat(4.0) * part);
  const W x = W::Splat(2 * kPi) * (part - W::Splat(0.25) * quarters), x2 = x * x;
  W s = one, c = one;
  for (int k = kTerms; k >= 1; --k) {
    s = one - W::Splat(1.0 / (2 * k * (2 * k + 1))) * x2 * s;
    c = one - W::Splat(1.0 / (2 * k * (2 * k - 1))) * x2 * c;
  }
  s = x * s;
  const W size = Abs(quarters);
  const auto odd = size == one, half = size == W::Splat(2.0), back = quarters < zero;
  const W quarter_s = Select(back, zero - c, c), quarter_c = Select(back, s, zero - s);
  sine = Select(odd, quarter_s, Select(half, zero - s, s));
  cosine = Select(odd, quarter_c, Select(half, zero - c, c));
}

}  // namespace taut::simd
