/// The emulated robot as another program, `taut_virtual_robot`, which is found or started.
///
/// Threads: an object belongs to one at a time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::link {

/// The robot behind `--port virtual`.
class VirtualRobot {
 public:
  /// The one that runs already, if it runs; null otherwise.
  static std::unique_ptr<VirtualRobot> Find(Diagnostics& out);
  /// Starts one, which ends with this object: on a stand until its boards hold it. `arguments`:
  /// what it is to be, as "--model FILE". Null and a complaint if there is no such program, it does
  /// not take its arguments, or one runs already.
  static std::unique_ptr<VirtualRobot> Start(const std::vector<std::string>& arguments,
                                             Diagnostics& out);
  ~VirtualRobot();
  VirtualRobot(const VirtualRobot&) = delete;
  VirtualRobot& operator=(const VirtualRobot&) = delete;

  const std::string& device() const { return device_; }
  /// A socket that tells where it really is (docs/formats/truth.md).
  const std::string& truth() const { return truth_; }
  bool is_ours() const { return process_ > 0; }  ///< Started by this object.

 private:
  VirtualRobot(const std::string& folder, int process, int says);

  std::string device_, truth_;
  int process_;
  int says_;  ///< What it prints; nobody reads it after the first line.
};

}  // namespace taut::link
