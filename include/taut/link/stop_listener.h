/// Emergency stop requests from other programs: the driving program answers on a socket that is
/// named after the device. Any user of the machine may send a request, in any session or runtime
/// folder. (`PortUse` ensures that only one program drives.)
///
/// Threads: use an object from one thread at a time.
#pragma once

#include <memory>
#include <string>

#include "taut/diagnostics.h"

namespace taut::link {

/// Result of a stop request to the program that drives a robot.
enum class StopAnswer {
  kNobody,       ///< No program drives it.
  kSilent,       ///< A program drives it, but did not answer in time.
  kUnconfirmed,  ///< The stop was sent; some boards did not confirm it.
  kStopped,      ///< All boards confirmed the stop.
};

/// Server side, in the driving program.
class StopListener {
 public:
  /// Opens the socket. Returns null, with a diagnostic, if it cannot be created or another program
  /// uses it.
  static std::unique_ptr<StopListener> Open(const std::string& device, Diagnostics& out);
  ~StopListener();
  StopListener(const StopListener&) = delete;
  StopListener& operator=(const StopListener&) = delete;

  /// Returns whether another program has requested an emergency stop since the last call. Does not
  /// wait.
  bool StopAsked();
  /// Answers all pending requests with kStopped or kUnconfirmed.
  void Answer(StopAnswer answer);

 private:
  explicit StopListener(int socket);

  int socket_;
  struct Askers;
  std::unique_ptr<Askers> askers_;
};

/// Sends a stop request to the program that drives the robot at a device, and waits for the answer,
/// at most `patience_s`.
StopAnswer AskToStop(const std::string& device, double patience_s);

}  // namespace taut::link
