/// Clock of a controller, with a period independent of the physics step.
#pragma once

#include <stdint.h>

namespace taut {
namespace control {

/// Clock with ticks k = 0, 1, 2, ... at (docs/theory/control.md, eq. K.1)
///   t_k = phase + k period     [s]
/// The product does not drift: after 1e7 ticks of 1 ms, its error is one rounding error; the error
/// of a sum of doubles is 1.6e-3 periods.
///
/// On a PC, `Time` is double. A microcontroller counts timer interrupts instead of using this
/// class, since a float cannot resolve milliseconds after four and a half hours.
template <class Time>
struct Clock {
  Time period_s;  ///< Time between ticks, > 0.
  Time phase_s;   ///< Time of tick 0.
};

/// Tolerance in periods within which a time counts as a tick. The tolerance is far above the
/// rounding error of the product "n steps of h" and far below any step.
template <class Time>
constexpr Time kTickTolerance = static_cast<Time>(1.0f / 65536.0f);

/// Last tick; a double represents no higher integers exactly.
constexpr int64_t kLastTick = INT64_C(1) << 53;

/// Returns the time of a tick [s].
template <class Time>
constexpr Time TickTime(const Clock<Time>& clock, int64_t tick) noexcept {
  return clock.phase_s + static_cast<Time>(tick) * clock.period_s;
}

namespace internal {

/// Returns the first tick at or after `t_s`. `t_s` may be NaN or infinite.
template <class Time>
constexpr int64_t FirstTickFrom(const Clock<Time>& clock, Time t_s) noexcept {
  const Time ticks = (t_s - clock.phase_s) / clock.period_s;
  if (!(ticks > static_cast<Time>(0))) return 0;
  if (ticks >= static_cast<Time>(kLastTick)) return kLastTick;
  // rounding may move the quotient across an integer
  const int64_t tick = static_cast<int64_t>(ticks);
  return TickTime(clock, tick) < t_s ? tick + 1 : tick;
}

}  // namespace internal

/// Returns the first tick at or after `t_s`. A tick up to kTickTolerance periods before `t_s`
/// counts as a tick at `t_s`.
template <class Time>
constexpr int64_t TickAtOrAfter(const Clock<Time>& clock, Time t_s) noexcept {
  return internal::FirstTickFrom(clock, t_s - kTickTolerance<Time> * clock.period_s);
}

/// Returns whether `tick` is due at `t_s`. A control loop must count its ticks, so that a rounding
/// error between a step's end and a tick does not run a tick twice:
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
