/// First-order filters for sensor signals: low-pass and complementary filter.
#pragma once

namespace taut {
namespace control {

/// Advances a low-pass filter by one tick (docs/theory/control.md, eq. K.12) and returns y.
///   y_n = y_(n-1) + a (x_n - y_(n-1))
/// `share`: a, 0 < a <= 1; h / (tau + h) for a time constant tau and a period h; 1: no filtering.
template <class Real>
constexpr Real StepLowPass(Real& y, Real x, Real share) noexcept {
  y = y + share * (x - y);
  return y;
}

/// Advances a complementary filter by one tick (eq. K.13) and returns y.
///   y_n = (1 - a) (y_(n-1) + dx_n) + a x_n
/// Low frequencies come from the measurement x, high frequencies from `step` dx, the change of x
/// measured by another sensor: for a load cell, the length wound by the encoder times the
/// stiffness. With dx = 0 it is a low-pass filter.
template <class Real>
constexpr Real StepComplementary(Real& y, Real x, Real step, Real share) noexcept {
  y = y + step;
  return StepLowPass(y, x, share);
}

}  // namespace control
}  // namespace taut
