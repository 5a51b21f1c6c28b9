/// USB-ISS adapter from a serial port to I2C, by Devantech: host side (usb_iss_tech,
/// usb_iss_i2c_tech).
///
/// Threads: use an object from one thread at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "taut/link/port.h"

namespace taut::link {

struct AdapterInfo {
  int module_id = 0;  ///< 7: a USB-ISS.
  /// Before 8, a byte without acknowledgment left the bus without a stop.
  int firmware_version = 0;
  int mode = 0;  ///< At the time of identification.
  std::string serial_number;
};
inline constexpr int kModuleId = 7;

/// Size of a reply, which the reply does not contain.
struct ReplyShape {
  std::size_t bytes = 1;
  /// I2C_DIRECT: `FF n` and n bytes, or `00 error`; `bytes` is ignored.
  bool direct = false;
};

class UsbIss {
 public:
  /// The port must outlive the adapter.
  explicit UsbIss(Port& port) : port_(port) {}

  // --- transfers, one at a time, without waiting -------------------------------------------------
  enum class State { kIdle, kPending, kDone, kSilent, kLost };
  /// Sends a frame, and discards remaining data of an earlier transfer. The reply is due within
  /// `patience_s`.
  void Begin(std::span<const std::uint8_t> frame, ReplyShape shape, double patience_s);
  /// Reads received bytes. kDone: `reply` is complete. kSilent: no complete reply in time. kLost:
  /// no adapter.
  State Poll();
  const Bytes& reply() const { return reply_; }
  double begun_s() const { return begun_s_; }
  double due_s() const { return due_s_; }  ///< Time at which it becomes silent without a reply.

  // --- transfers with waiting --------------------------------------------------------------------
  /// Sends a frame and returns its reply; nothing if none arrives in time.
  std::optional<Bytes> Transfer(std::span<const std::uint8_t> frame, ReplyShape shape);
  /// Returns type, version, mode and serial number of the adapter; nothing without an answer.
  std::optional<AdapterInfo> Identify();
  /// Sets the bus to 400 kHz by the adapter's hardware; also resets an adapter in a wrong state.
  bool SetMode();
  bool Test(std::uint8_t address);  ///< Returns whether a slave acknowledges this 7-bit address.
  /// Returns whether the slave acknowledged.
  bool Write(std::uint8_t address, std::span<const std::uint8_t> bytes);
  /// Reads bytes from a slave. Bytes of an absent slave are 0xff; only a checksum detects this.
  std::optional<Bytes> Read(std::uint8_t address, std::size_t size);

  Port& port() { return port_; }

  // --- frames ------------------------------------------------------------------------------------
  static Bytes WriteFrame(std::uint8_t address, std::span<const std::uint8_t> bytes);
  static Bytes ReadFrame(std::uint8_t address, std::size_t size);
  /// Returns the frame that reads several slaves, at most 16 bytes each; three of 16 bytes fill a
  /// reply.
  static Bytes ReadsFrame(std::span<const std::uint8_t> addresses, std::size_t size);

 private:
  Port& port_;
  Bytes reply_;
  ReplyShape shape_;
  State state_ = State::kIdle;
  double begun_s_ = 0, due_s_ = 0;
};

}  // namespace taut::link
