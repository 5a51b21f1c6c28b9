/// Arctangent, exponential and rounding with the same bits on all machines, for SIMD and plain
/// numbers; only + - * / and Sqrt.
#pragma once

#include "math/scalar.h"

namespace taut {

inline constexpr double kPi = 3.14159265358979323846;

/// Returns the nearest whole number, for |x| < 2^50.
template <class S>
TAUT_INLINE S Round(S x) noexcept {
  const S large = Constant<S>::Of(6755399441055744.0);  // 1.5 * 2^52
  return (x + large) - large;
}

/// Returns the angle of the direction (x, y), -pi..pi; 0 for (0, 0). The error is about 3 units in
/// the last place. The angle is halved twice, so a short series suffices.
template <class S>
TAUT_INLINE S Atan2(S y, S x) noexcept {
  constexpr int kTerms = 12;  // (tan(pi / 16))^25 / 25 < 1e-19
  using C = Constant<S>;
  const S zero = C::Of(0.0), one = C::Of(1.0);
  const S ax = Abs(x), ay = Abs(y), large = Max(ax, ay);
  S t = Min(ax, ay) / Max(large, C::Of(1e-300));
  t = t / (one + Sqrt(one + t * t));
  t = t / (one + Sqrt(one + t * t));
  const S t2 = t * t;
  S sum = C::Of(1.0 / (2 * kTerms + 1));
  for (int k = kTerms - 1; k >= 0; --k) sum = C::Of(1.0 / (2 * k + 1)) - t2 * sum;
  S angle = C::Of(4.0) * t * sum;
  angle = Select(ay > ax, C::Of(kPi / 2) - angle, angle);
  angle = Select(x < zero, C::Of(kPi) - angle, angle);
  return Select(y < zero, zero - angle, angle);
}

/// Returns e^x - 1 for 0 <= x <= 40, with an error of about 1e-15 e^x. Doubles y by (1 + y)^2 - 1 =
/// y (2 + y), which loses no digits for small x.
template <class S>
TAUT_INLINE S ExpLess1(S x) noexcept {
  constexpr int kHalvings = 8, kTerms = 9;  // remainder (40 / 256)^10 / 10! < 1e-14
  using C = Constant<S>;
  const S t = C::Of(1.0 / (1 << kHalvings)) * x;
  S sum = C::Of(1.0);
  for (int k = kTerms; k > 1; --k) sum = C::Of(1.0) + C::Of(1.0 / k) * t * sum;
  S y = t * sum;
  for (int k = 0; k < kHalvings; ++k) y = y * (C::Of(2.0) + y);
  return y;
}

}  // namespace taut
