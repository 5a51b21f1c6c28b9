#include "plant/controllers.h"

#include <algorithm>
#include <utility>

namespace taut::plant {

ImpedanceLaw LawOf(const ImpedanceSpec& spec, const ClockSpec& clock) {
  ImpedanceLaw law;
  law.by_pid = spec.conversion == TensionConversion::kPid;
  law.differenced_rate = spec.differenced_rate;
  law.start_from_rest_length = spec.start_from_rest_length;
  law.proportional = spec.pid.proportional_m_per_s_n;
  law.integral = spec.pid.integral_m_per_s2_n;
  law.derivative = spec.pid.derivative_m_per_n;
  law.period_s = clock.period_s;
  return law;
}

Controller::Controller(const ControllerSpec& spec, const RobotSpec& robot)
    : spec_(spec), clock_{spec.clock.period_s, spec.clock.phase_s} {
  if (spec_.impedance) {
    law_ = LawOf(*spec_.impedance, spec_.clock);
    memory_.resize(spec_.impedance->cables.size());
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

void Controller::ActGait(double time_s, const std::vector<CableState>& readings) {
  gait_->Act(time_s,
             [&](int cable) { return readings[static_cast<std::size_t>(cable)].tension_n; });
  for (std::size_t i = 0; i < gait_to_gains_.size(); ++i) {
    gait_velocity_m_per_s_[gait_to_gains_[i]] = gait_->velocity_m_per_s()[i];
  }
}

void Controller::Act(double time_s, const std::vector<CableState>& readings,
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
  law_.first_tick = false;
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

void Controller::ActImpedance(std::size_t i, const CableState& reading, CableCommands& commands) {
  const ImpedanceGains& gains = spec_.impedance->cables[i];
  const auto cable = static_cast<std::size_t>(gains.cable);
  double& velocity_input = commands.velocity_input_m_per_s[cable];
  velocity_input = gains.velocity_offset_m_per_s + (gait_ ? gait_velocity_m_per_s_[i] : 0.0);
  const control::Impedance<double> law{gains.tension_offset_n, gains.length_offset_m,
                                       gains.position_gain_n_per_m, gains.velocity_gain_n_s_per_m};
  const ImpedanceCommand<double> command =
      StepImpedance(law_, law, velocity_input, reading, memory_[i]);
  commands.target_m[cable] = command.target_m;
  commands.set_point_n[cable] = command.set_point_n;
}

}  // namespace taut::plant
