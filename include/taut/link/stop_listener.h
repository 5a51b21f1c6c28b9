/// Emergency stop requests from other programs. The program that drives a robot listens on a socket
/// named after the device. Any user of the machine may send a request, from any session or runtime
/// folder. `PortUse` ensures that only one program drives a robot.
///
/// Threads: only one thread at a time may use an object.
#pragma once

#include <memory>
#include <string>

#include "taut/diagnostics.h"

namespace taut::link {

/// Reply to a stop request.
enum class StopAnswer {
  kNobody,       ///< No program drives the robot.
  kSilent,       ///< A program drives the robot but did not reply in time.
  kUnconfirmed,  ///< The stop was sent, but some boards did not confirm it.
  kStopped,      ///< All boards confirmed the stop.
};

/// Server, for the driving program.
class StopListener {
 public:
  /// Opens the socket. Returns null and adds an error if it cannot be created or another program
  /// uses it.
  static std::unique_ptr<StopListener> Open(const std::string& device, Diagnostics& out);
  ~StopListener();
  StopListener(const StopListener&) = delete;
  StopListener& operator=(const StopListener&) = delete;

  /// Returns whether another program has requested an emergency stop since the last call, without
  /// waiting.
  bool StopAsked();
  /// Replies kStopped or kUnconfirmed to all pending requests.
  void Answer(StopAnswer answer);

 private:
  explicit StopListener(int socket);

  int socket_;
  struct Askers;
  std::unique_ptr<Askers> askers_;
};

/// Sends a stop request to the program that drives the robot at a device. Waits for the reply, at
/// most `patience_s`.
StopAnswer AskToStop(const std::string& device, double patience_s);

}  // namespace taut::link
