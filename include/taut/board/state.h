/// State of a motor board: parameters, motor loops, faults, bus, temperatures. Freestanding C++14.
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

constexpr uint8_t kFreezeTicks = 30;  ///< Ticks without a broadcast until inputs become 0.
/// Ticks without a broadcast until the board holds or switches off (timeout).
constexpr uint8_t kTimeoutTicks = 100;

/// Inputs of a tick, read from the chip.
struct Inputs {
  uint16_t adc[kMotors];      ///< Load cell readings, 0 .. 1023.
  uint16_t encoder[kMotors];  ///< Modulo 2^16; increases when winding in.
  bool driver_fault;
  uint8_t elapsed;  ///< Timer ticks since the previous call; 1 without missed ticks.
};

/// Pending EEPROM operation. The code for the chip performs it and then sets kIdle.
enum class Memory : uint8_t { kIdle, kStore, kLoad };

/// Data of a board at its start.
struct Boot {
  uint8_t board = 0;  ///< 0 .. kBoards - 1.
  uint16_t nonce = 0;
  uint8_t reset_cause = kPowerOn;  ///< `ResetCause` bits.
  /// Whether `Board::parameters` were loaded from the EEPROM with a valid checksum.
  bool parameters_good = true;
};

struct Counters {
  uint16_t bad_messages = 0;  ///< Messages with a wrong checksum, size or content.
  uint16_t overruns = 0;      ///< Timer ticks during which the previous tick was still running.
  uint16_t missed = 0;        ///< Number of times that no broadcast arrived for kFreezeTicks.
  uint16_t recoveries = 0;    ///< Restarts of the I2C bus.
};

struct Board {
  Parameters parameters;
  MotorLoop loops[kMotors];
  LoopNumbers numbers[kMotors];  ///< Computed from the parameters by `Prepare`.
  Boot boot;
  Mode mode = Mode::kOff;
  bool armed = false, ready = false, stopped = false, timeout = false, was_reset = true;
  bool referenced[kMotors] = {false, false};
  uint8_t faults[kMotors] = {0, 0};
  uint8_t board_faults = 0;

  // State of the bus.
  bool heard = false;        ///< At least one broadcast was received since the start.
  bool command_due = false;  ///< The next tick applies `command`.
  bool reply_due = false;    ///< The next read returns `reply`.
  bool status_due = false;   ///< A new status is due after the next tick.
  bool overrun_seen = false;
  uint8_t silence = 0;           ///< Ticks since the last valid broadcast.
  uint8_t longest_tick_8us = 0;  ///< Longest tick since the last status, in units of 8 us.
  Command command;
  Reply reply;
  Counters counters;
  Memory memory = Memory::kIdle;

  // State of the monitoring.
  Watch watches[kMotors];
  WatchLimits limits[kMotors];
  HeatNumbers heat[kMotors];
  uint8_t turn = 0;  ///< Gain that `DoSlowWork` processes next; one per tick.
  uint8_t temperature_c[kMotors] = {0, 0};
  uint16_t second_ticks = 0;
  uint8_t second_overruns = 0;
};

/// Updates the numbers that depend on the parameters of a motor, in 0.4 ms on the chip. Call it
/// after each change of a motor's parameters other than gains. After a change of board parameters,
/// call it for both motors.
inline void Prepare(Board& board, uint8_t m) noexcept {
  board.numbers[m] = NumbersOf(board.parameters.motor[m]);
  board.limits[m] = LimitsOf(board.parameters.motor[m]);
  board.heat[m] = HeatOf(board.parameters.board, board.parameters.motor[m][kLengthPerCount]);
}
/// Updates the numbers that depend on parameters, for both motors.
inline void Prepare(Board& board) noexcept {
  for (uint8_t m = 0; m < kMotors; ++m) Prepare(board, m);
}

/// Returns whether a board has no fault, timeout or emergency stop.
inline bool IsHealthy(const Board& board) noexcept {
  return board.faults[0] == 0 && board.faults[1] == 0 && board.board_faults == 0 &&
         !board.timeout && !board.stopped;
}

namespace internal {

/// Increments a counter and saturates at 65535.
inline void Count(uint16_t& counter) noexcept {
  if (counter != 0xffff) ++counter;
}

}  // namespace internal

}  // namespace board
}  // namespace taut
