#include "taut/link/usb_iss.h"

#include <algorithm>
#include <array>

namespace taut::link {
namespace {

// Commands of the adapter, and elements of I2C_DIRECT.
constexpr std::uint8_t kIss = 0x5a, kAd0 = 0x54, kDirect = 0x57, kTest = 0x58;
constexpr std::uint8_t kI2cStart = 0x01, kI2cStop = 0x03, kNack = 0x04, kRead1 = 0x20,
                       kWrite1 = 0x30;
constexpr std::uint8_t kI2cHardware400kHz = 0x70, kUnusedPinsAreInputs = 0x04;

/// Reply time that the manufacturer specifies.
constexpr double kPatience_s = 0.5;
constexpr int kVersionTries = 3;

std::size_t SizeOf(const Bytes& reply, ReplyShape shape) {
  if (!shape.direct) return shape.bytes;
  if (reply.empty() || reply[0] != 0xff) return 2;
  return reply.size() < 2 ? 2 : 2u + reply[1];
}

}  // namespace

void UsbIss::Begin(std::span<const std::uint8_t> frame, ReplyShape shape, double patience_s) {
  port_.Read();  // discard delayed bytes
  reply_.clear();
  shape_ = shape;
  begun_s_ = port_.now_s();
  due_s_ = begun_s_ + patience_s;
  state_ = port_.Write(frame) ? State::kPending : State::kLost;
}

UsbIss::State UsbIss::Poll() {
  if (state_ != State::kPending) return state_;
  const Bytes more = port_.Read();
  reply_.insert(reply_.end(), more.begin(), more.end());
  const std::size_t size = SizeOf(reply_, shape_);
  if (reply_.size() >= size) {
    reply_.resize(size);
    state_ = State::kDone;
  } else if (!port_.is_open()) {
    state_ = State::kLost;
  } else if (port_.now_s() >= due_s_) {
    state_ = State::kSilent;
  }
  return state_;
}

std::optional<Bytes> UsbIss::Transfer(std::span<const std::uint8_t> frame, ReplyShape shape) {
  Begin(frame, shape, kPatience_s);
  while (Poll() == State::kPending) port_.Wait(due_s_);
  if (state_ != State::kDone) return std::nullopt;
  return reply_;
}

std::optional<AdapterInfo> UsbIss::Identify() {
  // The first frame may fail because of incomplete data of a previous program, so try several
  // times.
  std::optional<Bytes> version;
  for (int i = 0; i < kVersionTries && !version && port_.is_open(); ++i) {
    version = Transfer(std::array{kIss, std::uint8_t{1}}, {3});
  }
  if (!version) return std::nullopt;
  const auto serial = Transfer(std::array{kIss, std::uint8_t{3}}, {8});
  if (!serial) return std::nullopt;
  return AdapterInfo{(*version)[0], (*version)[1], (*version)[2], {serial->begin(), serial->end()}};
}

bool UsbIss::SetMode() {
  const auto reply =
      Transfer(std::array{kIss, std::uint8_t{2}, kI2cHardware400kHz, kUnusedPinsAreInputs}, {2});
  return reply && (*reply)[0] == 0xff;
}

bool UsbIss::Test(std::uint8_t address) {
  const auto reply = Transfer(std::array{kTest, static_cast<std::uint8_t>(address << 1)}, {1});
  return reply && (*reply)[0] != 0;
}

bool UsbIss::Write(std::uint8_t address, std::span<const std::uint8_t> bytes) {
  const auto reply = Transfer(WriteFrame(address, bytes), {1});
  return reply && (*reply)[0] != 0;
}

std::optional<Bytes> UsbIss::Read(std::uint8_t address, std::size_t size) {
  return Transfer(ReadFrame(address, size), {size});
}

Bytes UsbIss::WriteFrame(std::uint8_t address, std::span<const std::uint8_t> bytes) {
  Bytes frame(3 + bytes.size());
  frame[0] = kAd0;
  frame[1] = static_cast<std::uint8_t>(address << 1);
  frame[2] = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), frame.begin() + 3);
  return frame;
}

Bytes UsbIss::ReadFrame(std::uint8_t address, std::size_t size) {
  return {kAd0, static_cast<std::uint8_t>(address << 1 | 1), static_cast<std::uint8_t>(size)};
}

Bytes UsbIss::ReadsFrame(std::span<const std::uint8_t> addresses, std::size_t size) {
  Bytes frame{kDirect};
  for (const std::uint8_t address : addresses) {
    const std::uint8_t begin[] = {kI2cStart, kWrite1, static_cast<std::uint8_t>(address << 1 | 1)};
    frame.insert(frame.end(), std::begin(begin), std::end(begin));
    // Acknowledge all bytes except the last, so that the board releases the bus.
    if (size > 1) frame.push_back(static_cast<std::uint8_t>(kRead1 + size - 2));
    frame.insert(frame.end(), {kNack, kRead1, kI2cStop});
  }
  return frame;
}

}  // namespace taut::link
