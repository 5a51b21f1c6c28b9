#include "plant/controllers.h"

#include <algorithm>
#include <utility>

#include "taut/control/impedance.h"

namespace taut::plant {

Controller::Controller(const ControllerSpec& spec)
    : spec_(spec), clock_{spec.clock.period_s, spec.clock.phase_s} {
  if (spec_.impedance) {
    pid_.resize(spec_.impedance->cables.size(), control::StartPid<double>());
    difference_.resize(spec_.impedance->cables.size(), control::StartDifference(0.0));
  }
  for (const PositionProgram& program : spec_.position) {
    std::vector<control::ProgramPoint<double>> points;
    for (const auto& [time_s, length_m] : program.rest_length_m)
      points.push_back({time_s, length_m});
    programs_.push_back(std::move(points));
  }
}

double Controller::next_tick_s() const noexcept { return control::TickTime(clock_, tick_); }

void Controller::Act(double time_s, const std::vector<CableReading>& readings,
                     std::vector<double>& target_m, std::vector<double>& set_point_n) {
  if (!control::IsDue(clock_, tick_, time_s)) return;
  if (spec_.impedance) {
    for (std::size_t i = 0; i < spec_.impedance->cables.size(); ++i) {
      const auto cable = static_cast<std::size_t>(spec_.impedance->cables[i].cable);
      ActImpedance(i, readings[cable], target_m[cable], set_point_n[cable]);
    }
  }
  for (std::size_t i = 0; i < programs_.size(); ++i) {
    target_m[static_cast<std::size_t>(spec_.position[i].cable)] =
        control::RestLengthAt(programs_[i].data(), programs_[i].size(), time_s);
  }
  started_ = true;
  ++tick_;
}

const ImpedanceGains* Controller::FindGains(int cable) const noexcept {
  if (!spec_.impedance) return nullptr;
  for (const ImpedanceGains& gains : spec_.impedance->cables) {
    if (gains.cable == cable) return &gains;
  }
  return nullptr;
}

ImpedanceGains* Controller::FindGains(int cable) noexcept {
  return const_cast<ImpedanceGains*>(std::as_const(*this).FindGains(cable));
}

bool Controller::HasProgram(int cable) const noexcept {
  return std::any_of(spec_.position.begin(), spec_.position.end(),
                     [&](const PositionProgram& program) { return program.cable == cable; });
}

bool Controller::Hold(int cable, double rest_length_m) {
  for (std::size_t i = 0; i < programs_.size(); ++i) {
    if (spec_.position[i].cable != cable) continue;
    programs_[i] = {{0.0, rest_length_m}};
    return true;
  }
  return false;
}

void Controller::ActImpedance(std::size_t i, const CableReading& reading, double& target_m,
                              double& set_point_n) {
  const ImpedanceSpec& spec = *spec_.impedance;
  const ImpedanceGains& gains = spec.cables[i];
  double rate_m_per_s = reading.rate_m_per_s;
  if (spec.differenced_rate) {
    if (!started_) {
      difference_[i] = spec.start_from_rest_length
                           ? control::StartDifferenceAtRestLength(reading.rest_length_m)
                           : control::StartDifference(reading.length_m);
    }
    rate_m_per_s = control::StepDifference(difference_[i], reading.length_m, clock_.period_s);
  }
  const control::Impedance<double> law{gains.tension_offset_n, gains.length_offset_m,
                                       gains.position_gain_n_per_m, gains.velocity_gain_n_s_per_m};
  set_point_n =
      control::ImpedanceTension(law, reading.length_m, rate_m_per_s, gains.velocity_offset_m_per_s);
  if (spec.conversion == TensionConversion::kStiffness) {
    target_m = control::TensionToRestLengthByStiffness(reading.rest_length_m, reading.elastic_n,
                                                       set_point_n, reading.stiffness_n_per_m, 0.0);
    return;
  }
  const control::Pid<double> pid{spec.pid.proportional_m_per_s_n, spec.pid.integral_m_per_s2_n,
                                 spec.pid.derivative_m_per_n};
  if (!started_) pid_[i] = control::StartPidAt(set_point_n - reading.tension_n);
  const double winding =
      control::TensionByPid(pid, pid_[i], reading.tension_n, set_point_n, clock_.period_s);
  target_m = control::RestLengthAfter(reading.rest_length_m, winding, clock_.period_s, 0.0);
}

}  // namespace taut::plant
