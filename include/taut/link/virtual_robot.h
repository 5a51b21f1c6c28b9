/// Virtual robot: finds or starts the emulated robot, a separate program `taut_virtual_robot`.
///
/// Threads: only one thread at a time may use an object.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::link {

/// Emulated robot for `--port virtual`.
class VirtualRobot {
 public:
  /// Returns the running virtual robot, or null.
  static std::unique_ptr<VirtualRobot> Find(Diagnostics& out);
  /// Starts a virtual robot, which ends with this object. The robot stands on a support until its
  /// boards hold it. `arguments`: command line, such as "--model FILE". Returns null and adds an
  /// error if the program is not found, rejects its arguments, or already runs.
  static std::unique_ptr<VirtualRobot> Start(const std::vector<std::string>& arguments,
                                             Diagnostics& out);
  ~VirtualRobot();
  VirtualRobot(const VirtualRobot&) = delete;
  VirtualRobot& operator=(const VirtualRobot&) = delete;

  const std::string& device() const { return device_; }
  /// Socket with the true state of the emulated robot (docs/formats/truth.md).
  const std::string& truth() const { return truth_; }
  bool is_ours() const { return process_ > 0; }  ///< True if this object started the program.

 private:
  VirtualRobot(const std::string& folder, int process, int says);

  std::string device_, truth_;
  int process_;
  int says_;  ///< Output of the program; only its first line is read.
};

}  // namespace taut::link
