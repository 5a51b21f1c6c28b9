/// State of a robot as received by the PC in each cycle. Plain data.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "taut/board/board.h"

namespace taut::link {

/// Scales of the numbers of a motor, from the board parameters.
struct MotorFigures {
  double n_per_count = 0.1567, counts_at_zero = 31.5;  ///< Scale of the load cell.
  /// Encoder; winding in increases the count and shortens the cable.
  double m_per_count = 1.34e-5;
  double rest_length_at_reference_m = 0.2;
  double stiffness_n_per_m = 227;
};

struct MotorView {
  double tension_n = 0;  ///< Tension, filtered by the board.
  double set_point_n = std::numeric_limits<double>::quiet_NaN();  ///< Tension set point; NaN: none.
  std::int64_t encoder_counts = 0;  ///< Relative to the reference position.
  double rest_length_m = 0;         ///< Rest length from the encoder count.
  double length_m = 0;      ///< Rest length plus the extension of the spring by the tension.
  double duty = 0;          ///< Duty of the motor, -1 .. 1; positive winds in.
  std::uint8_t faults = 0;  ///< `board::MotorFault` bits.
  int temperature_c = 0;    ///< Winding temperature, computed by the board.
};

struct BoardView {
  bool there = false;            ///< The board replied within the last cycles.
  double heard_s = -1;           ///< Time of the last complete status; negative: none.
  board::Status status;          ///< Last status.
  board::Info info;              ///< From the identification of the board.
  std::uint8_t faults = 0;       ///< `board::BoardFault` bits.
  std::uint8_t reset_cause = 0;  ///< `board::ResetCause` bits.
  double loop_time_s = 0;        ///< Last reported longest tick.
  int bad_messages = 0, late_ticks = 0, missed_broadcasts = 0, bus_recoveries = 0;  ///< Modulo 256.
  std::int64_t bad_frames = 0;    ///< Frames that were missing or had a wrong checksum.
  std::int64_t stale_frames = 0;  ///< Frames from before the last broadcast.
};

/// Statistics of the connection between PC and boards.
struct LinkView {
  bool connected = false;
  std::int64_t cycles = 0;
  std::int64_t late_cycles = 0;         ///< Cycles that ended after the next one was due.
  std::int64_t silent_transfers = 0;    ///< Transfers without a reply from the adapter.
  std::int64_t unheard_broadcasts = 0;  ///< Broadcasts without an acknowledgment.
  std::int64_t adapter_resets = 0, reconnections = 0;
  /// Time from the start of a cycle to its last frame.
  double cycle_s = 0, mean_cycle_s = 0, longest_cycle_s = 0;
  /// Delay of the start of a cycle.
  double lateness_s = 0, mean_lateness_s = 0, longest_lateness_s = 0;
  std::int64_t failed_group_reads = 0;  ///< Failed combined reads of several boards.
};

enum class Stage { kUnconfigured, kInactive, kReady, kActive };

struct State {
  double time_s = 0;  ///< Time of the port's clock at the end of the cycle.
  Stage stage = Stage::kUnconfigured;
  board::Mode commanded = board::Mode::kOff;
  bool stopping = false;         ///< Emergency stop in effect, until faults are cleared.
  bool power_commanded = false;  ///< This driver has commanded motor power at least once.
  std::vector<MotorView> motors;
  std::vector<BoardView> boards;
  LinkView link;
};

/// Returns whether every board answers, has this mode and has no fault.
inline bool AllAre(board::Mode mode, const State& state) {
  return std::all_of(state.boards.begin(), state.boards.end(), [mode](const BoardView& board) {
    return board.there && board.status.mode == mode && !board.status.faulty;
  });
}

/// Returns the number of missing or wrong frames of all boards.
inline std::int64_t BadFrames(const State& state) {
  std::int64_t sum = 0;
  for (const BoardView& board : state.boards) sum += board.bad_frames;
  return sum;
}

}  // namespace taut::link
