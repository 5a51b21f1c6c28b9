#include "apps/virtual_robot/emulated_usb_iss.h"

#include <algorithm>
#include <utility>

#include "base/assert.h"

namespace taut::virtual_robot {
namespace {

// First bytes of frames.
enum Frame : std::uint8_t {
  kSingle = 0x53,
  kNoRegister = 0x54,
  kOneRegister = 0x55,
  kTwoRegisters = 0x56,
  kDirect = 0x57,
  kTest = 0x58,
  kIss = 0x5A
};
constexpr std::uint8_t kModuleId = 0x07;
constexpr std::uint8_t kAcknowledge = 0xFF, kRefusal = 0x00, kUnknownCommand = 0x05;
enum DirectError : std::uint8_t {
  kNobodyThere = 0x01,
  kOverflow = 0x02,
  kUnderflow = 0x03,
  kUnknownPart = 0x04
};
constexpr std::uint8_t kIoChange = 0x10;  // sets pins; does not change the mode otherwise
constexpr std::size_t kMostWritten = 60, kMostRead = 64, kDirectBuffer = 60;
constexpr std::size_t kMostWrittenAfterTwo = 59, kMostReadAfterOne = 60;  // limits of frames with
                                                                          // register addresses
constexpr int kFirstWithTest = 5, kFirstThatStops = 8;

using Kind = BusStep::Kind;
using Steps = std::vector<BusStep>;

void Address(Steps& steps, std::uint8_t byte) {
  steps.push_back({Kind::kStart});
  steps.push_back({Kind::kWrite, byte});
}
void Write(Steps& steps, std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) steps.push_back({Kind::kWrite, byte});
}
void Read(Steps& steps, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) steps.push_back({Kind::kRead, 0, i + 1 < count});
}

/// Returns the bit time of a mode; 0 if it is not an I2C mode.
Time BitTime(std::uint8_t mode) {
  switch (mode & 0xFE) {  // the lowest bit adds a serial port
    case 0x20:
      return kSecond / 20'000;
    case 0x30:
      return kSecond / 50'000;
    case 0x40:
    case 0x60:
      return kSecond / 100'000;
    case 0x50:
    case 0x70:
      return kSecond / 400'000;
    case 0x80:
      return kSecond / 1'000'000;
    default:
      return 0;
  }
}

/// Returns the length of the frame that sets a mode; 0 if there is no such mode.
std::size_t ModeFrameLength(std::uint8_t mode) {
  if (BitTime(mode) != 0) return (mode & 1) != 0 ? 5 : 4;
  if (mode == 0x00 || mode == 0x10 || (mode >= 0x90 && mode <= 0x93)) return 4;
  if (mode == 0x01) return 6;
  return 0;
}

}  // namespace

UsbIss::UsbIss(I2cBus& bus, UsbIssOptions options) : bus_(bus), options_(std::move(options)) {
  options_.serial_number.resize(8, '0');
}

void UsbIss::PowerCycle() {
  mode_ = kPowerUpMode;
  phase_ = Phase::kIdle;
  due_ = kNever;
  burst_.clear();
  reply_.clear();
  rest_ = {};
}

Time UsbIss::NextAt() const { return due_; }

void UsbIss::Receive(Time now, std::span<const std::uint8_t> burst) {
  // A transfer that began before the adapter was unplugged may still be on the bus.
  if (phase_ != Phase::kIdle || bus_.Busy() || burst.empty()) {
    ++ignored_;
    return;
  }
  burst_.assign(burst.begin(), burst.end());
  rest_ = burst_;
  reply_.clear();
  phase_ = Phase::kTravelling;
  due_ = now + options_.request_latency;
}

void UsbIss::Step(Time now) {
  if (phase_ == Phase::kTravelling && now >= due_) {
    due_ = kNever;
    NextCommand(now);
  } else if (phase_ == Phase::kOnBus && !bus_.Busy()) {
    const Bytes answer = Answer(command_, bus_.result());
    reply_.insert(reply_.end(), answer.begin(), answer.end());
    NextCommand(bus_.result().ended);  // the transfer may have ended some microseconds ago
  }
}

void UsbIss::NextCommand(Time now) {
  while (!rest_.empty()) {
    auto command = Parse();
    if (!command) {
      ++ignored_;
      break;
    }
    command_ = std::move(*command);
    if (!command_.steps.empty()) {
      const BusTiming timing{.bit = BitTime(mode_), .byte_gap = options_.byte_gap};
      phase_ = Phase::kOnBus;
      bus_.Begin(now, std::move(command_.steps), timing, command_.stop_after_nack);
      return;
    }
    reply_.insert(reply_.end(), command_.fixed.begin(), command_.fixed.end());
  }
  rest_ = {};
  phase_ = reply_.empty() ? Phase::kIdle : Phase::kReplying;
  if (phase_ == Phase::kReplying) due_ = now + options_.reply_latency;
}

std::optional<Bytes> UsbIss::TakeReply(Time now) {
  if (phase_ != Phase::kReplying || now < due_) return std::nullopt;
  phase_ = Phase::kIdle;
  due_ = kNever;
  return std::exchange(reply_, {});
}

Bytes UsbIss::Answer(const Command& command, const BusResult& result) const {
  const bool done = result.outcome == BusOutcome::kDone;
  switch (command.answer) {
    case Command::Answer::kFixed:
      return command.fixed;
    case Command::Answer::kStatus:
      return {done ? kAcknowledge : kRefusal};
    case Command::Answer::kBytes: {
      Bytes bytes = result.read;
      bytes.resize(command.bytes,
                   0xFF);  // a missing slave reads as ones: the frame has no error code
      return bytes;
    }
    case Command::Answer::kDirect:
      break;
  }
  if (!done) return {kRefusal, kNobodyThere};
  if (!command.fixed.empty()) return command.fixed;
  Bytes bytes{kAcknowledge, static_cast<std::uint8_t>(result.read.size())};
  bytes.insert(bytes.end(), result.read.begin(), result.read.end());
  return bytes;
}

