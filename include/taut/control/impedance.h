/// Impedance control of one cable: tension set point from length and rate, and two methods to reach
/// this set point, by the cable's stiffness and by a PID controller.
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
  Real tension_offset_n;         ///< Tension offset T0.
  Real length_offset_m;          ///< Length offset L0.
  Real position_gain_n_per_m;    ///< Position gain K.
  Real velocity_gain_n_s_per_m;  ///< Velocity gain B.
};

/// Returns the tension set point [N] (paper eq. 3, docs/theory/control.md eq. K.2):
///   T = max(0, T0 + K (L - L0) + B (V - V0))
/// L [m] is the cable's length and V [m/s] its rate; lengthening is positive. V0 [m/s] is the
/// velocity input of a gait, such as a sine or an oscillator. With V0 = 0, the cable holds still.
///
/// The lower bound 0 is not in the paper but in its simulator; a cable cannot push.
template <class Real>
constexpr Real ImpedanceTension(const Impedance<Real>& law, Real length_m, Real rate_m_per_s,
                                Real velocity_offset_m_per_s) noexcept {
  const Real T = law.tension_offset_n +
                 law.position_gain_n_per_m * (length_m - law.length_offset_m) +
                 law.velocity_gain_n_s_per_m * (rate_m_per_s - velocity_offset_m_per_s);
  return Max(Literal<Real>(0.0f), T);
}

/// Returns the rest length [m] for the tension `set_point_n` at fixed cable ends (eq. K.3):
///   L' = max(floor, L - (T_set - T) / k)
/// An ideal taut cable reaches the set point in one tick. A slack cable (T = 0) winds in by T_set /
/// k per tick. Source: NTRT's tgTensionController, with its constant floor of 0.1 length units as
/// an argument. In NTRT, `tension_n` is the elastic tension k (l - L); a measured tension includes
/// the damping.
template <class Real>
constexpr Real TensionToRestLengthByStiffness(Real rest_length_m, Real tension_n, Real set_point_n,
                                              Real stiffness_n_per_m, Real floor_m) noexcept {
  return Max(floor_m, rest_length_m - (set_point_n - tension_n) / stiffness_n_per_m);
}

/// Returns the rate of the rest length [m/s] from a PID controller of the tension error (eq. K.7):
///   dL/dt = -PID(T_set - T)
/// If the tension is too low, the rate is negative (winding in). Gains: proportional in m/s per N,
/// integral in this unit per second, derivative in this unit times seconds.
///
/// According to the paper, its boards run a PID every millisecond. The paper specifies neither the
/// gains nor the output quantity. taut assumes a winding rate as output, since a DC motor at a
/// voltage is nearly a rate source. All gains are assumptions of taut, too.
template <class Real>
constexpr Real TensionByPid(const Pid<Real>& pid, PidState<Real>& state, Real tension_n,
                            Real set_point_n, Real period_s) noexcept {
  return -StepPid(pid, state, set_point_n - tension_n, period_s);
}

/// Same as above, with the rate limited to +-`max_speed_m_per_s`.
template <class Real>
constexpr Real TensionByPidLimited(const Pid<Real>& pid, PidState<Real>& state, Real tension_n,
                                   Real set_point_n, Real period_s, Real max_speed_m_per_s,
                                   Windup windup) noexcept {
  const OutputLimits<Real> limits{-max_speed_m_per_s, max_speed_m_per_s};
  return -StepPidLimited(pid, state, set_point_n - tension_n, period_s, limits, windup);
}

/// Returns the rest length [m] after one period at a commanded rate (eq. K.8).
template <class Real>
constexpr Real RestLengthAfter(Real rest_length_m, Real rate_m_per_s, Real period_s,
                               Real floor_m) noexcept {
  return Max(floor_m, rest_length_m + rate_m_per_s * period_s);
}

/// Returns the length [m] of a taut cable from its rest length (encoder) and tension (load cell)
/// (eq. K.9):
///   l = L + T / k
/// The paper's boards have no other length measurement, and the paper does not describe its method.
/// The result is too long by b dl/dt / k if T contains the damping of the cable. For a slack cable
/// (T = 0) it is an upper bound.
template <class Real>
constexpr Real LengthFromTension(Real rest_length_m, Real tension_n,
                                 Real stiffness_n_per_m) noexcept {
  return rest_length_m + tension_n / stiffness_n_per_m;
}

}  // namespace control
}  // namespace taut
