/// The robot in real time behind a pseudo-terminal.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "apps/virtual_robot/robot.h"
#include "taut/diagnostics.h"

namespace taut::virtual_robot {

struct PacedOptions {
  std::string link;  ///< Symbolic link to the terminal; may be empty.
  std::function<void(const std::string&)> on_path;  ///< Whenever the terminal is another one.
  /// Told when the emulation is late by more than `late_s`, at most once a second.
  std::function<void(double late_s)> on_late;
  double late_s = 0.05;
  /// By more than this the robot's time does not catch up but leaves out: for who drives it from
  /// the same busy machine, and would be late for boards that hurry.
  double slip_s = 1;
};

/// Runs until `stop`, as fast as the clock on the wall; where the machine cannot, the robot's time
/// is late and catches up, or, beyond `slip_s`, leaves out. False and a complaint if there is no
/// terminal to be had.
bool RunPaced(Robot& robot, const PacedOptions& options, const std::atomic<bool>& stop,
              Diagnostics& out);

}  // namespace taut::virtual_robot
