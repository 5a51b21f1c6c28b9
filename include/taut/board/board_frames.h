/// Frames from a motor board to the PC over I2C: status, replies and board information
/// (docs/hardware/protocol.md). Every read returns 16 bytes. Freestanding C++14.
#pragma once

#include "taut/board/board_commands.h"

namespace taut {
namespace board {

constexpr size_t kFrameSize = 16;

/// Meaning of the byte `Status::more`, selected by the sequence number of the frame modulo 16.
enum class More : uint8_t {
  kFaults0,
  kFaults1,
  kBoardFaults,
  kCrcErrors,
  kOverruns,
  kLoopTime8us,
  kResetCause,
  kTemperature0C,
  kTemperature1C,
  kFirmwareMajor,
  kFirmwareMinor,
  kProtocol,
  kParametersCrc,
  kNonce,
  kMissed,
  kRecoveries,
};
constexpr uint8_t kMores = 16;

/// Status of one motor.
struct MotorStatus {
  /// Filtered load cell reading in quarters of an ADC count, 12 bits.
  uint16_t tension_quarters = 0;
  uint16_t set_point_quarters = 0;  ///< Tension set point in the same unit; 0: none.
  uint16_t encoder_counts = 0;      ///< Modulo 2^16; increases when winding in.
  int8_t duty = 0;                  ///< In 1/127; positive winds in.
};

#ifndef __AVR__  // only the PC converts readings
/// Returns the force [N] of a reading in quarters of a count.
constexpr double ForceOf(uint16_t quarters, double n_per_count, double counts_at_zero) noexcept {
  return n_per_count * (quarters / 4.0 - counts_at_zero);
}
#endif

/// Status of a board.
struct Status {
  uint8_t sequence = 0;  ///< Sequence number of the last applied broadcast.
  Mode mode = Mode::kOff;
  bool referenced = false, faulty = false, timeout = false;
  bool overrun = false;    ///< At least one tick was late since the last frame.
  bool was_reset = false;  ///< The board was reset after faults were last cleared.
  MotorStatus motors[kMotors];
  uint8_t more = 0;  ///< Meaning: see `More`.
};

/// Results of a request.
enum class Answer : uint8_t {
  kGood = 0,
  kUnknown = 1,     ///< No such parameter, action or motor.
  kOutOfRange = 2,  ///< Not finite, or outside the limits of the parameter or the count.
  kNotInThisMode = 3,
  kBusy = 4,   ///< The EEPROM is being written.
  kStale = 5,  ///< The boot number is not the present one.
};

/// Reply to a request.
struct Reply {
  uint8_t what = 0;
  uint8_t index = 0;
  Answer answer = Answer::kGood;
  uint8_t payload[11] = {};
};

namespace internal {

/// Returns the checksum of a frame. The checksum includes the board number, which the frame does
/// not contain, so frames of other boards fail the check. The start value is not 0, so a data line
/// stuck at low also fails.
constexpr uint8_t FrameCrc(const uint8_t* frame, uint8_t board) noexcept {
  return Crc8(frame, kFrameSize - 1, AddToCrc8(0xff, board));
}

}  // namespace internal

/// Encodes a status.
constexpr void Encode(const Status& status, uint8_t board, uint8_t (&frame)[kFrameSize]) noexcept {
  frame[0] = status.sequence;
  frame[1] = static_cast<uint8_t>(static_cast<uint8_t>(status.mode) | (status.referenced ? 8 : 0) |
                                  (status.faulty ? 16 : 0) | (status.timeout ? 32 : 0) |
                                  (status.overrun ? 64 : 0) | (status.was_reset ? 128 : 0));
  uint8_t* at = frame + 2;
  for (uint8_t m = 0; m < kMotors; ++m, at += 6) {
    const MotorStatus& motor = status.motors[m];
    at[0] = static_cast<uint8_t>(motor.tension_quarters & 0xff);
    at[1] = static_cast<uint8_t>(((motor.tension_quarters >> 8) & 0x0f) |
                                 ((motor.set_point_quarters & 0x0f) << 4));
    at[2] = static_cast<uint8_t>(motor.set_point_quarters >> 4);
    internal::Put16(at + 3, motor.encoder_counts);
    at[5] = static_cast<uint8_t>(motor.duty);
  }
  frame[14] = status.more;
  frame[15] = internal::FrameCrc(frame, board);
}

/// Encodes a reply.
constexpr void Encode(const Reply& reply, uint8_t board, uint8_t (&frame)[kFrameSize]) noexcept {
  frame[0] = reply.what;
  frame[1] = static_cast<uint8_t>(Mode::kReply);
  frame[2] = reply.index;
  frame[3] = static_cast<uint8_t>(reply.answer);
  for (size_t i = 0; i < sizeof reply.payload; ++i) frame[4 + i] = reply.payload[i];
  frame[15] = internal::FrameCrc(frame, board);
}

/// Returns whether a message is a complete, valid frame of this board.
constexpr bool IsFrame(const uint8_t* frame, size_t size, uint8_t board) noexcept {
  return size == kFrameSize && frame[15] == internal::FrameCrc(frame, board);
}
/// Returns whether a frame is a reply; otherwise it is a status.
constexpr bool IsReply(const uint8_t (&frame)[kFrameSize]) noexcept {
  return (frame[1] & 7) == static_cast<uint8_t>(Mode::kReply);
}

/// Decodes a status. Requires `IsFrame` and not `IsReply`.
constexpr Status DecodeStatus(const uint8_t (&frame)[kFrameSize]) noexcept {
  Status status;
  status.sequence = frame[0];
  status.mode = static_cast<Mode>(frame[1] & 7);
  status.referenced = (frame[1] & 8) != 0;
  status.faulty = (frame[1] & 16) != 0;
  status.timeout = (frame[1] & 32) != 0;
  status.overrun = (frame[1] & 64) != 0;
  status.was_reset = (frame[1] & 128) != 0;
  const uint8_t* at = frame + 2;
  for (uint8_t m = 0; m < kMotors; ++m, at += 6) {
    MotorStatus& motor = status.motors[m];
    motor.tension_quarters = static_cast<uint16_t>(at[0] | (at[1] & 0x0f) << 8);
    motor.set_point_quarters = static_cast<uint16_t>(at[1] >> 4 | at[2] << 4);
    motor.encoder_counts = internal::Get16(at + 3);
    motor.duty = static_cast<int8_t>(at[5]);
  }
  status.more = frame[14];
  return status;
}

/// Decodes a reply. Requires `IsFrame` and `IsReply`.
constexpr Reply DecodeReply(const uint8_t (&frame)[kFrameSize]) noexcept {
  Reply reply;
  reply.what = frame[0];
  reply.index = frame[2];
  reply.answer = static_cast<Answer>(frame[3]);
  for (size_t i = 0; i < sizeof reply.payload; ++i) reply.payload[i] = frame[4 + i];
  return reply;
}

/// Payload of the reply to `Asked::kInfo`.
struct Info {
  uint8_t protocol_min = 0, protocol_max = 0;
  uint8_t firmware_major = 0, firmware_minor = 0;
  uint32_t parameters_version = 0;  ///< `kParametersVersion` of this firmware.
  uint16_t nonce = 0;               ///< Boot number, incremented at each boot.
  uint8_t board = 0;
};
/// Encodes board information.
constexpr void Encode(const Info& info, uint8_t (&payload)[11]) noexcept {
  payload[0] = info.protocol_min;
  payload[1] = info.protocol_max;
  payload[2] = info.firmware_major;
  payload[3] = info.firmware_minor;
  internal::Put32(payload + 4, info.parameters_version);
  internal::Put16(payload + 8, info.nonce);
  payload[10] = info.board;
}
/// Decodes board information.
constexpr Info DecodeInfo(const uint8_t (&payload)[11]) noexcept {
  Info info;
  info.protocol_min = payload[0];
  info.protocol_max = payload[1];
  info.firmware_major = payload[2];
  info.firmware_minor = payload[3];
  info.parameters_version = internal::Get32(payload + 4);
  info.nonce = internal::Get16(payload + 8);
  info.board = payload[10];
  return info;
}

}  // namespace board
}  // namespace taut
