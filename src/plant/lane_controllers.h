/// All controllers of an experiment at work in the worlds of a group, side by side. The worlds'
/// controllers differ in numbers only. Same bits as `Controller` gives each world alone.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "plant/lane_gait.h"
#include "plant/lane_kernel.h"
#include "taut/control/clock.h"
#include "taut/control/position.h"
#include "taut/spec.h"

namespace taut::plant {

/// One controller in all lanes.
class LaneController {
 public:
  /// `lanes[j]`: this controller in lane j.
  LaneController(const std::vector<const ControllerSpec*>& lanes, const RobotSpec& robot);

  double next_tick_s() const noexcept;

  /// Acts if a tick is due at `time_s`: writes the targets and set points of its cables.
  void Act(double time_s, const ReadingRows& sensed, double* target_m, double* set_point_n);

  /// Cables under impedance control.
  const std::vector<int>& driven() const noexcept { return cables_; }

 private:
  ImpedanceRows Rows();
  void SetVelocityInput();

  const LaneKernel& kernel_;
  control::Clock<double> clock_;
  std::int64_t tick_ = 0;
  ImpedanceLaw law_;
  std::vector<int> cables_;
  std::vector<double> tension_offset_n_, length_offset_m_, position_gain_, velocity_gain_,
      velocity_offset_, velocity_input_;
  std::vector<double> error_before_, integral_, length_before_m_;
  std::optional<LaneGait> gait_;
  std::vector<std::size_t> gait_to_gains_;  ///< Per output of the gait: its place in `cables_`.
  struct Program {
    int cable = 0;
    std::vector<control::ProgramPoint<double>> points;
  };
  std::vector<Program> programs_;
};

}  // namespace taut::plant
