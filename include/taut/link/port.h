/// Byte stream to the robot's USB adapter, with its clock: a serial port in real time, or an
/// emulated robot in simulated time.
///
/// Threads: use a port from one thread at a time.
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

  /// Writes a frame without gaps, since the adapter takes a gap for its end. Returns false if the
  /// device is gone; further calls then fail until `Reopen` succeeds.
  virtual bool Write(std::span<const std::uint8_t> frame) = 0;
  /// Returns the bytes received since the last call; does not wait.
  virtual Bytes Read() = 0;
  /// Returns when bytes are available or the clock reaches `until_s`.
  virtual void Wait(double until_s) = 0;
  /// Returns the time of a monotonic clock [s].
  virtual double now_s() const = 0;

  virtual bool is_open() const = 0;
  /// Tries to reopen a device that was gone. Returns whether it succeeded.
  virtual bool Reopen() = 0;
};

/// Waits until `time_s`, also if bytes arrive.
inline void WaitUntil(Port& port, double time_s) {
  while (port.now_s() < time_s) port.Wait(time_s);
}

/// Access to a port. kDrive: exclusive access by locks on the device (flock, TIOCEXCL). They hold
/// for any user, session and runtime folder, and end with the port or the process. kStop: shared
/// with the driving program, for an emergency stop.
enum class PortUse { kDrive, kStop };

/// Opens the serial port of an adapter, such as /dev/ttyACM0, or the pseudo-terminal of a virtual
/// robot. Returns null, with a diagnostic, if it cannot be opened or another program drives the
/// robot; the diagnostic then names its process.
std::unique_ptr<Port> OpenSerialPort(const std::string& device, PortUse use, Diagnostics& out);

}  // namespace taut::link
