/// PID controller in discrete time, with output limits and anti-windup.
#pragma once

#include "taut/control/real.h"

namespace taut {
namespace control {

/// Gains, in units of output per error, and per second or times seconds.
template <class Real>
struct Pid {
  Real proportional;
  Real integral;
  Real derivative;
};

/// State of a PID controller between ticks.
template <class Real>
struct PidState {
  Real error_before;  ///< e_(n-1) [error].
  Real integral;      ///< I_n [error s].
};

/// Returns the initial state of NTRT's tgPIDController, with e_(-1) = 0: to the first tick, the
/// whole error is a jump.
template <class Real>
constexpr PidState<Real> StartPid() noexcept {
  return PidState<Real>{Literal<Real>(0.0f), Literal<Real>(0.0f)};
}

/// Returns an initial state without derivative kick: the derivative of the first tick is 0 if its
/// error is `error`.
template <class Real>
constexpr PidState<Real> StartPidAt(Real error) noexcept {
  return PidState<Real>{error, Literal<Real>(0.0f)};
}

/// Returns an initial state for bumpless transfer (eq. K.14): the first tick gives `output` if its
/// error is `error`, so that the output of a previous control law continues without a jump. Without
/// an integral gain this is impossible, and the integral starts at 0; likewise for gains up to
/// 1e-20, by which a float cannot be divided.
template <class Real>
constexpr PidState<Real> StartPidFrom(const Pid<Real>& pid, Real error, Real output,
                                      Real period_s) noexcept {
  const Real zero = Literal<Real>(0.0f), one = Literal<Real>(1.0f);
  const Real sum = output - pid.proportional * error;
  const auto can = pid.integral > Literal<Real>(1e-20f);
  // minus the increment of the first tick
  const Real integral = sum / Select(can, pid.integral, one) - error * period_s;
  return PidState<Real>{error, Select(can, integral, zero)};
}

/// Advances by one tick (docs/theory/control.md, eq. K.5) and returns u.
///   I_n = I_(n-1) + (e_n + e_(n-1)) / 2 h
///   u_n = kp e_n + ki I_n + kd (e_n - e_(n-1)) / h
/// Source: NTRT's tgPIDController, except for its signs. I is not bounded.
template <class Real>
constexpr Real StepPid(const Pid<Real>& pid, PidState<Real>& state, Real error,
                       Real period_s) noexcept {
  state.integral = state.integral + (error + state.error_before) * (Literal<Real>(0.5f) * period_s);
  const Real before = state.error_before;
  state.error_before = error;
  const Real u = pid.proportional * error + pid.integral * state.integral;
  // saves a board the time of a division if the gain is 0
  const Real zero = Literal<Real>(0.0f);
  if (!Any((pid.derivative > zero) | (pid.derivative < zero))) return u;
  return u + pid.derivative * ((error - before) / period_s);
}

/// Output range of an actuator.
template <class Real>
struct OutputLimits {
  Real low, high;  ///< low <= high.
};

/// Anti-windup: behavior of the integral while the output is at a limit.
enum class Windup : unsigned char {
  kAllowed,  ///< Keeps integrating, as in tgPIDController.
  kHeld,     ///< Constant while further integration would push the output further past the limit.
};

/// Advances by one tick with a limited output (eq. K.5 and K.6) and returns u, low <= u <= high.
template <class Real>
constexpr Real StepPidLimited(const Pid<Real>& pid, PidState<Real>& state, Real error,
                              Real period_s, const OutputLimits<Real>& limits,
                              Windup windup) noexcept {
  const Real integral_before = state.integral;
  const Real u = StepPid(pid, state, error, period_s);
  if (windup == Windup::kAllowed) return Clamp(u, limits.low, limits.high);
  if (!Any((u > limits.high) | (u < limits.low))) return u;  // the rest would change nothing

  const Real zero = Literal<Real>(0.0f);
  const Real push = pid.integral * (state.integral - integral_before);
  const auto held = ((u > limits.high) & (push > zero)) | ((u < limits.low) & (push < zero));
  state.integral = Select(held, integral_before, state.integral);
  return Clamp(Select(held, u - push, u), limits.low, limits.high);
}

}  // namespace control
}  // namespace taut
