/// Filters of first order for what a board measures.
#pragma once

namespace taut {
namespace control {

/// One tick of a low pass (docs/theory/control.md, eq. K.12); returns y.
///   y_n = y_(n-1) + a (x_n - y_(n-1))
/// `share` a, 0 < a <= 1: h / (tau + h) for a time constant tau at a period h. 1 lets all through.
template <class Real>
constexpr Real StepLowPass(Real& y, Real x, Real share) noexcept {
  y = y + share * (x - y);
  return y;
}

/// One tick of a complementary filter (eq. K.13); returns y.
///   y_n = (1 - a) (y_(n-1) + dx_n) + a x_n
/// Slow changes come from the measurement x, quick ones from `step` dx, what another sensor says
/// that x has changed by: of a load cell, what the encoder wound times the stiffness. Without it
/// (0), a low pass.
template <class Real>
constexpr Real StepComplementary(Real& y, Real x, Real step, Real share) noexcept {
  y = y + step;
  return StepLowPass(y, x, share);
}

}  // namespace control
}  // namespace taut
