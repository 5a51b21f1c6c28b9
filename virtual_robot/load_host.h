/// A host that does what a robot's host does to bus and boards, and looks at no answer: for
/// measuring.
#pragma once

#include "virtual_robot/robot.h"

namespace taut::virtual_robot {

class LoadHost {
 public:
  explicit LoadHost(Robot& robot) : robot_(robot) {}

  /// Sets the adapter's mode. False: no answer.
  bool Start();
  /// Every 10 ms: a broadcast of 29 bytes, then 16 bytes of each board.
  void Cycle();

  double mean_cycle_s() const { return cycles_ > 0 ? sum_s_ / cycles_ : 0.0; }
  double longest_cycle_s() const { return longest_s_; }

 private:
  Robot& robot_;
  std::uint8_t sequence_ = 0;
  int cycles_ = 0;
  double sum_s_ = 0, longest_s_ = 0;
};

}  // namespace taut::virtual_robot
