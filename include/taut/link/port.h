/// Bytes to the robot's USB adapter and back, and the clock that they come by: a serial port in
/// real time, or an emulated robot in its own.
///
/// Threads: a port belongs to one at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::link {

using Bytes = std::vector<std::uint8_t>;

class Port {
 public:
  virtual ~Port() = default;

  /// All of it at one go: the adapter takes a gap for the end of a frame. False: nobody is there
  /// any more; what follows fails, too, until `Reopen` succeeds.
  virtual bool Write(std::span<const std::uint8_t> frame) = 0;
  /// What has come since the last call; does not wait.
  virtual Bytes Read() = 0;
  /// Returns when bytes are there or the clock shows `until_s`.
  virtual void Wait(double until_s) = 0;
  /// Never goes back, whatever the calendar does [s].
  virtual double now_s() const = 0;

  virtual bool is_open() const = 0;
  /// The device went and may be there again.
  virtual bool Reopen() = 0;
};

/// Lets time pass, whatever comes.
inline void WaitUntil(Port& port, double time_s) {
  while (port.now_s() < time_s) port.Wait(time_s);
}

/// kDrive: exclusive access by locks on the device (flock, TIOCEXCL). They hold for any user,
/// session and runtime folder, and end with the port or the process. kStop: shared with the driving
/// program, for an emergency stop.
enum class PortUse { kDrive, kStop };

/// The serial port of an adapter, such as /dev/ttyACM0, or the pseudo-terminal of a virtual robot.
/// Null and a diagnostic if it cannot be opened or another program drives the robot; the diagnostic
/// then names its process.
std::unique_ptr<Port> OpenSerialPort(const std::string& device, PortUse use, Diagnostics& out);

}  // namespace taut::link
