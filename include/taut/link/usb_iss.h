/// Host side of the USB-ISS adapter by Devantech, from a serial port to I2C (Devantech's documents
/// usb_iss_tech and usb_iss_i2c_tech).
///
/// Threads: only one thread at a time may use an object.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "taut/link/port.h"

namespace taut::link {

struct AdapterInfo {
  int module_id = 0;  ///< 7 identifies a USB-ISS.
  /// Versions before 8 send no stop condition after a byte without acknowledgment.
  int firmware_version = 0;
  int mode = 0;  ///< Mode at the time of identification.
  std::string serial_number;
};
inline constexpr int kModuleId = 7;

/// Size of a reply, which the reply itself does not contain.
struct ReplyShape {
  std::size_t bytes = 1;
  /// I2C_DIRECT: `FF n` and n bytes, or `00 error`; `bytes` is ignored.
  bool direct = false;
};

class UsbIss {
 public:
  /// `port` must outlive the adapter.
  explicit UsbIss(Port& port) : port_(port) {}

  // --- transfers without waiting, one at a time ------------------------------------------------
  enum class State { kIdle, kPending, kDone, kSilent, kLost };
  /// Sends a frame and discards remaining data of an earlier transfer. The reply must arrive within
  /// `patience_s`.
  void Begin(std::span<const std::uint8_t> frame, ReplyShape shape, double patience_s);
  /// Processes received bytes. kDone: `reply` is complete. kSilent: no complete reply in time.
  /// kLost: the adapter is missing.
  State Poll();
  const Bytes& reply() const { return reply_; }
  double begun_s() const { return begun_s_; }
  double due_s() const { return due_s_; }  ///< Time at which the reply is overdue (kSilent).

  // --- transfers with waiting --------------------------------------------------------------------
  /// Sends a frame and returns its reply; nothing if none arrives in time.
  std::optional<Bytes> Transfer(std::span<const std::uint8_t> frame, ReplyShape shape);
  /// Returns module id, version, mode and serial number of the adapter; nothing without a reply.
  std::optional<AdapterInfo> Identify();
  /// Sets the bus to 400 kHz with the I2C hardware of the adapter. Also recovers an adapter in a
  /// wrong state.
  bool SetMode();
  bool Test(std::uint8_t address);  ///< Returns whether a slave at this 7-bit address acknowledges.
  /// Writes bytes to a slave. Returns whether the slave acknowledged all bytes.
  bool Write(std::uint8_t address, std::span<const std::uint8_t> bytes);
  /// Reads bytes from a slave. An absent slave reads as 0xff, which only a checksum detects.
  std::optional<Bytes> Read(std::uint8_t address, std::size_t size);

  Port& port() { return port_; }

  // --- frames ------------------------------------------------------------------------------------
  static Bytes WriteFrame(std::uint8_t address, std::span<const std::uint8_t> bytes);
  static Bytes ReadFrame(std::uint8_t address, std::size_t size);
  /// Returns a frame that reads several slaves, at most 16 bytes each. Three reads of 16 bytes fill
  /// a reply.
  static Bytes ReadsFrame(std::span<const std::uint8_t> addresses, std::size_t size);

 private:
  Port& port_;
  Bytes reply_;
  ReplyShape shape_;
  State state_ = State::kIdle;
  double begun_s_ = 0, due_s_ = 0;
};

}  // namespace taut::link
