/// One program at a time drives a robot, and any other of the same user may stop it.
///
/// Threads: an object belongs to one at a time.
#pragma once

#include <memory>
#include <string>

#include "taut/diagnostics.h"

namespace taut::link {

/// The right to drive the robot at a device. It ends with the object or with the process.
class RobotLock {
 public:
  /// Null and a complaint, which names the other's process, if another has it.
  static std::unique_ptr<RobotLock> Take(const std::string& device, Diagnostics& out);
  ~RobotLock();
  RobotLock(const RobotLock&) = delete;
  RobotLock& operator=(const RobotLock&) = delete;

  /// Whether another program has asked for an emergency stop since the last call. Does not wait.
  bool StopAsked();
  /// Tells those who asked that it is done.
  void Stopped();

 private:
  RobotLock(std::string socket_path, int lock, int socket);

  std::string socket_path_;
  int lock_, socket_;
  struct Askers;
  std::unique_ptr<Askers> askers_;
};

/// What became of asking whoever drives the robot at a device to stop.
enum class StopAnswer {
  kNobody,  ///< No program drives it.
  kSilent,  ///< One does, and did not say in time that it has stopped.
  kStopped,
};
StopAnswer AskToStop(const std::string& device, double patience_s, Diagnostics& out);

}  // namespace taut::link
