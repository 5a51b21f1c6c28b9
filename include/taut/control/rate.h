/// Rate of lengthening of a cable from its length at successive ticks, as on a board with only an
/// encoder and a load cell.
#pragma once

namespace taut {
namespace control {

/// Length at the previous tick [m].
template <class Real>
struct DifferenceState {
  Real length_before_m;
};

/// Returns an initial state with which the first tick gives a rate of 0 if the cable is `length_m`
/// long then.
template <class Real>
constexpr DifferenceState<Real> StartDifference(Real length_m) noexcept {
  return DifferenceState<Real>{length_m};
}

/// Returns an initial state with which the first tick gives (length - rest length) / period, as in
/// NTRT: its cables start with the rest length as previous length, a jump of centimeters in a
/// millisecond.
template <class Real>
constexpr DifferenceState<Real> StartDifferenceAtRestLength(Real rest_length_m) noexcept {
  return DifferenceState<Real>{rest_length_m};
}

/// Returns V_n = (l_n - l_(n-1)) / h [m/s], lengthening positive (docs/theory/control.md, eq. K.4).
/// It is the mean rate over the last period, hence half a period old; an encoder of quantum q gives
/// steps of q / h.
template <class Real>
constexpr Real StepDifference(DifferenceState<Real>& state, Real length_m, Real period_s) noexcept {
  const Real rate_m_per_s = (length_m - state.length_before_m) / period_s;
  state.length_before_m = length_m;
  return rate_m_per_s;
}

}  // namespace control
}  // namespace taut
