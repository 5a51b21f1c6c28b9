/// Position control: rest lengths follow a program, a given function of time (points with linear
/// interpolation).
///
/// Mirletz et al. 2015 use position control "at startup to set the initial length of each cable and
/// to maintain the balance of all three segments". Their boards receive motor angles. taut commands
/// rest lengths: the motor angle times the radius of the spool.
#pragma once

#include <stddef.h>

#include "taut/control/pid.h"
#include "taut/control/real.h"

namespace taut {
namespace control {

/// Point of a program: a time and a rest length.
template <class Real, class Time = Real>
struct ProgramPoint {
  Time time_s;
  Real rest_length_m;
};

/// Returns the rest length of the program at `t_s` [m] (docs/theory/control.md, eq. K.10). The
/// program is linear between the points, constant before the first and after the last one. Two
/// points at the same time are a jump; the later point applies at that time. `count` >= 1; times
/// must not decrease.
template <class Real, class Time>
constexpr Real RestLengthAt(const ProgramPoint<Real, Time>* points, size_t count,
                            Time t_s) noexcept {
  if (!(t_s >= points[0].time_s)) return points[0].rest_length_m;
  size_t last = 0;
  while (last + 1 < count && points[last + 1].time_s <= t_s) ++last;
  if (last + 1 == count) return points[last].rest_length_m;

  const ProgramPoint<Real, Time>& from = points[last];
  const ProgramPoint<Real, Time>& to = points[last + 1];
  const Time part = (t_s - from.time_s) / (to.time_s - from.time_s);
  return from.rest_length_m + (to.rest_length_m - from.rest_length_m) * FromScalar<Real>(part);
}

/// Returns the rate of the rest length [m/s] from a PID controller of the rest length error,
/// limited to +-`max_speed_m_per_s` (eq. K.11). Used on boards that can command only a winding
/// rate. The gains are assumptions of taut, because that paper contains none.
template <class Real>
constexpr Real RestLengthByPid(const Pid<Real>& pid, PidState<Real>& state, Real rest_length_m,
                               Real set_point_m, Real period_s, Real max_speed_m_per_s,
                               Windup windup) noexcept {
  const OutputLimits<Real> limits{-max_speed_m_per_s, max_speed_m_per_s};
  return StepPidLimited(pid, state, set_point_m - rest_length_m, period_s, limits, windup);
}

}  // namespace control
}  // namespace taut
