/// Firmware of the motor boards of one simulated robot (docs/theory/boards.md): booting, ticks of
/// 1 ms, broadcasts and status frames.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "description/robot/board_settings.h"
#include "taut/board/board.h"
#include "taut/lane_state.h"

namespace taut::plant {

/// Load cell and encoder of a motor, read at the start of a tick.
struct MotorInputs {
  int code = 0;             ///< Reading of the converter, 0 .. 1023.
  std::int64_t counts = 0;  ///< Encoder counts since the start; winding in is positive.
};

/// Readings of a motor in the last status frame.
struct MotorReadings {
  double rest_length_m = 0, length_m = 0, rate_m_per_s = 0;
  double tension_n = 0;     ///< Filtered and quantized; may be below 0.
  double set_point_n = 0;   ///< 0 if the board does not control the tension.
  std::uint8_t faults = 0;  ///< `board::MotorFault` bits.
};

class BoardLane {
 public:
  explicit BoardLane(int motors);

  /// Sets the parameters of all boards for the next start.
  void Configure(const BoardsSpec& boards, const ModelDef& def, const std::vector<int>& cables,
                 const std::vector<ControllerSpec>& controllers);

  /// Starts the boards in mode kHold, without faults. References are the rest lengths in the model.
  void Start(std::span<const MotorInputs> inputs);

  /// Sends a broadcast, which the next tick applies. `values`: V0 [m/s] or rest lengths [m].
  void Broadcast(board::Mode mode, bool capture, std::span<const double> values);

  /// Runs a tick. `time_s`: for the text about faults.
  void Tick(std::span<const MotorInputs> inputs, double time_s);

  /// Reads the status frames. `since_s`: time since the previous status; 0: none.
  void ReadStatus(double since_s);

  bool HasFault() const { return faulty_motor_ >= 0; }
  bool IsPowered(int motor) const { return board::IsPowered(BoardOf(motor)); }
  /// Returns the duty of a motor, -1 .. 1; positive winds in.
  double Duty(int motor) const;
  const MotorReadings& readings(int motor) const {
    return readings_[static_cast<std::size_t>(motor)];
  }

  /// Returns a text about the first fault; empty if there is none. `names`: names of the motors'
  /// cables.
  std::string Faults(const std::vector<std::string>& names) const;

  void Serialize(LaneState& state);

 private:
  const board::Board& BoardOf(int motor) const {
    return boards_[static_cast<std::size_t>(motor / board::kMotors)];
  }

  std::vector<board::Parameters> parameters_;  ///< Per board.
  std::vector<board::Board> boards_;
  std::vector<MotorReadings> readings_;  ///< Per motor.
  std::uint8_t sequence_ = 0;
  // The first fault of the robot.
  int faulty_motor_ = -1;
  std::uint8_t first_faults_ = 0;
  double faulty_s_ = 0;
};

}  // namespace taut::plant
