#include "plant/controllers.h"

#include <algorithm>
#include <utility>

#include "taut/control/impedance.h"

namespace taut::plant {

Controller::Controller(const ControllerSpec& spec, const RobotSpec& robot)
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
  if (!spec_.velocity_input || !spec_.impedance) return;
  Diagnostics heard_before;
  auto resolved = ResolveGait(spec_.velocity_input->gait, robot, heard_before);
  if (!resolved) return;
  const std::vector<ImpedanceGains>& gains = spec_.impedance->cables;
  gait_velocity_m_per_s_.resize(gains.size());
  for (const int cable : resolved->cables) {
    const auto found = std::find_if(gains.begin(), gains.end(),
                                    [&](const ImpedanceGains& g) { return g.cable == cable; });
    gait_to_gains_.push_back(static_cast<std::size_t>(found - gains.begin()));
  }
  gait_.emplace(spec_.velocity_input->gait, std::move(*resolved), spec_.velocity_input->clock);
}

double Controller::next_tick_s() const noexcept {
  const double own_s = control::TickTime(clock_, tick_);
  return gait_ ? std::min(own_s, gait_->next_tick_s()) : own_s;
}

void Controller::ActGait(double time_s, const std::vector<CableReading>& readings) {
  gait_->Act(time_s,
             [&](int cable) { return readings[static_cast<std::size_t>(cable)].tension_n; });
  for (std::size_t i = 0; i < gait_to_gains_.size(); ++i) {
    gait_velocity_m_per_s_[gait_to_gains_[i]] = gait_->velocity_m_per_s()[i];
  }
}

void Controller::Act(double time_s, const std::vector<CableReading>& readings,
                     CableCommands& commands) {
  if (gait_) ActGait(time_s, readings);
  if (!control::IsDue(clock_, tick_, time_s)) return;
  if (spec_.impedance) {
    for (std::size_t i = 0; i < spec_.impedance->cables.size(); ++i) {
      const auto cable = static_cast<std::size_t>(spec_.impedance->cables[i].cable);
      ActImpedance(i, readings[cable], commands);
    }
  }
  for (std::size_t i = 0; i < programs_.size(); ++i) {
    commands.target_m[static_cast<std::size_t>(spec_.position[i].cable)] =
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

void Controller::ActImpedance(std::size_t i, const CableReading& reading, CableCommands& commands) {
  const ImpedanceSpec& spec = *spec_.impedance;
  const ImpedanceGains& gains = spec.cables[i];
  const auto cable = static_cast<std::size_t>(gains.cable);
  double& target_m = commands.target_m[cable];
  double& set_point_n = commands.set_point_n[cable];
  double& velocity_input = commands.velocity_input_m_per_s[cable];
  velocity_input = gains.velocity_offset_m_per_s + (gait_ ? gait_velocity_m_per_s_[i] : 0.0);
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
  set_point_n = control::ImpedanceTension(law, reading.length_m, rate_m_per_s, velocity_input);
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
