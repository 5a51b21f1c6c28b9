#include "plant/lane_controllers.h"

#include <algorithm>

#include "plant/controllers.h"

namespace taut::plant {

LaneController::LaneController(const std::vector<const ControllerSpec*>& lanes,
                               const RobotSpec& robot)
    : kernel_(LaneKernelOf(static_cast<int>(lanes.size()))),
      clock_{lanes[0]->clock.period_s, lanes[0]->clock.phase_s} {
  for (const PositionProgram& program : lanes[0]->position) {
    Program& own = programs_.emplace_back();
    own.cable = program.cable;
    for (const auto& [time_s, length_m] : program.rest_length_m) {
      own.points.push_back({time_s, length_m});
    }
  }
  if (!lanes[0]->impedance) return;
  law_ = LawOf(*lanes[0]->impedance, lanes[0]->clock);
  for (std::size_t i = 0; i < lanes[0]->impedance->cables.size(); ++i) {
    cables_.push_back(lanes[0]->impedance->cables[i].cable);
    for (const ControllerSpec* lane : lanes) {
      const ImpedanceGains& gains = lane->impedance->cables[i];
      tension_offset_n_.push_back(gains.tension_offset_n);
      length_offset_m_.push_back(gains.length_offset_m);
      position_gain_.push_back(gains.position_gain_n_per_m);
      velocity_gain_.push_back(gains.velocity_gain_n_s_per_m);
      velocity_offset_.push_back(gains.velocity_offset_m_per_s);
    }
  }
  for (std::vector<double>* memory : {&error_before_, &integral_, &length_before_m_}) {
    memory->resize(tension_offset_n_.size());
  }
  if (lanes[0]->velocity_input) {
    std::vector<const GaitInputSpec*> inputs;
    for (const ControllerSpec* lane : lanes) inputs.push_back(&*lane->velocity_input);
    gait_.emplace(inputs, robot);
    for (const int cable : gait_->cables()) {
      const auto found = std::find(cables_.begin(), cables_.end(), cable);
      gait_to_gains_.push_back(static_cast<std::size_t>(found - cables_.begin()));
    }
  }
  velocity_input_ = velocity_offset_;
  SetVelocityInput();
}

double LaneController::next_tick_s() const noexcept {
  const double own_s = control::TickTime(clock_, tick_);
  return gait_ ? std::min(own_s, gait_->next_tick_s()) : own_s;
}

/// The cable's own offset and what the gait says; cables that it leaves alone get 0 from it.
void LaneController::SetVelocityInput() {
  for (std::size_t k = 0; k < velocity_input_.size(); ++k) {
    velocity_input_[k] = velocity_offset_[k] + 0.0;
  }
  const auto lanes = static_cast<std::size_t>(kernel_.lanes);
  for (std::size_t i = 0; i < gait_to_gains_.size(); ++i) {
    for (std::size_t j = 0; j < lanes; ++j) {
      const std::size_t at = gait_to_gains_[i] * lanes + j;
      velocity_input_[at] = velocity_offset_[at] + gait_->velocity_m_per_s()[i * lanes + j];
    }
  }
}

ImpedanceRows LaneController::Rows() {
  return {static_cast<int>(cables_.size()), cables_.data(),        tension_offset_n_.data(),
          length_offset_m_.data(),          position_gain_.data(), velocity_gain_.data(),
          velocity_input_.data(),           error_before_.data(),  integral_.data(),
          length_before_m_.data()};
}

void LaneController::Act(double time_s, const ReadingRows& sensed, double* target_m,
                         double* set_point_n) {
  if (gait_ && gait_->Act(time_s, sensed.tension_n)) SetVelocityInput();
  if (!control::IsDue(clock_, tick_, time_s)) return;
  if (!cables_.empty()) kernel_.impedance(law_, Rows(), sensed, target_m, set_point_n);
  for (const Program& program : programs_) {
    const double length_m =
        control::RestLengthAt(program.points.data(), program.points.size(), time_s);
    std::fill_n(target_m + program.cable * kernel_.lanes, kernel_.lanes, length_m);
  }
  law_.first_tick = false;
  ++tick_;
}

}  // namespace taut::plant
