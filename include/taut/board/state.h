/// What a motor board is and remembers. Freestanding C++14.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "taut/board/faults.h"
#include "taut/board/motor_loop.h"
#include "taut/board/parameters.h"
#include "taut/board/protocol.h"
#include "taut/board/watch.h"

namespace taut {
namespace board {

constexpr uint8_t kFirmwareMajor = 0, kFirmwareMinor = 2;

constexpr uint8_t kFreezeTicks = 30;    ///< Without a broadcast: inputs become 0.
constexpr uint8_t kTimeoutTicks = 100;  ///< Without a broadcast: hold or off, until cleared.

/// What a tick takes from the chip.
struct Inputs {
  uint16_t adc[kMotors];      ///< 0 .. 1023.
  uint16_t encoder[kMotors];  ///< Modulo 2^16; winding in positive.
  bool driver_fault;
  uint8_t elapsed;  ///< Ticks of the timer since the last call; 1 if none was missed.
};

/// What the EEPROM is to do next; the chip's side takes it and says when it is done.
enum class Memory : uint8_t { kIdle, kStore, kLoad };

/// What begins a board.
struct Boot {
  uint8_t board = 0;  ///< 0 .. kBoards - 1.
  uint16_t nonce = 0;
  uint8_t reset_cause = kPowerOn;  ///< `ResetCause` bits.
  bool parameters_good = true;  ///< What stands in `Board::parameters` came whole from the EEPROM.
};

struct Counters {
  uint16_t bad_messages = 0;  ///< With a wrong checksum, size or content.
  uint16_t overruns = 0;      ///< Ticks of the timer that found the one before still at work.
  uint16_t missed = 0;        ///< Times that no broadcast came for kFreezeTicks.
  uint16_t recoveries = 0;    ///< Of the bus.
};

struct Board {
  Parameters parameters;
  MotorLoop loops[kMotors];
  LoopNumbers numbers[kMotors];  ///< Of the parameters: `Prepare`.
  Boot boot;
  Mode mode = Mode::kOff;
  bool armed = false, ready = false, stopped = false, timeout = false, was_reset = true;
  bool referenced[kMotors] = {false, false};
  uint8_t faults[kMotors] = {0, 0};
  uint8_t board_faults = 0;

  // the bus
  bool heard = false;        ///< A broadcast ever came.
  bool command_due = false;  ///< One waits for the next tick, which applies it as a whole.
  bool reply_due = false;    ///< The next frame read is `reply`.
  bool status_due = false;   ///< The next tick is followed by a new status.
  bool overrun_seen = false;
  uint8_t silence = 0;   ///< Ticks since the last good broadcast.
  uint8_t loop_8us = 0;  ///< The longest tick since the last status.
  Command command;
  Reply reply;
  Counters counters;
  Memory memory = Memory::kIdle;

  // watching
  Watch watches[kMotors];
  WatchLimits limits[kMotors];
  HeatNumbers heat[kMotors];
  uint8_t turn = 0;  ///< Which of the slow works is due: a tick does one.
  uint8_t temperature_c[kMotors] = {0, 0};
  uint16_t second_ticks = 0;
  uint8_t second_overruns = 0;
};

/// Has to follow every change of a motor's parameters but of gains; of the board's, for both. 0.4
/// ms on the chip.
inline void Prepare(Board& board, uint8_t m) noexcept {
  board.numbers[m] = NumbersOf(board.parameters.motor[m]);
  board.limits[m] = LimitsOf(board.parameters.motor[m]);
  board.heat[m] = HeatOf(board.parameters.board, board.parameters.motor[m][kLengthPerCount]);
}
inline void Prepare(Board& board) noexcept {
  for (uint8_t m = 0; m < kMotors; ++m) Prepare(board, m);
}

inline bool IsHealthy(const Board& board) noexcept {
  return board.faults[0] == 0 && board.faults[1] == 0 && board.board_faults == 0 &&
         !board.timeout && !board.stopped;
}

namespace internal {

inline void Count(uint16_t& counter) noexcept {
  if (counter != 0xffff) ++counter;
}

}  // namespace internal

}  // namespace board
}  // namespace taut
