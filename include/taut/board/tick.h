/// Control tick of a motor board (1 ms): faults, commands, control laws and monitoring.
/// Freestanding C++14.
#pragma once

#include "taut/board/state.h"

namespace taut {
namespace board {
namespace internal {

/// Enters a mode. Control laws start from the present drive (bumpless transfer).
inline void Enter(Mode mode, bool capture, Board& board) noexcept {
  board.mode = mode;
  for (uint8_t m = 0; m < kMotors; ++m) {
    MotorLoop& motor = board.loops[m];
    float* const p = board.parameters.motor[m];
    switch (mode) {
      case Mode::kHold:
        motor.target_counts = motor.counts;
        StartPosition(board.numbers[m], motor);
        break;
      case Mode::kPosition:
        StartPosition(board.numbers[m], motor);
        break;
      case Mode::kImpedance:
        StartImpedance(p, board.numbers[m], capture, motor);
        break;
      default:
        motor.drive = 0.0f;
        motor.set_point_n = 0.0f;
    }
  }
}

/// Applies the values of the last broadcast in the present mode.
inline void TakeValues(Board& board) noexcept {
  const Command& command = board.command;
  for (uint8_t m = 0; m < kMotors; ++m) {
    MotorLoop& motor = board.loops[m];
    const int16_t value = command.values[m];
    if (board.mode == Mode::kPosition) motor.target_counts = value;
    if (board.mode == Mode::kImpedance) {
      motor.velocity_input_m_per_s =
          command.zero_inputs ? 0.0f : static_cast<float>(value) * kSpeedUnit_m_per_s;
    }
    if (board.mode == Mode::kDuty)
      motor.drive_input = static_cast<float>(value) * (kFullWidth / 32767.0f);
  }
}

/// Returns whether a mode needs encoder references.
inline bool Needs(Mode mode, bool capture) noexcept {
  return mode == Mode::kPosition || (mode == Mode::kImpedance && !capture);
}

/// Applies the last broadcast if it is permitted. Returns true if a new control law starts. The new
/// law computes its first duty in the next tick. Until that tick, the duties do not change, and
/// this tick needs no further work.
inline bool Apply(Board& board) noexcept {
  const Command& command = board.command;
  board.command_due = false;
  board.status_due = true;
  const bool off = command.mode == Mode::kOff;
  if (command.clear_faults && (off || command.mode == Mode::kHold)) {
    board.faults[0] = board.faults[1] = board.board_faults = 0;
    board.timeout = board.stopped = board.was_reset = false;
  }
  if (command.arm != Arm::kGo || off || board.stopped) {
    board.armed = command.arm == Arm::kGo && board.armed && !board.stopped;
    board.ready = command.arm == Arm::kReady && off && IsHealthy(board);
    if (board.mode != Mode::kOff) Enter(Mode::kOff, false, board);
    return false;
  }
  if (!board.armed) {
    if (!board.ready || !IsHealthy(board)) {
      board.board_faults |= kNotArmed;
      return false;
    }
    board.armed = true;
    board.ready = false;
  }
  // The reaction to a fault, timeout or stop continues until a broadcast clears the cause.
  if (!IsHealthy(board)) return false;
  if (Needs(command.mode, command.capture) && board.mode != command.mode &&
      !(board.referenced[0] && board.referenced[1])) {
    board.board_faults |= kUnreferenced;
    return false;
  }
  if (command.mode == board.mode) {
    TakeValues(board);
    return false;
  }
  // The first target must be set before the PID of a position starts, and the previous V0 must not
  // remain.
  const Mode before = board.mode;
  board.mode = command.mode;
  for (uint8_t m = 0; m < kMotors; ++m) board.loops[m].velocity_input_m_per_s = 0.0f;
  TakeValues(board);
  board.mode = before;
  Enter(command.mode, command.capture, board);
  return true;
}

/// Reacts to missing broadcasts and to faults of the motors and the board.
inline void React(bool driver_fault, Board& board) noexcept {
  const bool runs = board.mode != Mode::kOff && board.mode != Mode::kStopped;
  if (driver_fault && runs) board.board_faults |= kDriverFault;
  if (board.stopped || (board.board_faults & kDriverFault) != 0) {
    if (runs) Enter(Mode::kOff, false, board);
    board.armed = false;
    return;
  }
  if (!runs) return;
  if (board.silence >= kFreezeTicks && board.mode != Mode::kHold) {
    for (uint8_t m = 0; m < kMotors; ++m) {
      board.loops[m].velocity_input_m_per_s = 0.0f;
      board.loops[m].drive_input = 0.0f;
    }
  }
  if (board.silence >= kTimeoutTicks && !board.timeout) {
    board.timeout = true;
    if (board.parameters.board[kOnTimeout] >= 0.5f) {
      Enter(Mode::kOff, false, board);
      board.armed = false;
      return;  // so that a further fault does not start kHold
    }
    if (board.mode != Mode::kImpedance && board.mode != Mode::kHold) {
      Enter(Mode::kHold, false, board);  // impedance control continues with V0 = 0
    }
  }
  const bool faulty = board.faults[0] != 0 || board.faults[1] != 0 || board.board_faults != 0;
  if (faulty && board.mode != Mode::kHold) Enter(Mode::kHold, false, board);
}

/// Removes power from a motor with a fault. If its tension is too high, the motor unwinds until the
/// tension is low enough.
inline void Restrain(Board& board, uint8_t m) noexcept {
  if (board.faults[m] == 0) return;
  constexpr float kPayOut = -0.3f * kFullWidth;
  MotorLoop& motor = board.loops[m];
  const float* const p = board.parameters.motor[m];
  const bool too_much = board.mode != Mode::kOff && (board.faults[m] & kOverTension) != 0 &&
                        (board.faults[m] & (kSensor | kPolarity | kRunaway)) == 0 &&
                        Tension(p, motor) > p[kTensionLimit] - p[kTensionBand];
  motor.drive = too_much ? control::Max(kPayOut, -board.numbers[m].most_drive) : 0.0f;
}

/// Counts late ticks and ticks without a broadcast.
inline void CountTicks(uint8_t elapsed, Board& board) noexcept {
  const uint8_t late = static_cast<uint8_t>(elapsed - 1);
  for (uint8_t i = 0; i < late; ++i) Count(board.counters.overruns);
  if (late > 0) board.overrun_seen = true;
  board.second_overruns =
      static_cast<uint8_t>(board.second_overruns + late < 255 ? board.second_overruns + late : 255);
  board.second_ticks = static_cast<uint16_t>(board.second_ticks + elapsed);
  if (board.second_ticks >= 1000) {
    if (board.second_overruns > 50) board.board_faults |= kTooManyOverruns;
    board.second_ticks = 0;
    board.second_overruns = 0;
  }
  if (!board.heard) return;
  const uint8_t before = board.silence;
  board.silence = static_cast<uint8_t>(before + elapsed < 255 ? before + elapsed : 255);
  if (before < kFreezeTicks && board.silence >= kFreezeTicks) Count(board.counters.missed);
}

}  // namespace internal

/// Runs one tick of 1 ms. Results: the duties in `loops[m].width`, and the driver's power state
/// from `IsPowered`.
inline void Tick(const Inputs& in, Board& board) noexcept {
  internal::CountTicks(in.elapsed, board);
  for (uint8_t m = 0; m < kMotors; ++m) {
    MotorLoop& motor = board.loops[m];
    Sense(board.parameters.motor[m], in.adc[m], in.encoder[m], motor);
    const uint8_t wrong =
        DetectFaults(board.limits[m], in.adc[m], motor.step, motor.width, board.watches[m]);
    if (wrong != 0 && board.mode != Mode::kOff) board.faults[m] |= wrong;
  }
  internal::React(in.driver_fault, board);
  if (board.command_due && internal::Apply(board)) return;
  for (uint8_t m = 0; m < kMotors; ++m) {
    const float* const p = board.parameters.motor[m];
    MotorLoop& motor = board.loops[m];
    switch (board.mode) {
      case Mode::kHold:
      case Mode::kPosition:
        StepPosition(board.numbers[m], motor);
        break;
      case Mode::kImpedance:
        StepImpedance(p, board.numbers[m], motor);
        break;
      case Mode::kDuty:
        StepDuty(board.numbers[m], motor);
        break;
      default:
        motor.drive = 0.0f;
        motor.step = 0;  // for `Feel`: no current flows, even if the cable turns the motor
    }
    internal::Restrain(board, m);
    motor.width = static_cast<int16_t>(motor.drive);
  }
}

/// Returns whether the driver is on. Motors coast if it is off and brake if it is on with duty 0.
inline bool IsPowered(const Board& board) noexcept {
  return board.mode != Mode::kOff && board.mode != Mode::kStopped && !board.stopped;
}

/// Adds this tick to the heat sums of the motors. Call it after every tick.
inline void Feel(Board& board) noexcept {
  for (uint8_t m = 0; m < kMotors; ++m) {
    FeelHeat(board.loops[m].width, board.loops[m].step, board.watches[m]);
  }
}

/// Performs one slow task: updates the temperature of a motor or moves a gain. Call it after ticks
/// with enough time left.
inline void DoSlowWork(Board& board) noexcept {
  for (uint8_t m = 0; m < kMotors; ++m) {
    Watch& watch = board.watches[m];
    if (watch.felt < kThermalTicks) continue;
    float temperature_c = StepTemperature(board.heat[m], board.parameters.board, watch);
    if (temperature_c > board.parameters.board[kTemperatureLimit]) board.faults[m] |= kHot;
    temperature_c = control::Clamp(temperature_c, 0.0f, 255.0f);
    board.temperature_c[m] = static_cast<uint8_t>(temperature_c);
    return;
  }
  if (board.mode != Mode::kImpedance) return;
  board.turn = static_cast<uint8_t>((board.turn + 1) % 8);
  const uint8_t m = board.turn / kGains;
  SlewGain(board.parameters.motor[m], board.turn % kGains, 8 * kTick_s, board.loops[m]);
}

}  // namespace board
}  // namespace taut
