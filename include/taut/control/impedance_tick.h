/// One tick of impedance control of a cable: sensing, impedance law and optional tension PID. The
/// simulation (`Real` = double, or a SIMD type with one world per lane) and the boards (float)
/// compile the same source.
#pragma once

#include "taut/control/impedance.h"
#include "taut/control/pid.h"
#include "taut/control/rate.h"
#include "taut/control/real.h"

namespace taut {
namespace control {

/// Parameters for all cables of a controller. Plain numbers, so that no standard library function
/// is compiled for an instruction set that a machine may lack.
struct ImpedanceLaw {
  bool by_pid = false;  ///< Tension control by PID instead of by the cable's stiffness.
  bool differenced_rate = false, start_from_rest_length = false;
  bool first_tick = true;
  double proportional = 0, integral = 0, derivative = 0;  ///< PID gains.
  double period_s = 0.001;
};

/// State of one cable's controller between ticks.
template <class Real>
struct ImpedanceMemory {
  PidState<Real> pid;
  DifferenceState<Real> difference;
};

/// Commanded rest length and tension set point.
template <class Real>
struct ImpedanceCommand {
  Real target_m, set_point_n;
};

/// Computes the command of one tick. `sensed` has the fields of `CableReadings` that the law uses:
/// rest_length_m, length_m, tension_n, elastic_n, stiffness_n_per_m and rate_m_per_s.
template <class Real, class Readings>
[[gnu::always_inline]] inline ImpedanceCommand<Real> StepImpedance(
    const ImpedanceLaw& law, const Impedance<Real>& gains, Real velocity_offset_m_per_s,
    const Readings& sensed, ImpedanceMemory<Real>& memory) noexcept {
  Real rate_m_per_s = sensed.rate_m_per_s;
  const Real period_s = FromScalar<Real>(law.period_s);
  if (law.differenced_rate) {
    if (law.first_tick) {
      memory.difference = law.start_from_rest_length
                              ? StartDifferenceAtRestLength(sensed.rest_length_m)
                              : StartDifference(sensed.length_m);
    }
    rate_m_per_s = StepDifference(memory.difference, sensed.length_m, period_s);
  }
  const Real floor_m = Literal<Real>(0.0f);
  ImpedanceCommand<Real> command;
  command.set_point_n =
      ImpedanceTension(gains, sensed.length_m, rate_m_per_s, velocity_offset_m_per_s);
  if (!law.by_pid) {
    command.target_m =
        TensionToRestLengthByStiffness(sensed.rest_length_m, sensed.elastic_n, command.set_point_n,
                                       sensed.stiffness_n_per_m, floor_m);
    return command;
  }
  const Pid<Real> pid{FromScalar<Real>(law.proportional), FromScalar<Real>(law.integral),
                      FromScalar<Real>(law.derivative)};
  if (law.first_tick) memory.pid = StartPidAt(command.set_point_n - sensed.tension_n);
  const Real winding =
      TensionByPid(pid, memory.pid, sensed.tension_n, command.set_point_n, period_s);
  command.target_m = RestLengthAfter(sensed.rest_length_m, winding, period_s, floor_m);
  return command;
}

}  // namespace control
}  // namespace taut
