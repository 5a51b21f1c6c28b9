/// When a controller acts. A controller owns its clock; the physics step has no say in it.
#pragma once

#include <stdint.h>

namespace taut {
namespace control {

/// Tick k, k = 0, 1, 2, ..., is at (docs/theory/control.md, eq. K.1)
///   t_k = phase + k period     [s]
/// by multiplication and never by adding periods up, so that it does not drift: after 1e7 ticks
/// of 1 ms a sum of doubles is 1.6e-3 of a period off, this is off by one rounding.
///
/// `Time` is double on a PC. A microcontroller counts the interrupts of its timer and needs none
/// of this (a float cannot tell milliseconds apart after four and a half hours).
template <class Time>
struct Clock {
  Time period_s;  ///< > 0.
  Time phase_s;   ///< Of tick 0.
};

/// How close to a tick a time counts as the tick, in periods: far more than the rounding of a
/// time that is "n steps of h" by multiplication, far less than any step.
template <class Time>
constexpr Time kTickTolerance = static_cast<Time>(1.0f / 65536.0f);

/// Ticks beyond this one do not exist: a double cannot count further.
constexpr int64_t kLastTick = INT64_C(1) << 53;

template <class Time>
constexpr Time TickTime(const Clock<Time>& clock, int64_t tick) noexcept {
  return clock.phase_s + static_cast<Time>(tick) * clock.period_s;
}

namespace internal {

/// The first tick that is not before `t_s` (which may be NaN or infinite).
template <class Time>
constexpr int64_t FirstTickFrom(const Clock<Time>& clock, Time t_s) noexcept {
  const Time ticks = (t_s - clock.phase_s) / clock.period_s;
  if (!(ticks > static_cast<Time>(0))) return 0;
  if (ticks >= static_cast<Time>(kLastTick)) return kLastTick;
  // rounding may have put the quotient on either side of a whole number
  const int64_t tick = static_cast<int64_t>(ticks);
  return TickTime(clock, tick) < t_s ? tick + 1 : tick;
}

}  // namespace internal

/// The first tick at or after `t_s`; a time within kTickTolerance of a tick is at the tick.
template <class Time>
constexpr int64_t TickAtOrAfter(const Clock<Time>& clock, Time t_s) noexcept {
  return internal::FirstTickFrom(clock, t_s - kTickTolerance<Time> * clock.period_s);
}

/// Whether `tick` is to act by now. A loop counts its ticks, so that none acts twice where the end
/// of a step and a tick are one rounding apart:
///
///   int64_t tick = TickAtOrAfter(clock, t_s);
///   ...
///   if (IsDue(clock, tick, t_s)) { Act(); ++tick; }
template <class Time>
constexpr bool IsDue(const Clock<Time>& clock, int64_t tick, Time t_s) noexcept {
  return t_s >= TickTime(clock, tick) - kTickTolerance<Time> * clock.period_s;
}

}  // namespace control
}  // namespace taut
