/// Clock of a controller, independent of the physics step.
#pragma once

#include <stdint.h>

namespace taut {
namespace control {

/// Clock with ticks k = 0, 1, 2, ... at (docs/theory/control.md, eq. K.1)
///   t_k = phase + k period     [s]
/// The product does not drift, in contrast to a sum of periods: after 1e7 ticks of 1 ms, a sum of
/// doubles is off by 1.6e-3 periods, the product by one rounding error.
///
/// `Time` is double on a PC. A microcontroller counts the interrupts of its timer and does not use
/// this class (a float cannot resolve milliseconds after four and a half hours).
template <class Time>
struct Clock {
  Time period_s;  ///< > 0.
  Time phase_s;   ///< Time of tick 0.
};

/// Tolerance within which a time counts as a tick, in periods: far above the rounding error of "n
/// steps of h" as a product, far below any step.
template <class Time>
constexpr Time kTickTolerance = static_cast<Time>(1.0f / 65536.0f);

/// Last tick: a double cannot count further.
constexpr int64_t kLastTick = INT64_C(1) << 53;

/// Returns the time of a tick [s].
template <class Time>
constexpr Time TickTime(const Clock<Time>& clock, int64_t tick) noexcept {
  return clock.phase_s + static_cast<Time>(tick) * clock.period_s;
}

namespace internal {

/// Returns the first tick that is not before `t_s` (which may be NaN or infinite).
template <class Time>
constexpr int64_t FirstTickFrom(const Clock<Time>& clock, Time t_s) noexcept {
  const Time ticks = (t_s - clock.phase_s) / clock.period_s;
  if (!(ticks > static_cast<Time>(0))) return 0;
  if (ticks >= static_cast<Time>(kLastTick)) return kLastTick;
  // rounding may have moved the quotient to either side of an integer
  const int64_t tick = static_cast<int64_t>(ticks);
  return TickTime(clock, tick) < t_s ? tick + 1 : tick;
}

}  // namespace internal

/// Returns the first tick at or after `t_s`; a time within kTickTolerance of a tick counts as the
/// tick.
template <class Time>
constexpr int64_t TickAtOrAfter(const Clock<Time>& clock, Time t_s) noexcept {
  return internal::FirstTickFrom(clock, t_s - kTickTolerance<Time> * clock.period_s);
}

/// Returns whether `tick` is due at `t_s`. A loop counts its ticks, so that none is processed twice
/// if the end of a step and a tick differ by one rounding error:
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
