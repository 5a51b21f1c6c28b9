/// Virtual robot: finds or starts the emulated robot, which is another program,
/// `taut_virtual_robot`.
///
/// Threads: use an object from one thread at a time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::link {

/// Emulated robot of `--port virtual`.
class VirtualRobot {
 public:
  /// Returns the running virtual robot; null if there is none.
  static std::unique_ptr<VirtualRobot> Find(Diagnostics& out);
  /// Starts a virtual robot, which ends with this object: on a stand until its boards hold it.
  /// `arguments`: command line, such as "--model FILE". Returns null, with an error, if the program
  /// is not found, refuses its arguments, or another one is running.
  static std::unique_ptr<VirtualRobot> Start(const std::vector<std::string>& arguments,
                                             Diagnostics& out);
  ~VirtualRobot();
  VirtualRobot(const VirtualRobot&) = delete;
  VirtualRobot& operator=(const VirtualRobot&) = delete;

  const std::string& device() const { return device_; }
  /// Socket that provides the true state of the emulated robot (docs/formats/truth.md).
  const std::string& truth() const { return truth_; }
  bool is_ours() const { return process_ > 0; }  ///< Started by this object.

 private:
  VirtualRobot(const std::string& folder, int process, int says);

  std::string device_, truth_;
  int process_;
  int says_;  ///< Output of the program; only the first line is read.
};

}  // namespace taut::link
