/// PID controller in discrete time, with output limits and anti-windup.
#pragma once

#include "taut/control/real.h"

namespace taut {
namespace control {

/// Gains, in units of output per unit of error; the integral gain also per second, the derivative
/// gain also times seconds.
template <class Real>
struct Pid {
  Real proportional;
  Real integral;
  Real derivative;
};

/// State of a PID controller between ticks.
template <class Real>
struct PidState {
  Real error_before;  ///< e_(n-1), in units of the error.
  Real integral;      ///< I_n, in units of the error times seconds.
};

/// Returns the initial state of NTRT's tgPIDController, with e_(-1) = 0. The first tick then sees a
/// jump from 0 to the error (derivative kick).
template <class Real>
constexpr PidState<Real> StartPid() noexcept {
  return PidState<Real>{Literal<Real>(0.0f), Literal<Real>(0.0f)};
}

/// Returns an initial state without derivative kick: if the first error is `error`, its derivative
/// is 0.
template <class Real>
constexpr PidState<Real> StartPidAt(Real error) noexcept {
  return PidState<Real>{error, Literal<Real>(0.0f)};
}

/// Returns an initial state for bumpless transfer (eq. K.14): if the first error is `error`, the
/// first output is `output`, so the output of the previous control law continues without a jump.
/// Bumpless transfer needs an integral gain above 1e-20 (float division); otherwise the integral
/// starts at 0.
template <class Real>
constexpr PidState<Real> StartPidFrom(const Pid<Real>& pid, Real error, Real output,
                                      Real period_s) noexcept {
  const Real zero = Literal<Real>(0.0f), one = Literal<Real>(1.0f);
  const Real sum = output - pid.proportional * error;
  const auto can = pid.integral > Literal<Real>(1e-20f);
  // The first tick adds error * period_s to the integral.
  const Real integral = sum / Select(can, pid.integral, one) - error * period_s;
  return PidState<Real>{error, Select(can, integral, zero)};
}

/// Advances by one tick and returns u (docs/theory/control.md, eq. K.5):
///   I_n = I_(n-1) + (e_n + e_(n-1)) / 2 h
///   u_n = kp e_n + ki I_n + kd (e_n - e_(n-1)) / h
/// Source: NTRT's tgPIDController, except for the signs. I has no bound.
template <class Real>
constexpr Real StepPid(const Pid<Real>& pid, PidState<Real>& state, Real error,
                       Real period_s) noexcept {
  state.integral = state.integral + (error + state.error_before) * (Literal<Real>(0.5f) * period_s);
  const Real before = state.error_before;
  state.error_before = error;
  const Real u = pid.proportional * error + pid.integral * state.integral;
  // Without a derivative gain, a board saves the time of a division.
  const Real zero = Literal<Real>(0.0f);
  if (!Any((pid.derivative > zero) | (pid.derivative < zero))) return u;
  return u + pid.derivative * ((error - before) / period_s);
}

/// Output range of an actuator.
template <class Real>
struct OutputLimits {
  Real low, high;  ///< Limits of the output, low <= high.
};

/// Anti-windup: integration while the output is at a limit.
enum class Windup : unsigned char {
  kAllowed,  ///< The integral keeps changing, as in tgPIDController.
  kHeld,     ///< The integral stays constant if it would push the output further past the limit.
};

/// Advances by one tick with output limits and returns u, low <= u <= high (eq. K.5 and K.6).
template <class Real>
constexpr Real StepPidLimited(const Pid<Real>& pid, PidState<Real>& state, Real error,
                              Real period_s, const OutputLimits<Real>& limits,
                              Windup windup) noexcept {
  const Real integral_before = state.integral;
  const Real u = StepPid(pid, state, error, period_s);
  if (windup == Windup::kAllowed) return Clamp(u, limits.low, limits.high);
  if (!Any((u > limits.high) | (u < limits.low))) return u;  // no limit applies

  const Real zero = Literal<Real>(0.0f);
  const Real push = pid.integral * (state.integral - integral_before);
  const auto held = ((u > limits.high) & (push > zero)) | ((u < limits.low) & (push < zero));
  state.integral = Select(held, integral_before, state.integral);
  return Clamp(Select(held, u - push, u), limits.low, limits.high);
}

}  // namespace control
}  // namespace taut
