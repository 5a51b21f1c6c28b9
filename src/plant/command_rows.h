/// Memory for the rows of `Commands`, for plants that do not store them elsewhere.
#pragma once

#include <cstddef>
#include <vector>

#include "taut/lane_state.h"
#include "taut/plant.h"

namespace taut::plant {

class CommandRows {
 public:
  /// `has_duty`: whether the plant accepts duties.
  CommandRows(std::size_t cables, std::size_t lanes, bool has_duty = false)
      : lanes_(lanes),
        set_point_n_(cables * lanes),
        velocity_input_m_per_s_(cables * lanes),
        signal_(cables * lanes),
        duty_(has_duty ? cables * lanes : 0),
        mode_(cables * lanes, CommandMode::kRestLength),
        gait_(lanes, -1) {}

  /// Returns commands that use `rest_length_m` as the row of rest lengths. Valid until this object
  /// is moved or destroyed.
  Commands With(double* rest_length_m) {
    return {static_cast<int>(lanes_),
            rest_length_m,
            set_point_n_.data(),
            velocity_input_m_per_s_.data(),
            signal_.data(),
            mode_.data(),
            gait_.data(),
            duty_.empty() ? nullptr : duty_.data()};
  }

  /// Resets the commands of a lane to their initial values, except the rest lengths.
  void Restart(int lane) {
    const auto j = static_cast<std::size_t>(lane);
    gait_[j] = -1;
    for (std::size_t i = j; i < mode_.size(); i += lanes_) {
      set_point_n_[i] = velocity_input_m_per_s_[i] = signal_[i] = 0;
      if (!duty_.empty()) duty_[i] = 0;
      mode_[i] = CommandMode::kRestLength;
    }
  }

  /// Serializes the commands of a lane, except the rest lengths.
  void Serialize(LaneState& state) {
    for (std::vector<double>* row : {&set_point_n_, &velocity_input_m_per_s_, &signal_, &duty_}) {
      state.Row(*row);
    }
    state.Row(mode_);
    state.Row(gait_);
  }

  const std::vector<CommandMode>& mode() const noexcept { return mode_; }
  const std::vector<double>& duty() const noexcept { return duty_; }  ///< Empty: no duties.

 private:
  std::size_t lanes_;
  std::vector<double> set_point_n_, velocity_input_m_per_s_, signal_, duty_;
  std::vector<CommandMode> mode_;
  std::vector<int> gait_;
};

}  // namespace taut::plant
