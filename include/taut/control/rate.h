/// Rate of a cable's length from its lengths at successive ticks, for boards with only an encoder
/// and a load cell.
#pragma once

namespace taut {
namespace control {

/// Length at the previous tick [m].
template <class Real>
struct DifferenceState {
  Real length_before_m;
};

/// Returns an initial state with which the first tick returns a rate of 0 for the length
/// `length_m`.
template <class Real>
constexpr DifferenceState<Real> StartDifference(Real length_m) noexcept {
  return DifferenceState<Real>{length_m};
}

/// Returns an initial state with which the first tick returns (length - rest length) / period, as
/// in NTRT. NTRT starts the previous length at the rest length, which is a jump of centimeters in a
/// millisecond.
template <class Real>
constexpr DifferenceState<Real> StartDifferenceAtRestLength(Real rest_length_m) noexcept {
  return DifferenceState<Real>{rest_length_m};
}

/// Returns V_n = (l_n - l_(n-1)) / h [m/s], lengthening positive (docs/theory/control.md, eq. K.4).
/// V_n is the mean rate over the last period and therefore lags by half a period. An encoder with
/// quantum q gives rates in multiples of q / h.
template <class Real>
constexpr Real StepDifference(DifferenceState<Real>& state, Real length_m, Real period_s) noexcept {
  const Real rate_m_per_s = (length_m - state.length_before_m) / period_s;
  state.length_before_m = length_m;
  return rate_m_per_s;
}

}  // namespace control
}  // namespace taut
