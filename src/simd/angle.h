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

}  // namespace taut::simd