std::optional<UsbIss::Command> UsbIss::Parse() {
  const std::span<const std::uint8_t> frame = rest_;
  std::size_t used = frame.size();
  std::optional<Command> command;
  if (frame[0] == kIss) {
    command = ParseIss(frame, &used);
  } else if (BitTime(mode_) == 0) {
    return std::nullopt;  // no bus in this mode
  } else if (frame[0] == kDirect) {
    command = ParseDirect(frame);
  } else {
    command = ParseTransfer(frame, &used);
  }
  if (command) rest_ = rest_.subspan(used);
  return command;
}

std::optional<UsbIss::Command> UsbIss::ParseIss(std::span<const std::uint8_t> frame,
                                                std::size_t* used) {
  if (frame.size() < 2) return std::nullopt;
  Command command;
  *used = 2;
  if (frame[1] == 0x01) {
    command.fixed = {kModuleId, static_cast<std::uint8_t>(options_.firmware_version), mode_};
  } else if (frame[1] == 0x03) {
    command.fixed.assign(options_.serial_number.begin(), options_.serial_number.end());
  } else if (frame[1] == 0x02) {
    if (frame.size() < 3) return std::nullopt;
    *used = ModeFrameLength(frame[2]);
    if (*used == 0) {
      *used = frame.size();
      command.fixed = {kRefusal, kUnknownCommand};
    } else if (frame.size() < *used) {
      return std::nullopt;
    } else {
      if (frame[2] != kIoChange) mode_ = frame[2];
      command.fixed = {kAcknowledge, 0x00};
    }
  } else {
    *used = frame.size();
    command.fixed = {kRefusal, kUnknownCommand};
  }
  return command;
}

std::optional<UsbIss::Command> UsbIss::ParseTransfer(std::span<const std::uint8_t> frame,
                                                     std::size_t* used) const {
  if (frame[0] < kSingle || frame[0] > kTest || frame.size() < 2) return std::nullopt;
  Command command;
  Steps& steps = command.steps;
  const std::uint8_t address = frame[1];
  const bool reads = (address & 1) != 0;
  if (frame[0] == kTest) {
    if (options_.firmware_version < kFirstWithTest) return std::nullopt;
    *used = 2;
    Address(steps, address);
    command.answer = Command::Answer::kStatus;
  } else {
    const std::size_t registers = frame[0] == kOneRegister ? 1 : frame[0] == kTwoRegisters ? 2 : 0;
    const bool counted = frame[0] != kSingle;
    const std::size_t data = 2 + registers + (counted ? 1 : 0);
    if (frame.size() < data) return std::nullopt;
    const std::size_t count = counted ? frame[data - 1] : 1;
    *used = data + (reads ? 0 : count);
    const std::size_t most_written = registers == 2 ? kMostWrittenAfterTwo : kMostWritten;
    const std::size_t most_read = registers == 1 ? kMostReadAfterOne : kMostRead;
    const std::size_t most = reads ? most_read : most_written;
    if (count == 0 || count > most || frame.size() < *used) return std::nullopt;
    const auto before = frame.subspan(2, registers);
    if (reads && registers > 0) {
      Address(steps, address & 0xFE);
      Write(steps, before);
      Address(steps, address);
    } else {
      Address(steps, address);
      Write(steps, before);
    }
    if (reads) {
      Read(steps, count);
      command.bytes = count;
    } else {
      Write(steps, frame.subspan(data, count));
    }
    command.answer = reads ? Command::Answer::kBytes : Command::Answer::kStatus;
  }
  steps.push_back({Kind::kStop});
  return command;
}

UsbIss::Command UsbIss::ParseDirect(std::span<const std::uint8_t> frame) const {
  Command command;
  command.answer = Command::Answer::kDirect;
  command.stop_after_nack = options_.firmware_version >= kFirstThatStops;
  const auto fails = [&](DirectError error) { command.fixed = {kRefusal, error}; };
  if (frame.size() >= kDirectBuffer) {
    fails(kOverflow);
    return command;
  }
  bool nack_next = false, open = false;
  for (std::size_t at = 1; at < frame.size() && command.fixed.empty(); ++at) {
    const std::uint8_t part = frame[at];
    const std::size_t count = (part & 0x0FU) + 1;
    if (part == 0x01 || part == 0x02) {
      command.steps.push_back({Kind::kStart});
      open = true;
    } else if (part == 0x03) {
      command.steps.push_back({Kind::kStop});
      open = false;
    } else if (part == 0x04) {
      nack_next = true;
    } else if (part >= 0x20 && part <= 0x2F) {
      command.bytes += count;
      if (command.bytes + 2 > kDirectBuffer) {
        fails(kOverflow);
        break;
      }
      for (std::size_t i = 0; i < count; ++i) {
        command.steps.push_back({Kind::kRead, 0, !(nack_next && i + 1 == count)});
      }
      nack_next = false;
    } else if (part >= 0x30 && part <= 0x3F) {
      if (frame.size() - at - 1 < count) {
        fails(kUnderflow);
        break;
      }
      Write(command.steps, frame.subspan(at + 1, count));
      at += count;
    } else {
      fails(kUnknownPart);
    }
  }
  if (open && !command.fixed.empty()) command.steps.push_back({Kind::kStop});
  if (command.steps.empty() && command.fixed.empty()) command.fixed = {kAcknowledge, 0x00};
  return command;
}

}  // namespace taut::virtual_robot
