#include "plant/lane_controllers.h"

#include <algorithm>

#include "plant/controllers.h"

namespace taut::plant {

LaneController::LaneController(const std::vector<const ControllerSpec*>& lanes)
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
}

double LaneController::next_tick_s() const noexcept { return control::TickTime(clock_, tick_); }

ImpedanceRows LaneController::Rows() {
  return {static_cast<int>(cables_.size()), cables_.data(),        tension_offset_n_.data(),
          length_offset_m_.data(),          position_gain_.data(), velocity_gain_.data(),
          velocity_offset_.data(),          error_before_.data(),  integral_.data(),
          length_before_m_.data()};
}

void LaneController::Act(double time_s, const ReadingRows& sensed, double* target_m,
                         double* set_point_n) {
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
