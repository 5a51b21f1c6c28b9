/// The angle of a direction, of wide numbers.
#pragma once

#include "simd/wide.h"

namespace taut::simd {

inline constexpr double kPi = 3.14159265358979323846;

/// The whole number that is nearest, for |x| < 2^50.
template <class W>
TAUT_INLINE W Round(W x) noexcept {
  const W large = W::Splat(6755399441055744.0);  // 1.5 * 2^52
  return (x + large) - large;
}

/// The angle from x to (x, y), -pi..pi, to some 3 units in the last place; of (0, 0) it is 0. Twice
/// halved, so that its series is short; + - * / and Sqrt alone.
template <class W>
TAUT_INLINE W Atan2(W y, W x) noexcept {
  constexpr int kTerms = 12;  // (tan(pi / 16))^25 / 25 < 1e-19
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  const W ax = Abs(x), ay = Abs(y), large = Max(ax, ay);
  W t = Min(ax, ay) / Max(large, W::Splat(1e-300));
  t = t / (one + Sqrt(one + t * t));
  t = t / (one + Sqrt(one + t * t));
  const W t2 = t * t;
  W sum = W::Splat(1.0 / (2 * kTerms + 1));
  for (int k = kTerms - 1; k >= 0; --k) sum = W::Splat(1.0 / (2 * k + 1)) - t2 * sum;
  W angle = W::Splat(4.0) * t * sum;
  angle = Select(ay > ax, W::Splat(kPi / 2) - angle, angle);
  angle = Select(x < zero, W::Splat(kPi) - angle, angle);
  return Select(y < zero, zero - angle, angle);
}

/// Sine and cosine of 2 pi `turns`, for |turns| < 2^48, to some 2 units in the last place of 1; + -
/// * alone.
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
