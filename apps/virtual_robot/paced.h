/// Real-time operation of the virtual robot behind a pseudo-terminal.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "apps/virtual_robot/emulated_robot.h"
#include "taut/diagnostics.h"

namespace taut::virtual_robot {

struct PacedOptions {
  std::string link;  ///< Symbolic link to the terminal; may be empty.
  std::function<void(const std::string&)> on_path;  ///< Called whenever the terminal changes.
  /// Called when the emulation is late by more than `late_s`, at most once per second.
  std::function<void(double late_s)> on_late;
  double late_s = 0.05;
  /// Largest lag that the emulation catches up; the robot's time skips the rest. A driver on the
  /// same busy machine would be too slow for boards that catch up more.
  double slip_s = 1;
};

/// Runs in wall-clock time until `stop`; on a slow machine the robot's time lags and catches up, or
/// skips time beyond `slip_s`. Returns false, with an error, if no terminal is available.
bool RunPaced(Robot& robot, const PacedOptions& options, const std::atomic<bool>& stop,
              Diagnostics& out);

}  // namespace taut::virtual_robot
