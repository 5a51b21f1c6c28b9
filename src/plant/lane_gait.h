/// A gait at work in the worlds of a group, side by side. Their gaits differ in numbers only. Same
/// bits as `GaitPlayer` gives each alone.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <vector>

#include "plant/gait_player.h"
#include "plant/lane_kernel.h"
#include "taut/control/clock.h"
#include "taut/spec.h"

namespace taut::plant {

class LaneGait {
 public:
  /// One velocity input a lane. The robot is where the gait's cables are.
  LaneGait(const std::vector<const GaitInputSpec*>& lanes, const RobotSpec& robot);

  const std::vector<int>& cables() const noexcept { return cables_; }  ///< Per output.
  double next_tick_s() const noexcept { return control::TickTime(clock_, tick_); }

  /// Acts if a tick is due: true if it was. `tension_n`: cable c of lane j at [c * lanes + j].
  bool Act(double time_s, const double* tension_n);

  /// Of output i in lane j, at [i * lanes + j]: V0 since the last tick, 0 before the first [m/s].
  const std::vector<double>& velocity_m_per_s() const noexcept { return velocity_m_per_s_; }

 private:
  struct Free {
    void operator()(void* p) const noexcept { std::free(p); }
  };
  void AddSine(const std::vector<ResolvedGait>& lanes);
  void AddCpg(const std::vector<const GaitInputSpec*>& specs,
              const std::vector<ResolvedGait>& lanes);

  const LaneKernel& kernel_;
  control::Clock<double> clock_;
  std::int64_t tick_ = 0;
  std::vector<int> cables_;
  std::vector<double> velocity_m_per_s_;

  std::vector<double> frequency_hz_, amplitude_m_per_s_, phase_turns_, offset_m_per_s_;
  bool is_sine_ = false;

  std::vector<double> sign_, gain_rad_per_n_s_, reference_n_, signal_rad_per_s_;
  bool wants_tensions_ = false;
  std::unique_ptr<void, Free> cpg_;
  int coupling_count_ = 0, steps_a_tick_ = 0;
  double integrator_step_s_ = 0;

  std::optional<GaitPlayer> table_;  ///< The same for all.
};

}  // namespace taut::plant
