/// A host that keeps bus and boards as busy as that of a walking robot does, and looks at no
/// answer: for measuring how fast the emulation is.
#pragma once

#include "apps/virtual_robot/robot.h"

namespace taut::virtual_robot {

class LoadHost {
 public:
  explicit LoadHost(Robot& robot) : robot_(robot) {}

  /// Sets the adapter's mode and arms the boards into impedance control. False: no answer.
  bool Start();
  /// 10 ms: a broadcast, then a frame of each board in as few requests as the adapter takes.
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
