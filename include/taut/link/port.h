/// Byte stream to the USB adapter of the robot, with a clock: a serial port in real time, or an
/// emulated robot in simulated time.
///
/// Threads: only one thread at a time may use a port.
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

  /// Writes a frame without time gaps, because a gap ends the frame for the adapter. Returns false
  /// if the device is missing; further calls then fail until `Reopen` succeeds.
  virtual bool Write(std::span<const std::uint8_t> frame) = 0;
  /// Returns the bytes received since the last call, without waiting.
  virtual Bytes Read() = 0;
  /// Waits until bytes are available or the clock reaches `until_s`.
  virtual void Wait(double until_s) = 0;
  /// Returns the time of a monotonic clock [s].
  virtual double now_s() const = 0;

  virtual bool is_open() const = 0;
  /// Tries to reopen a missing device. Returns whether this succeeded.
  virtual bool Reopen() = 0;
};

/// Waits until `time_s`, even if bytes arrive.
inline void WaitUntil(Port& port, double time_s) {
  while (port.now_s() < time_s) port.Wait(time_s);
}

/// Kind of access to a port. kDrive: exclusive, by locks on the device (flock, TIOCEXCL). The locks
/// apply to all users, sessions and runtime folders, and end with the port or the process. kStop:
/// shared with the driving program, for an emergency stop.
enum class PortUse { kDrive, kStop };

/// Opens the serial port of an adapter, such as /dev/ttyACM0, or the pseudo-terminal of a virtual
/// robot. Returns null and adds an error if the port cannot be opened, or if another program drives
/// the robot. In the second case, the error names the process of that program.
std::unique_ptr<Port> OpenSerialPort(const std::string& device, PortUse use, Diagnostics& out);

}  // namespace taut::link
