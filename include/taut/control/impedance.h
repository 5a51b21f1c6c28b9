/// Impedance control of one cable: a tension set point that grows with length and rate, and the
/// two ways to make the cable have that tension.
///
/// Sources: Mirletz, Park, Quinn, SunSpiral, "Towards bridging the reality gap between tensegrity
/// simulation and robotic hardware", IROS 2015, eq. 3; NTRT's tgImpedanceController and
/// tgTensionController. Derivations and differences: docs/theory/control.md.
#pragma once

#include "taut/control/pid.h"
#include "taut/control/real.h"

namespace taut {
namespace control {

/// Gains and offsets of one cable, all >= 0.
template <class Real>
struct Impedance {
  Real tension_offset_n;         ///< T0 [N].
  Real length_offset_m;          ///< L0 [m].
  Real position_gain_n_per_m;    ///< K [N/m].
  Real velocity_gain_n_s_per_m;  ///< B [N s/m].
};

/// The tension set point (paper eq. 3, docs/theory/control.md eq. K.2) [N]:
///   T = max(0, T0 + K (L - L0) + B (V - V0))
/// with L the cable's length [m] and V its rate [m/s], lengthening positive. V0 [m/s] is the input
/// through which a gait drives the cable: a sine, an oscillator, or 0 to hold still.
///
/// The paper does not print the floor at 0; its simulator has it, and a cable cannot push.
template <class Real>
constexpr Real ImpedanceTension(const Impedance<Real>& law, Real length_m, Real rate_m_per_s,
                                Real velocity_offset_m_per_s) noexcept {
  const Real T = law.tension_offset_n +
                 law.position_gain_n_per_m * (length_m - law.length_offset_m) +
                 law.velocity_gain_n_s_per_m * (rate_m_per_s - velocity_offset_m_per_s);
  return Max(Literal<Real>(0.0f), T);
}

/// The rest length that gives `set_point_n`, the cable's ends being held (eq. K.3) [m]:
///   L' = max(floor, L - (T_set - T) / k)
/// An ideal taut cable reaches the set point in one tick; a slack one (T = 0) approaches by
/// T_set / k a tick. Source: NTRT's tgTensionController, with its floor of 0.1 length units made
/// an argument. `tension_n` is the elastic tension k (l - L) there; a measured one includes the
/// cable's damping.
template <class Real>
constexpr Real TensionToRestLengthByStiffness(Real rest_length_m, Real tension_n, Real set_point_n,
                                              Real stiffness_n_per_m, Real floor_m) noexcept {
  return Max(floor_m, rest_length_m - (set_point_n - tension_n) / stiffness_n_per_m);
}

/// The rate of the rest length [m/s] that a PID on the tension error asks for (eq. K.7):
///   dL/dt = -PID(T_set - T)
/// A cable that pulls too little is wound in, so the rate is negative. Gains in m/s per N, and per
/// second or times seconds.
///
/// The paper says that its boards run a PID every millisecond; it gives neither gains nor what the
/// PID's output is before it becomes a PWM duty. That the output is a winding rate (a DC motor
/// under voltage is close to a rate source) and every gain used with this are our assumption.
template <class Real>
constexpr Real TensionByPid(const Pid<Real>& pid, PidState<Real>& state, Real tension_n,
                            Real set_point_n, Real period_s) noexcept {
  return -StepPid(pid, state, set_point_n - tension_n, period_s);
}

/// The same with the winding rate bounded to +-`max_speed_m_per_s`.
template <class Real>
constexpr Real TensionByPidLimited(const Pid<Real>& pid, PidState<Real>& state, Real tension_n,
                                   Real set_point_n, Real period_s, Real max_speed_m_per_s,
                                   Windup windup) noexcept {
  const OutputLimits<Real> limits{-max_speed_m_per_s, max_speed_m_per_s};
  return -StepPidLimited(pid, state, set_point_n - tension_n, period_s, limits, windup);
}

/// Where a rest length goes in one period at a commanded rate (eq. K.8) [m].
template <class Real>
constexpr Real RestLengthAfter(Real rest_length_m, Real rate_m_per_s, Real period_s,
                               Real floor_m) noexcept {
  return Max(floor_m, rest_length_m + rate_m_per_s * period_s);
}

/// The length of a taut cable whose rest length an encoder knows and whose tension a load cell
/// knows (eq. K.9) [m]:
///   l = L + T / k
/// The paper's boards have no other way to know it and do not say how they do it. Too long by
/// b dl/dt / k if T contains the cable's damping; while slack (T = 0) it is only an upper bound.
template <class Real>
constexpr Real LengthFromTension(Real rest_length_m, Real tension_n,
                                 Real stiffness_n_per_m) noexcept {
  return rest_length_m + tension_n / stiffness_n_per_m;
}

}  // namespace control
}  // namespace taut
