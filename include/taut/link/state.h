/// What the PC knows of a robot, cycle by cycle. Plain data.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "taut/board/board.h"

namespace taut::link {

/// What a board's numbers mean, as it is set.
struct MotorFigures {
  double n_per_count = 0.1567, counts_at_zero = 31.5;  ///< Of the load cell.
  double m_per_count = 1.34e-5;  ///< Of the encoder; winding in counts up and shortens.
  double rest_length_at_reference_m = 0.2;
  double stiffness_n_per_m = 227;
};

struct MotorView {
  double tension_n = 0;                                           ///< Filtered by the board.
  double set_point_n = std::numeric_limits<double>::quiet_NaN();  ///< NaN where it has none.
  std::int64_t encoder_counts = 0;                                ///< From the reference.
  double rest_length_m = 0;                                       ///< From the encoder.
  double length_m = 0;      ///< The spring's stretch by the tension added.
  double duty = 0;          ///< -1 .. 1; winding in positive.
  std::uint8_t faults = 0;  ///< `board::MotorFault` bits.
  int temperature_c = 0;    ///< Of the winding, as the board computes it.
};

struct BoardView {
  bool there = false;            ///< Answered within the last cycles.
  double heard_s = -1;           ///< When a whole status came last; negative: never.
  board::Status status;          ///< Of then.
  board::Info info;              ///< When it was asked who it is.
  std::uint8_t faults = 0;       ///< `board::BoardFault` bits.
  std::uint8_t reset_cause = 0;  ///< `board::ResetCause` bits.
  double loop_time_s = 0;        ///< The longest tick, as said last.
  int bad_messages = 0, late_ticks = 0, missed_broadcasts = 0, bus_recoveries = 0;  ///< Mod 256.
  std::int64_t bad_frames = 0;    ///< That came from it with a wrong checksum, or not at all.
  std::int64_t stale_frames = 0;  ///< That did not know the broadcast before them.
};

/// Of the way between PC and boards.
struct LinkView {
  bool connected = false;
  std::int64_t cycles = 0;
  std::int64_t late_cycles = 0;         ///< That had not ended when the next was due.
  std::int64_t silent_transfers = 0;    ///< Without a reply from the adapter.
  std::int64_t unheard_broadcasts = 0;  ///< That nobody acknowledged.
  std::int64_t adapter_resets = 0, reconnections = 0;
  double cycle_s = 0, mean_cycle_s = 0, longest_cycle_s = 0;  ///< From begin to the last frame.
  double lateness_s = 0, mean_lateness_s = 0, longest_lateness_s = 0;  ///< Of the beginning.
  std::int64_t failed_group_reads = 0;  ///< Of several boards: as a whole, of whichever of them.
};

enum class Stage { kUnconfigured, kInactive, kReady, kActive };

struct State {
  double time_s = 0;  ///< Of the port's clock, at the cycle's end.
  Stage stage = Stage::kUnconfigured;
  board::Mode commanded = board::Mode::kOff;
  bool stopping = false;         ///< An emergency stop, until faults are cleared.
  bool power_commanded = false;  ///< This driver has commanded motor power before.
  std::vector<MotorView> motors;
  std::vector<BoardView> boards;
  LinkView link;
};

/// Whether every board is there, in this mode and without faults.
inline bool AllAre(board::Mode mode, const State& state) {
  return std::all_of(state.boards.begin(), state.boards.end(), [mode](const BoardView& board) {
    return board.there && board.status.mode == mode && !board.status.faulty;
  });
}

/// Of all boards: frames that came with a wrong checksum, or not at all.
inline std::int64_t BadFrames(const State& state) {
  std::int64_t sum = 0;
  for (const BoardView& board : state.boards) sum += board.bad_frames;
  return sum;
}

}  // namespace taut::link
