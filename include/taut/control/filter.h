/// First-order filters for sensor signals: low-pass and complementary filter.
#pragma once

namespace taut {
namespace control {

/// Advances a low-pass filter by one tick and returns y (docs/theory/control.md, eq. K.12):
///   y_n = y_(n-1) + a (x_n - y_(n-1))
/// `share`: a, 0 < a <= 1. For a time constant tau and a period h, a = h / (tau + h); 1: no
/// filtering.
template <class Real>
constexpr Real StepLowPass(Real& y, Real x, Real share) noexcept {
  y = y + share * (x - y);
  return y;
}

/// Advances a complementary filter by one tick and returns y (eq. K.13):
///   y_n = (1 - a) (y_(n-1) + dx_n) + a x_n
/// The measurement x determines low frequencies, and the increments dx (`step`) of x from another
/// sensor determine high frequencies. Example for a load cell: dx is the length wound by the
/// encoder times the stiffness. With dx = 0 this is a low-pass filter.
template <class Real>
constexpr Real StepComplementary(Real& y, Real x, Real step, Real share) noexcept {
  y = y + step;
  return StepLowPass(y, x, share);
}

}  // namespace control
}  // namespace taut
