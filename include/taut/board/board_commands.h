/// Messages from the PC to the motor boards over I2C: cyclic commands, stops and requests
/// (docs/hardware/protocol.md). `taut/board/protocol.h` includes the whole protocol.
///
/// Messages have at most 32 bytes; numbers are little endian. Freestanding C++14.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "taut/board/crc.h"

namespace taut {
namespace board {

constexpr uint8_t kProtocolVersion = 1;
constexpr uint8_t kBoards = 6;
/// Motors per board. Motor m of board b winds the actuated cable number 2 b + m, starting at 0.
constexpr uint8_t kMotors = 2;
constexpr uint8_t kCables = kBoards * kMotors;

constexpr uint8_t kBroadcastAddress = 0x00;  ///< General-call address of I2C.
/// Returns the 7-bit I2C address of a board.
constexpr uint8_t BoardAddress(uint8_t board) noexcept {
  return static_cast<uint8_t>(0x10 + board);
}

// --- commands ------------------------------------------------------------------------------------

enum class Mode : uint8_t {
  kOff = 0,        ///< The driver is off: motors coast.
  kHold = 1,       ///< Position control; targets are the positions at the start of this mode.
  kPosition = 2,   ///< Values: encoder counts relative to the reference position.
  kImpedance = 3,  ///< Values: V0 in `kSpeedUnit_m_per_s`; positive lengthens the cable.
  kDuty = 4,       ///< Values: duty in 1/32767; positive winds in. For bench tests.
  kReply = 5,      ///< Never commanded; marks the reply to a request.
  kStopped = 7,    ///< Emergency stop: like kOff, until faults are cleared.
};

constexpr float kSpeedUnit_m_per_s = 2e-5f;

/// Arming in two steps: a broadcast with kReady in mode kOff without faults, then a broadcast with
/// kGo. Motors have power only after both broadcasts.
enum class Arm : uint8_t { kNot = 0, kReady = 1, kGo = 2 };

/// Cyclic broadcast to all boards, 29 bytes.
struct Cyclic {
  /// Sequence number. A board ignores a broadcast with the same number as the previous one.
  uint8_t sequence = 0;
  Mode mode = Mode::kOff;
  bool capture = false;  ///< At the start of kImpedance: L0 and T0 become the measured values.
  /// Clears latched faults, an emergency stop and a timeout. Only in mode kOff or kHold.
  bool clear_faults = false;
  bool zero_inputs = false;  ///< Sets V0 = 0 instead of the values.
  Arm arm = Arm::kNot;
  int16_t values[kCables] = {};
};

#ifndef __AVR__  // only the PC encodes values
/// Converts a value in units of a broadcast to its number, rounded half away from zero and clamped
/// to its range. NaN becomes 0.
constexpr int16_t ToWire(double units) noexcept {
  if (units != units) return 0;
  if (units >= 32767.0) return 32767;
  if (units <= -32767.0) return -32767;
  return static_cast<int16_t>(units + (units < 0 ? -0.5 : 0.5));
}
#endif

/// Data of a broadcast for one board.
struct Command {
  uint8_t sequence = 0;
  Mode mode = Mode::kOff;
  bool capture = false, clear_faults = false, zero_inputs = false;
  Arm arm = Arm::kNot;
  int16_t values[kMotors] = {};
};

enum class Decoded : uint8_t { kGood, kUnknown, kWrongSize, kWrongCrc, kWrongVersion, kWrongValue };

constexpr size_t kMaxMessageSize = 32;
constexpr size_t kCyclicSize = 29;
constexpr size_t kStopSize = 4;
constexpr uint8_t kCyclicHead = 0xc0;  ///< Upper half of the byte; the lower half is the version.
constexpr uint8_t kStopHead = 0xce;

namespace internal {

constexpr void Put16(uint8_t* at, uint16_t x) noexcept {
  at[0] = static_cast<uint8_t>(x & 0xff);
  at[1] = static_cast<uint8_t>(x >> 8);
}
constexpr uint16_t Get16(const uint8_t* at) noexcept {
  return static_cast<uint16_t>(at[0] | static_cast<uint16_t>(at[1]) << 8);
}
constexpr void Put32(uint8_t* at, uint32_t x) noexcept {
  Put16(at, static_cast<uint16_t>(x & 0xffff));
  Put16(at + 2, static_cast<uint16_t>(x >> 16));
}
constexpr uint32_t Get32(const uint8_t* at) noexcept {
  return Get16(at) | static_cast<uint32_t>(Get16(at + 2)) << 16;
}
/// Appends the CRC-16, high byte first (other numbers are little endian). In this order, the
/// checksum continues the bits of the message, as in the theory of CRCs. It detects any burst of up
/// to 16 wrong bits.
constexpr void Seal16(uint8_t* frame, size_t size) noexcept {
  const uint16_t crc = Crc16(frame, size - 2);
  frame[size - 2] = static_cast<uint8_t>(crc >> 8);
  frame[size - 1] = static_cast<uint8_t>(crc & 0xff);
}
/// Returns whether the CRC-16 is correct: the remainder of message and checksum is 0.
constexpr bool IsSealed16(const uint8_t* frame, size_t size) noexcept {
  return Crc16(frame, size) == 0;
}

}  // namespace internal

/// Encodes a broadcast.
constexpr void Encode(const Cyclic& message, uint8_t (&frame)[kCyclicSize]) noexcept {
  frame[0] = kCyclicHead | kProtocolVersion;
  frame[1] = message.sequence;
  frame[2] = static_cast<uint8_t>(static_cast<uint8_t>(message.mode) | (message.capture ? 8 : 0) |
                                  (message.clear_faults ? 16 : 0) | (message.zero_inputs ? 32 : 0) |
                                  static_cast<uint8_t>(static_cast<uint8_t>(message.arm) << 6));
  for (size_t i = 0; i < kCables; ++i) {
    internal::Put16(frame + 3 + 2 * i, static_cast<uint16_t>(message.values[i]));
  }
  internal::Seal16(frame, kCyclicSize);
}

/// Decodes the data for the board whose first motor has index `first`. Returns kWrongValue if the
/// message contains no data for this board.
constexpr Decoded Decode(const uint8_t* frame, size_t size, uint8_t first, Command& out) noexcept {
  if (first + kMotors > kCables) return Decoded::kWrongValue;
  if (size < 1 || (frame[0] & 0xf0) != kCyclicHead || frame[0] == kStopHead)
    return Decoded::kUnknown;
  if ((frame[0] & 0x0f) != kProtocolVersion) return Decoded::kWrongVersion;
  if (size != kCyclicSize) return Decoded::kWrongSize;
  if (!internal::IsSealed16(frame, size)) return Decoded::kWrongCrc;
  const uint8_t mode = frame[2] & 7, arm = static_cast<uint8_t>(frame[2] >> 6);
  if (mode > static_cast<uint8_t>(Mode::kDuty) || arm > static_cast<uint8_t>(Arm::kGo)) {
    return Decoded::kWrongValue;
  }
  out.sequence = frame[1];
  out.mode = static_cast<Mode>(mode);
  out.capture = (frame[2] & 8) != 0;
  out.clear_faults = (frame[2] & 16) != 0;
  out.zero_inputs = (frame[2] & 32) != 0;
  out.arm = static_cast<Arm>(arm);
  for (uint8_t m = 0; m < kMotors; ++m) {
    out.values[m] = static_cast<int16_t>(internal::Get16(frame + 3 + 2 * (first + m)));
  }
  return Decoded::kGood;
}

/// Encodes an emergency stop for all boards. Send it several times, without other messages.
constexpr void EncodeStop(uint8_t (&frame)[kStopSize]) noexcept {
  frame[0] = kStopHead;
  frame[1] = 'S';
  frame[2] = 'T';
  frame[3] = Crc8(frame, 3);
}
/// Returns whether a message is an emergency stop.
constexpr bool IsStop(const uint8_t* frame, size_t size) noexcept {
  return size == kStopSize && frame[0] == kStopHead && frame[1] == 'S' && frame[2] == 'T' &&
         frame[3] == Crc8(frame, 3);
}

// --- requests to one board; the next read from the board returns the reply ---------------------

enum class Request : uint8_t {
  kSet = 0xd1,  ///< Sets a parameter.
  kAsk = 0xd2,  ///< Reads a parameter or one of `Asked`.
  kDo = 0xd3,   ///< Performs one of `Action`.
};

/// Readable data other than parameters; parameters have the numbers 0 .. 127.
enum class Asked : uint8_t { kInfo = 0xf0, kFaults = 0xf1, kCounters = 0xf2 };

enum class Action : uint8_t {
  kStore = 0xe1,     ///< Stores the parameters in the EEPROM. Only in mode kOff.
  kLoad = 0xe2,      ///< Loads the parameters from the EEPROM. Only in mode kOff.
  kDefaults = 0xe3,  ///< Restores the firmware's defaults. Only in mode kOff.
  /// Sets the encoder count of the motor to `value`. Only in mode kOff or kHold.
  kSetReference = 0xe4,
};

/// Limit of encoder counts: 112 m of cable; exact in a float.
constexpr int32_t kMostReference = int32_t{1} << 23;

/// Request to one board. Sizes: kSet 9, kAsk 4, kDo 11 bytes.
struct Asking {
  Request request = Request::kAsk;
  uint8_t what = 0;    ///< Number of a parameter, an `Asked` or an `Action`.
  uint8_t index = 0;   ///< Index of the motor; `kMotors`: the board.
  uint32_t value = 0;  ///< kSet: bits of a float; kDo: an int32.
  uint16_t nonce = 0;  ///< kDo: boot number (`Info::nonce`); other numbers are rejected.
};
constexpr size_t kSetSize = 9, kAskSize = 4, kDoSize = 11;

/// Returns the size of a request in bytes.
constexpr size_t SizeOf(Request request) noexcept {
  return request == Request::kSet ? kSetSize : request == Request::kAsk ? kAskSize : kDoSize;
}

/// Encodes a request. Returns the number of bytes used in `frame`.
constexpr size_t Encode(const Asking& message, uint8_t (&frame)[kDoSize]) noexcept {
  frame[0] = static_cast<uint8_t>(message.request);
  frame[1] = message.what;
  frame[2] = message.index;
  if (message.request == Request::kAsk) {
    frame[3] = Crc8(frame, 3);
    return kAskSize;
  }
  internal::Put32(frame + 3, message.value);
  if (message.request == Request::kDo) internal::Put16(frame + 7, message.nonce);
  internal::Seal16(frame, SizeOf(message.request));
  return SizeOf(message.request);
}

/// Decodes a request.
constexpr Decoded Decode(const uint8_t* frame, size_t size, Asking& out) noexcept {
  if (size < 1 || frame[0] < static_cast<uint8_t>(Request::kSet) ||
      frame[0] > static_cast<uint8_t>(Request::kDo)) {
    return Decoded::kUnknown;
  }
  const Request request = static_cast<Request>(frame[0]);
  if (size != SizeOf(request)) return Decoded::kWrongSize;
  const bool ask = request == Request::kAsk;
  if (ask ? frame[3] != Crc8(frame, 3) : !internal::IsSealed16(frame, size)) {
    return Decoded::kWrongCrc;
  }
  out.request = request;
  out.what = frame[1];
  out.index = frame[2];
  out.value = ask ? 0 : internal::Get32(frame + 3);
  out.nonce = request == Request::kDo ? internal::Get16(frame + 7) : uint16_t{0};
  return Decoded::kGood;
}

}  // namespace board
}  // namespace taut
