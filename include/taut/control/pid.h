/// A PID controller in discrete time.
#pragma once

#include "taut/control/real.h"

namespace taut {
namespace control {

/// Gains; their units are those of output per error, and per second or times seconds.
template <class Real>
struct Pid {
  Real proportional;
  Real integral;
  Real derivative;
};

/// What a PID remembers from tick to tick.
template <class Real>
struct PidState {
  Real error_before;  ///< e_(n-1) [error].
  Real integral;      ///< I_n [error s].
};

/// Starts as tgPIDController does, with e_(-1) = 0: the first tick sees the whole error as a jump.
template <class Real>
constexpr PidState<Real> StartPid() noexcept {
  return PidState<Real>{Literal<Real>(0.0f), Literal<Real>(0.0f)};
}

/// Starts without a kick: the derivative of the first tick is 0 if its error is `error`.
template <class Real>
constexpr PidState<Real> StartPidAt(Real error) noexcept {
  return PidState<Real>{error, Literal<Real>(0.0f)};
}

/// Starts so that the first tick gives `output` if its error is `error` (eq. K.14): what drove
/// before another law took over goes on without a jump. Without an integral gain the output cannot
/// be met, and the integral starts at 0; so it does where that gain is next to nothing, by which no
/// float can be divided.
template <class Real>
constexpr PidState<Real> StartPidFrom(const Pid<Real>& pid, Real error, Real output,
                                      Real period_s) noexcept {
  const Real zero = Literal<Real>(0.0f), one = Literal<Real>(1.0f);
  const Real sum = output - pid.proportional * error;
  const auto can = pid.integral > Literal<Real>(1e-20f);
  // less what the first tick will add
  const Real integral = sum / Select(can, pid.integral, one) - error * period_s;
  return PidState<Real>{error, Select(can, integral, zero)};
}

/// One tick (docs/theory/control.md, eq. K.5); returns u.
///   I_n = I_(n-1) + (e_n + e_(n-1)) / 2 h
///   u_n = kp e_n + ki I_n + kd (e_n - e_(n-1)) / h
/// Source: NTRT's tgPIDController, the same but for its choice of signs. Nothing bounds I.
template <class Real>
constexpr Real StepPid(const Pid<Real>& pid, PidState<Real>& state, Real error,
                       Real period_s) noexcept {
  state.integral = state.integral + (error + state.error_before) * (Literal<Real>(0.5f) * period_s);
  const Real before = state.error_before;
  state.error_before = error;
  const Real u = pid.proportional * error + pid.integral * state.integral;
  // a board has no time for a division that a gain of 0 makes nothing of
  const Real zero = Literal<Real>(0.0f);
  if (!Any((pid.derivative > zero) | (pid.derivative < zero))) return u;
  return u + pid.derivative * ((error - before) / period_s);
}

/// The range of an actuator.
template <class Real>
struct OutputLimits {
  Real low, high;  ///< low <= high.
};

/// What becomes of the integral while the output is at a limit.
enum class Windup : unsigned char {
  kAllowed,  ///< It goes on growing, as in tgPIDController.
  kHeld,     ///< It stands still as long as integrating on would push further past the limit.
};

/// One tick with a bounded output (eq. K.5 and K.6); returns u, low <= u <= high.
template <class Real>
constexpr Real StepPidLimited(const Pid<Real>& pid, PidState<Real>& state, Real error,
                              Real period_s, const OutputLimits<Real>& limits,
                              Windup windup) noexcept {
  const Real integral_before = state.integral;
  const Real u = StepPid(pid, state, error, period_s);
  if (windup == Windup::kAllowed) return Clamp(u, limits.low, limits.high);
  if (!Any((u > limits.high) | (u < limits.low))) return u;  // what follows would change nothing

  const Real zero = Literal<Real>(0.0f);
  const Real push = pid.integral * (state.integral - integral_before);
  const auto held = ((u > limits.high) & (push > zero)) | ((u < limits.low) & (push < zero));
  state.integral = Select(held, integral_before, state.integral);
  return Clamp(Select(held, u - push, u), limits.low, limits.high);
}

}  // namespace control
}  // namespace taut
