/// The USB-ISS of Devantech, a converter from a serial port to a two-wire bus, as its documents
/// describe it (docs/hardware/virtual_robot.md has the table, and what of it is assumed). Bytes in,
/// bytes out; what it does on the bus takes the time that it takes there.
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
  /// Of the adapter's own program. Before 8, a byte that nobody acknowledged left the bus without a
  /// stop in I2C_DIRECT.
  int firmware_version = 8;
  std::string serial_number{"00000001"};  ///< Eight characters.
  // From the host's write to the adapter's program, and back [?]: nobody has published numbers.
  Time request_latency = 250 * kMicrosecond;
  Time reply_latency = 250 * kMicrosecond;
  Time byte_gap = 0;  ///< Between two bytes on the bus [?].
};

/// One thread calls it.
class UsbIss {
 public:
  /// The bus outlives it.
  UsbIss(I2cBus& bus, UsbIssOptions options);

  /// What the host wrote at one go. A frame that is not complete, or that nobody knows, is ignored
  /// without a reply, and so is one that comes before the reply to the last.
  void Receive(Time now, std::span<const std::uint8_t> burst);
  /// Looks at the bus and goes on. Called after each `I2cBus::Step`.
  void Step(Time now);
  /// The reply, once it has reached the host.
  std::optional<Bytes> TakeReply(Time now);
  /// When something happens next by itself; `kNever` while only the bus is waited for.
  Time NextAt() const;

  /// It was pulled out and put in again: it forgets its mode, and what it was about.
  void PowerCycle();

  std::uint64_t ignored() const { return ignored_; }  ///< Frames without a reply.
  std::uint8_t mode() const { return mode_; }
  static constexpr std::uint8_t kPowerUpMode = 0x40;

 private:
  /// A command of a frame, ready for the bus. Without steps it is answered at once.
  struct Command {
    enum class Answer { kFixed, kStatus, kBytes, kDirect };
    Answer answer = Answer::kFixed;
    Bytes fixed;            ///< The answer; of `kDirect` an error, if not empty.
    std::size_t bytes = 0;  ///< To read: as many are answered.
    std::vector<BusStep> steps;
    bool stop_after_nack = true;
  };
  enum class Phase { kIdle, kTravelling, kOnBus, kReplying };

  /// The command at the front of `rest_`, which gets shorter. Nothing: not complete, or unknown.
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
