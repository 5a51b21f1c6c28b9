/// Angles in turns (1 turn = 2 pi rad), with sine and cosine.
///
/// A phase in turns wraps without rounding error and needs no pi. The functions use only + - * and
/// comparisons, so they give the same bits on an AVR, on a PC and in every SIMD lane.
#pragma once

#include "taut/control/real.h"

namespace taut {
namespace control {

/// Turns per radian, 1 / (2 pi).
constexpr double kTurnsPerRad = 0.15915494309189534;

namespace internal {

/// Number whose addition and subtraction rounds a much smaller number to an integer: 1.5 times the
/// smallest number above which adjacent floating-point numbers differ by 1. For double, unless
/// specialized.
template <class Real>
struct Rounder {
  static constexpr double kNumber = 6755399441055744.0;  // 1.5 2^52
};
template <>
struct Rounder<float> {
  static constexpr float kNumber = 12582912.0f;  // 1.5 2^23
};

/// Number of terms of the sine series. At a quarter turn, the next term is below the last digit.
template <class Real>
struct SineTerms {
  static constexpr int kCount = 11;
};
template <>
struct SineTerms<float> {
  static constexpr int kCount = 7;
};

/// Returns (-1)^n (2 pi)^(2n+1) / (2n+1)!, rounded. A template, so that object files for different
/// instruction sets share no function.
template <class Real>
constexpr double SineTerm(int n) noexcept {
  constexpr double kTerms[] = {
      6.283185307179586,   -41.34170224039976,    81.60524927607506,     -76.70585975306139,
      42.058693944897655,  -15.09464257682299,    3.819952584848282,     -0.7181223017785006,
      0.10422916220813984, -0.012031585942120627, 0.0011309237482517963,
  };
  return kTerms[n];
}

/// Returns sin(2 pi x), |x| <= 1/4.
template <class Real>
constexpr Real SineSeries(Real x) noexcept {
  const Real x2 = x * x;
  Real sum = control::FromScalar<Real>(SineTerm<Real>(SineTerms<Real>::kCount - 1));
  for (int n = SineTerms<Real>::kCount - 2; n >= 0; --n) {
    sum = sum * x2 + control::FromScalar<Real>(SineTerm<Real>(n));
  }
  return sum * x;
}

}  // namespace internal

/// Wraps an angle to -1/2..1/2 turns without rounding. Valid for |x| < 2^22 in float and 2^51 in
/// double; NaN stays NaN.
template <class Real>
constexpr Real WrapTurns(Real x) noexcept {
  const Real rounder = control::FromScalar<Real>(internal::Rounder<Real>::kNumber);
  return x - ((x + rounder) - rounder);
}

/// Returns sin(2 pi x), -1/2 <= x <= 1/2 (docs/theory/gaits.md, eq. G.2), from the series around
/// the nearest whole or half turn. Absolute error below 4.4e-16 in double and 2.4e-7 in float.
template <class Real>
constexpr Real SinTurns(Real x) noexcept {
  const Real half = Literal<Real>(0.5f), quarter = Literal<Real>(0.25f);
  const Real back = Select(x > Literal<Real>(0.0f), half - x, -half - x);
  return internal::SineSeries(Select(x > quarter, back, Select(x < -quarter, back, x)));
}

/// Returns cos(2 pi x), -1/2 <= x <= 1/2.
template <class Real>
constexpr Real CosTurns(Real x) noexcept {
  const Real size = Select(x < Literal<Real>(0.0f), -x, x);
  return internal::SineSeries(Literal<Real>(0.25f) - size);
}

}  // namespace control
}  // namespace taut
