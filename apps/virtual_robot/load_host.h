/// Synthetic host for speed measurements of the emulation: loads bus and boards like a walking
/// robot, and ignores all replies.
#pragma once

#include "apps/virtual_robot/emulated_robot.h"

namespace taut::virtual_robot {

class LoadHost {
 public:
  explicit LoadHost(Robot& robot) : robot_(robot) {}

  /// Sets the adapter's mode and arms the boards into impedance control. Returns false if there is
  /// no answer.
  bool Start();
  /// Runs a cycle of 10 ms: a broadcast, then a frame from each board in as few requests as the
  /// adapter allows.
  void Cycle();

  double mean_cycle_s() const { return cycles_ > 0 ? sum_s_ / cycles_ : 0.0; }
  double longest_cycle_s() const { return longest_s_; }

 private:
  void Exchange();

  Robot& robot_;
  std::uint8_t sequence_ = 0;
  int cycles_ = 0;
  double sum_s_ = 0, longest_s_ = 0;
};

}  // namespace taut::virtual_robot
