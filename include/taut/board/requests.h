/// Message handling of a motor board: broadcasts, emergency stops, requests and their replies.
/// Freestanding C++14.
#pragma once

#include "taut/board/state.h"

namespace taut {
namespace board {

/// Initializes a board after a reset. Load `board.parameters` before the call.
inline void Start(const Boot& boot, Board& board) noexcept {
  board.boot = boot;
  if (!boot.parameters_good) {
    SetDefaults(board.parameters);
    board.board_faults |= kParametersLost;
  }
  Prepare(board);
  // After a reset without a power cycle, the motor temperatures are unknown; they may be warm.
  if ((boot.reset_cause & kPowerOn) == 0) {
    for (uint8_t m = 0; m < kMotors; ++m) board.watches[m].housing_rise_k = 40.0f;
  }
}

namespace internal {

inline float FromBits(uint32_t bits) noexcept {
  float value;
  __builtin_memcpy(&value, &bits, sizeof value);
  return value;
}
inline uint32_t ToBits(float value) noexcept {
  uint32_t bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// Returns a pointer to a parameter, or null if it does not exist.
inline float* ParameterAt(Board& board, uint8_t what, uint8_t index) noexcept {
  if (index < kMotors && what < kMotorParameters) return &board.parameters.motor[index][what];
  if (index == kMotors && what < kBoardParameters) return &board.parameters.board[what];
  return nullptr;
}

/// Returns whether all parameters may change: no parameter moves a motor in this mode.
inline bool IsQuiet(const Board& board) noexcept {
  return board.mode == Mode::kOff || board.mode == Mode::kHold || board.mode == Mode::kStopped;
}

inline Answer SetParameter(Board& board, const Asking& asking) noexcept {
  float* const at = ParameterAt(board, asking.what, asking.index);
  if (at == nullptr) return Answer::kUnknown;
  if (board.memory != Memory::kIdle) return Answer::kBusy;
  const bool of_motor = asking.index < kMotors;
  const float value = FromBits(asking.value);
  if (!IsWithin(of_motor ? MotorRange(asking.what) : BoardRange(asking.what), value)) {
    return Answer::kOutOfRange;
  }
  if (!IsQuiet(board) && !(of_motor && asking.what < kGains)) return Answer::kNotInThisMode;
  *at = value;
  if (of_motor && asking.what < kGains) return Answer::kGood;
  if (of_motor) {
    Prepare(board, asking.index);
  } else {
    Prepare(board);
  }
  // Changed gains would make the output of the PID jump; restart it from the present duty.
  if (of_motor && board.mode == Mode::kHold) {
    StartPosition(board.numbers[asking.index], board.loops[asking.index]);
  }
  return Answer::kGood;
}

/// Performs an action.
inline Answer Do(Board& board, const Asking& asking) noexcept {
  if (asking.nonce != board.boot.nonce) return Answer::kStale;
  switch (static_cast<Action>(asking.what)) {
    case Action::kStore:
    case Action::kLoad:
    case Action::kDefaults:
      if (board.mode != Mode::kOff && board.mode != Mode::kStopped) return Answer::kNotInThisMode;
      if (board.memory != Memory::kIdle) return Answer::kBusy;
      if (asking.what == static_cast<uint8_t>(Action::kDefaults)) {
        SetDefaults(board.parameters);
        Prepare(board);
      } else {
        board.memory =
            asking.what == static_cast<uint8_t>(Action::kStore) ? Memory::kStore : Memory::kLoad;
      }
      return Answer::kGood;
    case Action::kSetReference: {
      if (!IsQuiet(board)) return Answer::kNotInThisMode;
      if (asking.index >= kMotors) return Answer::kUnknown;
      MotorLoop& motor = board.loops[asking.index];
      const int32_t counts = static_cast<int32_t>(asking.value);
      if (counts > kMostReference || counts < -kMostReference) return Answer::kOutOfRange;
      motor.target_counts += counts - motor.counts;
      motor.counts = counts;
      board.referenced[asking.index] = true;
      return Answer::kGood;
    }
  }
  return Answer::kUnknown;
}

/// Reads a parameter or an `Asked` into `payload`.
inline Answer Ask(Board& board, const Asking& asking, uint8_t (&payload)[11]) noexcept {
  if (asking.what < 0x80) {
    const float* const at = ParameterAt(board, asking.what, asking.index);
    if (at == nullptr) return Answer::kUnknown;
    Put32(payload, ToBits(*at));
    return Answer::kGood;
  }
  switch (static_cast<Asked>(asking.what)) {
    case Asked::kInfo: {
      Info info;
      info.protocol_min = info.protocol_max = kProtocolVersion;
      info.firmware_major = kFirmwareMajor;
      info.firmware_minor = kFirmwareMinor;
      info.parameters_version = kParametersVersion;
      info.nonce = board.boot.nonce;
      info.board = board.boot.board;
      Encode(info, payload);
      return Answer::kGood;
    }
    case Asked::kFaults:
      payload[0] = board.faults[0];
      payload[1] = board.faults[1];
      payload[2] = board.board_faults;
      payload[3] = board.boot.reset_cause;
      payload[4] = static_cast<uint8_t>((board.timeout ? 1 : 0) | (board.stopped ? 2 : 0) |
                                        (board.armed ? 4 : 0) | (board.referenced[0] ? 8 : 0) |
                                        (board.referenced[1] ? 16 : 0) |
                                        (board.memory != Memory::kIdle ? 32 : 0));
      payload[5] = board.temperature_c[0];
      payload[6] = board.temperature_c[1];
      return Answer::kGood;
    case Asked::kCounters:
      Put16(payload, board.counters.bad_messages);
      Put16(payload + 2, board.counters.overruns);
      Put16(payload + 4, board.counters.missed);
      Put16(payload + 6, board.counters.recoveries);
      return Answer::kGood;
  }
  return Answer::kUnknown;
}

}  // namespace internal

/// Processes a complete message from the bus, between ticks. `to_all`: whether the message was sent
/// to the general-call address, like broadcasts and emergency stops. Requests go to the address of
/// one board.
inline void Receive(const uint8_t* bytes, size_t size, bool to_all, Board& board) noexcept {
  if (!to_all) {
    Asking asking;
    if (Decode(bytes, size, asking) != Decoded::kGood)
      return internal::Count(board.counters.bad_messages);
    Reply& reply = board.reply;
    reply = Reply();
    reply.what = asking.what;
    reply.index = asking.index;
    switch (asking.request) {
      case Request::kSet:
        reply.answer = internal::SetParameter(board, asking);
        break;
      case Request::kDo:
        reply.answer = internal::Do(board, asking);
        break;
      case Request::kAsk:
        reply.answer = internal::Ask(board, asking, reply.payload);
    }
    board.reply_due = true;
    return;
  }
  if (IsStop(bytes, size)) {
    board.stopped = true;  // cancels a pending command
    board.command_due = false;
    return;
  }
  Command command;
  if (Decode(bytes, size, static_cast<uint8_t>(kMotors * board.boot.board), command) !=
      Decoded::kGood) {
    return internal::Count(board.counters.bad_messages);
  }
  if (board.heard && command.sequence == board.command.sequence) return;  // repeated broadcast
  board.command = command;
  board.heard = true;
  board.command_due = true;
  board.silence = 0;
}

/// Returns the part of a status frame about one motor.
inline MotorStatus StatusOf(const Board& board, uint8_t m) noexcept {
  const MotorLoop& motor = board.loops[m];
  const float* const p = board.parameters.motor[m];
  MotorStatus out;
  out.tension_quarters =
      static_cast<uint16_t>(control::Clamp(motor.tension_counts, 0.0f, 1023.0f) * 4.0f);
  if (board.mode == Mode::kImpedance) {
    const float counts = motor.set_point_n * board.numbers[m].counts_per_n + p[kCountsAtZero];
    out.set_point_quarters = counts < 1023.0f ? static_cast<uint16_t>(counts * 4.0f) : 4095;
  }
  out.encoder_counts = static_cast<uint16_t>(motor.counts);
  out.duty = static_cast<int8_t>(motor.width * int32_t{127} / kFullWidth);
  return out;
}

/// Fills the frame for the next read. Call it if `reply_due`, or after a tick if `status_due`.
inline void MakeFrame(Board& board, uint8_t (&frame)[kFrameSize]) noexcept {
  if (board.reply_due) {
    Encode(board.reply, board.boot.board, frame);
    return;
  }
  Status status;
  status.sequence = board.command.sequence;
  status.mode = board.stopped ? Mode::kStopped : board.mode;
  status.referenced = board.referenced[0] && board.referenced[1];
  status.faulty = board.faults[0] != 0 || board.faults[1] != 0 || board.board_faults != 0;
  status.timeout = board.timeout;
  status.overrun = board.overrun_seen;
  status.was_reset = board.was_reset;
  for (uint8_t m = 0; m < kMotors; ++m) status.motors[m] = StatusOf(board, m);
  switch (static_cast<More>(status.sequence % kMores)) {
    case More::kFaults0:
      status.more = board.faults[0];
      break;
    case More::kFaults1:
      status.more = board.faults[1];
      break;
    case More::kBoardFaults:
      status.more = board.board_faults;
      break;
    case More::kCrcErrors:
      status.more = static_cast<uint8_t>(board.counters.bad_messages);
      break;
    case More::kOverruns:
      status.more = static_cast<uint8_t>(board.counters.overruns);
      break;
    case More::kLoopTime8us:
      status.more = board.longest_tick_8us;
      board.longest_tick_8us = 0;
      break;
    case More::kResetCause:
      status.more = board.boot.reset_cause;
      break;
    case More::kTemperature0C:
      status.more = board.temperature_c[0];
      break;
    case More::kTemperature1C:
      status.more = board.temperature_c[1];
      break;
    case More::kFirmwareMajor:
      status.more = kFirmwareMajor;
      break;
    case More::kFirmwareMinor:
      status.more = kFirmwareMinor;
      break;
    case More::kProtocol:
      status.more = kProtocolVersion;
      break;
    case More::kParametersCrc:
      status.more = static_cast<uint8_t>(kParametersVersion);
      break;
    case More::kNonce:
      status.more = static_cast<uint8_t>(board.boot.nonce);
      break;
    case More::kMissed:
      status.more = static_cast<uint8_t>(board.counters.missed);
      break;
    case More::kRecoveries:
      status.more = static_cast<uint8_t>(board.counters.recoveries);
      break;
  }
  board.overrun_seen = false;
  Encode(status, board.boot.board, frame);
}

}  // namespace board
}  // namespace taut
