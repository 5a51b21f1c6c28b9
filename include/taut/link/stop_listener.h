/// Emergency stops from other programs: whoever drives a robot answers on a socket that is named
/// after the device. Any user of the machine may ask, whatever the session or runtime folder.
/// (That one program alone drives is a matter of the port: `PortUse`.)
///
/// Threads: an object belongs to one at a time.
#pragma once

#include <memory>
#include <string>

#include "taut/diagnostics.h"

namespace taut::link {

/// What became of asking the program that drives a robot to stop it.
enum class StopAnswer {
  kNobody,       ///< No program drives it.
  kSilent,       ///< One does, and did not answer in time.
  kUnconfirmed,  ///< It tried, and not all boards confirmed that their motors are off.
  kStopped,      ///< All boards confirmed it.
};

/// The driving program's end.
class StopListener {
 public:
  /// Null and a complaint if the socket cannot be made, or another program listens there.
  static std::unique_ptr<StopListener> Open(const std::string& device, Diagnostics& out);
  ~StopListener();
  StopListener(const StopListener&) = delete;
  StopListener& operator=(const StopListener&) = delete;

  /// Whether another program has asked for an emergency stop since the last call. Does not wait.
  bool StopAsked();
  /// Tells those who asked what became of it; kStopped or kUnconfirmed.
  void Answer(StopAnswer answer);

 private:
  explicit StopListener(int socket);

  int socket_;
  struct Askers;
  std::unique_ptr<Askers> askers_;
};

/// Asks the program that drives the robot at a device to stop it, and waits for the answer at most
/// `patience_s`.
StopAnswer AskToStop(const std::string& device, double patience_s);

}  // namespace taut::link
