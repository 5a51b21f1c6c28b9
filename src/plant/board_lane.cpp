#include "plant/board_lane.h"

#include <algorithm>
#include <cstdio>

#include "base/bit_names.h"

namespace taut::plant {
namespace {

void Serialize(LaneState& state, board::MotorLoop& loop) {
  state.Values(loop.encoder, loop.step, loop.counts, loop.tension_counts, loop.counts_per_tick,
               loop.tension_n, loop.rest_length_m, loop.length_m, loop.rate_m_per_s,
               loop.target_counts, loop.velocity_input_m_per_s, loop.drive_input);
  control::Impedance<float>& gains = loop.gains;
  state.Values(gains.tension_offset_n, gains.length_offset_m, gains.position_gain_n_per_m,
               gains.velocity_gain_n_s_per_m);
  state.Values(loop.pid.integral, loop.pid.error_before, loop.set_point_n, loop.drive, loop.width);
}

void Serialize(LaneState& state, board::Watch& watch) {
  state.Values(watch.sensor, watch.over, watch.fast, watch.much_duty, watch.winds, watch.way,
               watch.slack_way, watch.adc, watch.winding_rise_k, watch.housing_rise_k,
               watch.width_width, watch.width_step, watch.step_step, watch.felt);
}

/// Serializes the data of a board that can change if the board receives only broadcasts.
void Serialize(LaneState& state, board::Board& board) {
  for (std::uint8_t m = 0; m < board::kMotors; ++m) {
    Serialize(state, board.loops[m]);
    Serialize(state, board.watches[m]);
    state.Values(board.faults[m], board.referenced[m], board.temperature_c[m]);
    for (float& parameter : board.parameters.motor[m]) state.Value(parameter);
    if (state.reads()) board::Prepare(board, m);
  }
  board::Command& command = board.command;
  state.Values(board.mode, board.armed, board.ready, board.stopped, board.timeout, board.was_reset,
               board.board_faults, board.heard, board.command_due, board.status_due, board.silence,
               board.turn, board.second_ticks, board.second_overruns, command.sequence,
               command.mode, command.capture, command.clear_faults, command.zero_inputs,
               command.arm);
  for (std::int16_t& value : command.values) state.Value(value);
}

}  // namespace

BoardLane::BoardLane(int motors)
    : parameters_(static_cast<std::size_t>((motors + board::kMotors - 1) / board::kMotors)),
      boards_(parameters_.size()),
      readings_(static_cast<std::size_t>(motors)) {
  for (board::Parameters& parameters : parameters_) board::SetDefaults(parameters);
  // A connector without a motor must not report a stall.
  if (motors % board::kMotors != 0) parameters_.back().motor[1][board::kDutyLimit] = 0.0f;
}

void BoardLane::Configure(const BoardsSpec& boards, const ModelDef& def,
                          const std::vector<int>& cables,
                          const std::vector<ControllerSpec>& controllers) {
  const auto common = description::CommonMotorSettings(boards);
  const auto of_board = description::CommonBoardSettings(boards);
  for (std::size_t motor = 0; motor < readings_.size(); ++motor) {
    board::Parameters& parameters = parameters_[motor / board::kMotors];
    for (const auto& [parameter, value] : of_board) {
      parameters.board[parameter] = static_cast<float>(value);
    }
    float* const p = parameters.motor[motor % board::kMotors];
    const auto set = [p](const description::MotorSettings& settings) {
      for (const auto& [parameter, value] : settings) p[parameter] = static_cast<float>(value);
    };
    const int cable = cables[motor];
    set(common);
    set(description::SettingsOf(def.cables[static_cast<std::size_t>(cable)], boards.encoder_lines));
    const ImpedanceGains* const gains = description::GainsOf(controllers, cable);
    if (gains != nullptr) set(description::SettingsOf(*gains));
  }
}

void BoardLane::Start(std::span<const MotorInputs> inputs) {
  sequence_ = 0;
  faulty_motor_ = -1;
  first_faults_ = 0;
  for (std::size_t b = 0; b < boards_.size(); ++b) {
    board::Board& board = boards_[b] = board::Board{};
    board.parameters = parameters_[b];
    board::Boot boot;
    boot.board = static_cast<std::uint8_t>(b);
    board::Start(boot, board);
    board.was_reset = false;
    board.armed = board.heard = true;
    board.mode = board::Mode::kHold;
    for (std::uint8_t m = 0; m < board::kMotors; ++m) {
      board.referenced[m] = true;
      const std::size_t motor = b * board::kMotors + m;
      if (motor >= inputs.size()) continue;
      // The filter has settled before the start.
      board.loops[m].tension_counts = static_cast<float>(inputs[motor].code);
      board.watches[m].adc = static_cast<std::uint16_t>(inputs[motor].code);
      board::StartPosition(board.numbers[m], board.loops[m]);
    }
  }
  ReadStatus(0);
}

void BoardLane::Broadcast(board::Mode mode, bool capture, std::span<const double> values) {
  ++sequence_;
  for (std::size_t motor = 0; motor < readings_.size(); ++motor) {
    board::Board& board = boards_[motor / board::kMotors];
    const float* const p = board.parameters.motor[motor % board::kMotors];
    double units = 0;
    if (mode == board::Mode::kPosition) {
      units =
          (double{p[board::kReferenceLength]} - values[motor]) / double{p[board::kLengthPerCount]};
    } else if (mode == board::Mode::kImpedance) {
      units = values[motor] / double{board::kSpeedUnit_m_per_s};
    }
    board::Command& command = board.command;
    command.values[motor % board::kMotors] = board::ToWire(units);
    command.sequence = sequence_;
    command.mode = mode;
    command.capture = capture;
    command.arm = board::Arm::kGo;
    board.command_due = true;
    board.silence = 0;
  }
}

void BoardLane::Tick(std::span<const MotorInputs> inputs, double time_s) {
  for (std::size_t b = 0; b < boards_.size(); ++b) {
    board::Board& board = boards_[b];
    board::Inputs in{};
    in.elapsed = 1;
    for (std::uint8_t m = 0; m < board::kMotors; ++m) {
      const std::size_t motor = b * board::kMotors + m;
      // A connector without a motor: a reading within the range of the cell.
      in.adc[m] = static_cast<std::uint16_t>(motor < inputs.size() ? inputs[motor].code : 100);
      const std::int64_t counts = motor < inputs.size() ? inputs[motor].counts : 0;
      in.encoder[m] = static_cast<std::uint16_t>(counts);
    }
    board::Tick(in, board);
    board::Feel(board);
    board::DoSlowWork(board);
    for (std::uint8_t m = 0; m < board::kMotors && faulty_motor_ < 0; ++m) {
      const std::size_t motor = b * board::kMotors + m;
      if (board.faults[m] == 0 || motor >= readings_.size()) continue;
      faulty_motor_ = static_cast<int>(motor);
      first_faults_ = board.faults[m];
      faulty_s_ = time_s;
    }
  }
}

void BoardLane::ReadStatus(double since_s) {
  for (std::size_t motor = 0; motor < readings_.size(); ++motor) {
    board::Board& board = boards_[motor / board::kMotors];
    const auto m = static_cast<std::uint8_t>(motor % board::kMotors);
    const float* const p = board.parameters.motor[m];
    const board::MotorStatus status = board::StatusOf(board, m);
    MotorReadings& to = readings_[motor];
    const auto force_n = [p](std::uint16_t quarters) {
      return board::ForceOf(quarters, double{p[board::kNewtonsPerCount]},
                            double{p[board::kCountsAtZero]});
    };
    const double before_m = to.rest_length_m;
    to.rest_length_m = double{p[board::kReferenceLength]} -
                       board.loops[m].counts * double{p[board::kLengthPerCount]};
    to.rate_m_per_s = since_s > 0 ? (to.rest_length_m - before_m) / since_s : 0.0;
    to.tension_n = force_n(status.tension_quarters);
    to.set_point_n =
        board.mode == board::Mode::kImpedance ? force_n(status.set_point_quarters) : 0.0;
    to.length_m = control::LengthFromTension(to.rest_length_m, std::max(0.0, to.tension_n),
                                             double{p[board::kStiffness]});
    to.faults = board.faults[m];
  }
}

double BoardLane::Duty(int motor) const {
  const board::MotorLoop& loop = BoardOf(motor).loops[motor % board::kMotors];
  return static_cast<double>(loop.width) / board::kFullWidth;
}

std::string BoardLane::Faults(const std::vector<std::string>& names) const {
  if (faulty_motor_ < 0) return {};
  char time[32];
  std::snprintf(time, sizeof time, " at %.3f s", faulty_s_);
  return "the board of " + names[static_cast<std::size_t>(faulty_motor_)] +
         " reported a fault: " + base::BitNames(first_faults_, board::kMotorFaultNames) + time +
         "; then all motors held";
}

void BoardLane::Serialize(LaneState& state) {
  for (board::Board& board : boards_) plant::Serialize(state, board);
  for (MotorReadings& of : readings_) {
    state.Values(of.rest_length_m, of.length_m, of.rate_m_per_s, of.tension_n, of.set_point_n,
                 of.faults);
  }
  state.Values(sequence_, faulty_motor_, first_faults_, faulty_s_);
}

}  // namespace taut::plant
