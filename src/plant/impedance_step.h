/// One tick of impedance control of one cable: the set point, and the command that is to bring the
/// cable's tension there. Written once for one world (Real = double) and for many side by side
/// (Real = a wide number).
#pragma once

#include "taut/cable_readings.h"
#include "taut/control/impedance.h"
#include "taut/control/pid.h"
#include "taut/control/rate.h"

namespace taut::plant {

/// What all cables of a controller have in common; numbers only, so that no function of the
/// standard library is compiled for an instruction set that a machine may lack.
struct ImpedanceLaw {
  bool by_pid = false;  ///< Else by the cable's stiffness.
  bool differenced_rate = false, start_from_rest_length = false;
  bool first_tick = true;
  double proportional = 0, integral = 0, derivative = 0;  ///< Of the PID.
  double period_s = 0.001;
};

template <class Real>
struct ImpedanceMemory {
  control::PidState<Real> pid;
  control::DifferenceState<Real> difference;
};

template <class Real>
struct ImpedanceCommand {
  Real target_m, set_point_n;
};

template <class Real>
[[gnu::always_inline]] inline ImpedanceCommand<Real> StepImpedance(
    const ImpedanceLaw& law, const control::Impedance<Real>& gains, Real velocity_offset_m_per_s,
    const CableReadings<Real>& sensed, ImpedanceMemory<Real>& memory) noexcept {
  Real rate_m_per_s = sensed.rate_m_per_s;
  const Real period_s = control::FromScalar<Real>(law.period_s);
  if (law.differenced_rate) {
    if (law.first_tick) {
      memory.difference = law.start_from_rest_length
                              ? control::StartDifferenceAtRestLength(sensed.rest_length_m)
                              : control::StartDifference(sensed.length_m);
    }
    rate_m_per_s = control::StepDifference(memory.difference, sensed.length_m, period_s);
  }
  const Real floor_m = control::Literal<Real>(0.0f);
  ImpedanceCommand<Real> command;
  command.set_point_n =
      control::ImpedanceTension(gains, sensed.length_m, rate_m_per_s, velocity_offset_m_per_s);
  if (!law.by_pid) {
    command.target_m = control::TensionToRestLengthByStiffness(
        sensed.rest_length_m, sensed.elastic_n, command.set_point_n, sensed.stiffness_n_per_m,
        floor_m);
    return command;
  }
  const control::Pid<Real> pid{control::FromScalar<Real>(law.proportional),
                               control::FromScalar<Real>(law.integral),
                               control::FromScalar<Real>(law.derivative)};
  if (law.first_tick) memory.pid = control::StartPidAt(command.set_point_n - sensed.tension_n);
  const Real winding =
      control::TensionByPid(pid, memory.pid, sensed.tension_n, command.set_point_n, period_s);
  command.target_m = control::RestLengthAfter(sensed.rest_length_m, winding, period_s, floor_m);
  return command;
}

}  // namespace taut::plant
