/// A cable's rate of lengthening from its length at successive ticks, as a board that has only
/// an encoder and a load cell must do it.
#pragma once

namespace taut {
namespace control {

/// The length at the tick before [m].
template <class Real>
struct DifferenceState {
  Real length_before_m;
};

/// The first tick sees a rate of 0 if the cable then is `length_m` long.
template <class Real>
constexpr DifferenceState<Real> StartDifference(Real length_m) noexcept {
  return DifferenceState<Real>{length_m};
}

/// The first tick sees (length - rest length) / period. NTRT does that: its cables start with
/// "the length before" at the rest length, a jump of centimetres in a millisecond.
template <class Real>
constexpr DifferenceState<Real> StartDifferenceAtRestLength(Real rest_length_m) noexcept {
  return DifferenceState<Real>{rest_length_m};
}

/// V_n = (l_n - l_(n-1)) / h  [m/s], lengthening positive (docs/theory/control.md, eq. K.4).
/// It is the mean rate over the last period, so half a period old; an encoder of quantum q shows
/// it in quanta of q / h.
template <class Real>
constexpr Real StepDifference(DifferenceState<Real>& state, Real length_m, Real period_s) noexcept {
  const Real rate_m_per_s = (length_m - state.length_before_m) / period_s;
  state.length_before_m = length_m;
  return rate_m_per_s;
}

}  // namespace control
}  // namespace taut
