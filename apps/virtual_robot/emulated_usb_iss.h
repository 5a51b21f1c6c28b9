/// Emulated USB-ISS by Devantech, a converter from serial port to I2C, according to its
/// documentation (table and assumptions: docs/hardware/virtual_robot.md). Commands take the time of
/// their bus transfers.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/virtual_robot/i2c_bus.h"

namespace taut::virtual_robot {

using Bytes = std::vector<std::uint8_t>;

struct UsbIssOptions {
  /// Firmware version of the adapter. Before 8, a byte without acknowledgement left the bus without
  /// a stop in I2C_DIRECT.
  int firmware_version = 8;
  std::string serial_number{"00000001"};  ///< Serial number of eight characters.
  // From the host's write to the adapter's program, and back: assumed, no published values.
  Time request_latency = 250 * kMicrosecond;
  Time reply_latency = 250 * kMicrosecond;
  Time byte_gap = 0;  ///< Gap between two bytes on the bus (assumed).
};

/// The adapter. Not thread-safe.
class UsbIss {
 public:
  /// The bus must outlive the adapter.
  UsbIss(I2cBus& bus, UsbIssOptions options);

  /// Receives one write of the host. A frame that is incomplete, unknown, or arrives before the
  /// reply to the previous one is ignored without a reply.
  void Receive(Time now, std::span<const std::uint8_t> burst);
  /// Checks the bus and continues. Must be called after each `I2cBus::Step`.
  void Step(Time now);
  /// Returns the reply, once it has reached the host.
  std::optional<Bytes> TakeReply(Time now);
  /// Returns the time of the adapter's next event; `kNever` while it waits only for the bus.
  Time NextAt() const;

  /// Unplugs and reconnects the adapter: its mode and its transfer are lost.
  void PowerCycle();

  std::uint64_t ignored() const { return ignored_; }  ///< Frames without a reply.
  std::uint8_t mode() const { return mode_; }
  static constexpr std::uint8_t kPowerUpMode = 0x40;

 private:
  /// A command of a frame, ready for the bus. Without steps it is answered at once.
  struct Command {
    enum class Answer { kFixed, kStatus, kBytes, kDirect };
    Answer answer = Answer::kFixed;
    Bytes fixed;            ///< Constant answer; for `kDirect` an error code, if not empty.
    std::size_t bytes = 0;  ///< Number of bytes to read and return.
    std::vector<BusStep> steps;
    bool stop_after_nack = true;
  };
  enum class Phase { kIdle, kTravelling, kOnBus, kReplying };

  /// Parses the command at the front of `rest_` and removes it. Returns nothing if it is incomplete
  /// or unknown.
  std::optional<Command> Parse();
  std::optional<Command> ParseIss(std::span<const std::uint8_t> frame, std::size_t* used);
  std::optional<Command> ParseTransfer(std::span<const std::uint8_t> frame,
                                       std::size_t* used) const;
  Command ParseDirect(std::span<const std::uint8_t> frame) const;
  Bytes Answer(const Command& command, const BusResult& result) const;
  void NextCommand(Time now);

  I2cBus& bus_;
  UsbIssOptions options_;
  std::uint8_t mode_ = kPowerUpMode;
  Phase phase_ = Phase::kIdle;
  Time due_ = kNever;
  Bytes burst_, reply_;
  std::span<const std::uint8_t> rest_;
  Command command_;
  std::uint64_t ignored_ = 0;
};

}  // namespace taut::virtual_robot
