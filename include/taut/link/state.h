/// State of a robot as received by the PC in each cycle. Plain data.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "taut/board/board.h"

namespace taut::link {

/// Scales of a motor's numbers, from the board's parameters.
struct MotorFigures {
  double n_per_count = 0.1567, counts_at_zero = 31.5;  ///< Of the load cell.
  /// Of the encoder; winding in increases counts and shortens the cable.
  double m_per_count = 1.34e-5;
  double rest_length_at_reference_m = 0.2;
  double stiffness_n_per_m = 227;
};

struct MotorView {
  double tension_n = 0;                                           ///< Filtered by the board.
  double set_point_n = std::numeric_limits<double>::quiet_NaN();  ///< NaN: none.
  std::int64_t encoder_counts = 0;                                ///< From the reference.
  double rest_length_m = 0;                                       ///< From the encoder.
  double length_m = 0;      ///< Rest length plus the spring's stretch by the tension.
  double duty = 0;          ///< -1 .. 1; winding in positive.
  std::uint8_t faults = 0;  ///< `board::MotorFault` bits.
  int temperature_c = 0;    ///< Of the winding, computed by the board.
};

struct BoardView {
  bool there = false;            ///< Answered within the last cycles.
  double heard_s = -1;           ///< Time of the last complete status; negative: none.
  board::Status status;          ///< Last status.
  board::Info info;              ///< From its identification.
  std::uint8_t faults = 0;       ///< `board::BoardFault` bits.
  std::uint8_t reset_cause = 0;  ///< `board::ResetCause` bits.
  double loop_time_s = 0;        ///< Longest tick, as last reported.
  int bad_messages = 0, late_ticks = 0, missed_broadcasts = 0, bus_recoveries = 0;  ///< Mod 256.
  std::int64_t bad_frames = 0;    ///< Frames with a wrong checksum or missing.
  std::int64_t stale_frames = 0;  ///< Frames older than the preceding broadcast.
};

/// Statistics of the connection between PC and boards.
struct LinkView {
  bool connected = false;
  std::int64_t cycles = 0;
  std::int64_t late_cycles = 0;         ///< Cycles that had not ended when the next was due.
  std::int64_t silent_transfers = 0;    ///< Without a reply from the adapter.
  std::int64_t unheard_broadcasts = 0;  ///< Broadcasts without an acknowledgment.
  std::int64_t adapter_resets = 0, reconnections = 0;
  double cycle_s = 0, mean_cycle_s = 0, longest_cycle_s = 0;  ///< From its start to the last frame.
  double lateness_s = 0, mean_lateness_s = 0, longest_lateness_s = 0;  ///< Delay of its start.
  std::int64_t failed_group_reads = 0;  ///< Failed reads of several boards at once.
};

enum class Stage { kUnconfigured, kInactive, kReady, kActive };

struct State {
  double time_s = 0;  ///< Of the port's clock, at the cycle's end.
  Stage stage = Stage::kUnconfigured;
  board::Mode commanded = board::Mode::kOff;
  bool stopping = false;         ///< Emergency stop, until faults are cleared.
  bool power_commanded = false;  ///< This driver has commanded motor power before.
  std::vector<MotorView> motors;
  std::vector<BoardView> boards;
  LinkView link;
};

/// Returns whether every board answers, in this mode and without faults.
inline bool AllAre(board::Mode mode, const State& state) {
  return std::all_of(state.boards.begin(), state.boards.end(), [mode](const BoardView& board) {
    return board.there && board.status.mode == mode && !board.status.faulty;
  });
}

/// Returns the number of frames of all boards that had a wrong checksum or were missing.
inline std::int64_t BadFrames(const State& state) {
  std::int64_t sum = 0;
  for (const BoardView& board : state.boards) sum += board.bad_frames;
  return sum;
}

}  // namespace taut::link
