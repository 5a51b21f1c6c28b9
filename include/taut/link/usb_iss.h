/// The PC's side of a USB-ISS, Devantech's adapter from a serial port to a two-wire bus
/// (usb_iss_tech, usb_iss_i2c_tech).
///
/// Threads: belongs to one at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "taut/link/port.h"

namespace taut::link {

struct AdapterInfo {
  int module_id = 0;         ///< 7: a USB-ISS.
  int firmware_version = 0;  ///< Before 8 a byte that nobody took left the bus without a stop.
  int mode = 0;              ///< As it was when it was asked.
  std::string serial_number;
};
inline constexpr int kModuleId = 7;

/// How a reply ends, which nothing in it says.
struct ReplyShape {
  std::size_t bytes = 1;
  bool direct =
      false;  ///< Of I2C_DIRECT: `FF n` and n bytes, or `00 error`; `bytes` does not count.
};

class UsbIss {
 public:
  /// The port outlives it.
  explicit UsbIss(Port& port) : port_(port) {}

  // --- one transfer at a time, without waiting ---------------------------------------------------
  enum class State { kIdle, kPending, kDone, kSilent, kLost };
  /// Sends a frame; what a transfer before it left is forgotten. The reply is due within
  /// `patience_s`.
  void Begin(std::span<const std::uint8_t> frame, ReplyShape shape, double patience_s);
  /// kDone: `reply` is there. kSilent: none came in time. kLost: there is no adapter.
  State Poll();
  const Bytes& reply() const { return reply_; }
  double begun_s() const { return begun_s_; }
  double due_s() const { return due_s_; }  ///< When it is silent, if nothing comes.

  // --- and with waiting --------------------------------------------------------------------------
  std::optional<Bytes> Transfer(std::span<const std::uint8_t> frame, ReplyShape shape);
  std::optional<AdapterInfo> Identify();
  /// The bus at 400 kHz by the adapter's hardware; also what makes a confused adapter well.
  bool SetMode();
  bool Test(std::uint8_t address);  ///< Whether anybody acknowledges it; 7 bits.
  bool Write(std::uint8_t address, std::span<const std::uint8_t> bytes);  ///< Acknowledged.
  /// What an absent slave would have sent is 0xff: only a checksum tells.
  std::optional<Bytes> Read(std::uint8_t address, std::size_t size);

  Port& port() { return port_; }

  // --- frames ------------------------------------------------------------------------------------
  static Bytes WriteFrame(std::uint8_t address, std::span<const std::uint8_t> bytes);
  static Bytes ReadFrame(std::uint8_t address, std::size_t size);
  /// Reads of several slaves in one frame, <= 16 bytes each; three of 16 fill a reply.
  static Bytes ReadsFrame(std::span<const std::uint8_t> addresses, std::size_t size);

 private:
  Port& port_;
  Bytes reply_;
  ReplyShape shape_;
  State state_ = State::kIdle;
  double begun_s_ = 0, due_s_ = 0;
};

}  // namespace taut::link
