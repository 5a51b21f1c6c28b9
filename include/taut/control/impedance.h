/// Impedance control of one cable: tension set point from length and rate, and two methods to
/// control the tension to it, by stiffness and by PID.
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

/// Returns the tension set point [N] (paper eq. 3, docs/theory/control.md eq. K.2):
///   T = max(0, T0 + K (L - L0) + B (V - V0))
/// with the cable's length L [m] and its rate V [m/s], lengthening positive. V0 [m/s] is the input
/// by which a gait drives the cable, such as a sine or an oscillator; 0 holds still.
///
/// The paper omits the lower bound 0; its simulator has it, and a cable cannot push.
template <class Real>
constexpr Real ImpedanceTension(const Impedance<Real>& law, Real length_m, Real rate_m_per_s,
                                Real velocity_offset_m_per_s) noexcept {
  const Real T = law.tension_offset_n +
                 law.position_gain_n_per_m * (length_m - law.length_offset_m) +
                 law.velocity_gain_n_s_per_m * (rate_m_per_s - velocity_offset_m_per_s);
  return Max(Literal<Real>(0.0f), T);
}

/// Returns the rest length that gives the tension `set_point_n` while the cable's ends do not move
/// [m] (eq. K.3):
///   L' = max(floor, L - (T_set - T) / k)
/// An ideal taut cable reaches the set point in one tick; a slack cable (T = 0) approaches it by
/// T_set / k per tick. Source: NTRT's tgTensionController; its floor of 0.1 length units is an
/// argument here. There, `tension_n` is the elastic tension k (l - L); a measured tension includes
/// the cable's damping.
template <class Real>
constexpr Real TensionToRestLengthByStiffness(Real rest_length_m, Real tension_n, Real set_point_n,
                                              Real stiffness_n_per_m, Real floor_m) noexcept {
  return Max(floor_m, rest_length_m - (set_point_n - tension_n) / stiffness_n_per_m);
}

/// Returns the rate of the rest length [m/s] from a PID controller of the tension error (eq. K.7):
///   dL/dt = -PID(T_set - T)
/// Too little tension gives a negative rate: winding in. Gains are in m/s per N, and per second or
/// times seconds.
///
/// According to the paper, its boards run a PID every millisecond; it gives neither gains nor the
/// quantity of the output before conversion to a PWM duty. The winding rate as output (a DC motor
/// at a voltage is close to a rate source) and all gains used with this are assumptions of taut.
template <class Real>
constexpr Real TensionByPid(const Pid<Real>& pid, PidState<Real>& state, Real tension_n,
                            Real set_point_n, Real period_s) noexcept {
  return -StepPid(pid, state, set_point_n - tension_n, period_s);
}

/// Returns the same rate, limited to +-`max_speed_m_per_s`.
template <class Real>
constexpr Real TensionByPidLimited(const Pid<Real>& pid, PidState<Real>& state, Real tension_n,
                                   Real set_point_n, Real period_s, Real max_speed_m_per_s,
                                   Windup windup) noexcept {
  const OutputLimits<Real> limits{-max_speed_m_per_s, max_speed_m_per_s};
  return -StepPidLimited(pid, state, set_point_n - tension_n, period_s, limits, windup);
}

/// Returns the rest length after one period at a commanded rate [m] (eq. K.8).
template <class Real>
constexpr Real RestLengthAfter(Real rest_length_m, Real rate_m_per_s, Real period_s,
                               Real floor_m) noexcept {
  return Max(floor_m, rest_length_m + rate_m_per_s * period_s);
}

/// Returns the length of a taut cable from its rest length (encoder) and tension (load cell) [m]
/// (eq. K.9):
///   l = L + T / k
/// The paper's boards have no other means, and the paper does not describe theirs. Too long by b
/// dl/dt / k if T contains the cable's damping; for a slack cable (T = 0) only an upper bound.
template <class Real>
constexpr Real LengthFromTension(Real rest_length_m, Real tension_n,
                                 Real stiffness_n_per_m) noexcept {
  return rest_length_m + tension_n / stiffness_n_per_m;
}

}  // namespace control
}  // namespace taut
