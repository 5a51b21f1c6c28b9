#include "taut/link/robot_plant.h"

#include <algorithm>
#include <utility>

#include "base/assert.h"
#include "plant/fault_bits.h"

namespace taut::link {
namespace {

using board::Mode;

/// Rows of the matrix `rows_`.
enum Row { kRestLength, kLength, kRate, kTension, kElastic, kStiffness, kCommanded, kRows };

}  // namespace

RobotPlant::RobotPlant(const ExperimentSpec& experiment, Driver& driver)
    : experiment_(experiment), driver_(driver) {
  Diagnostics none;
  cables_ = MotorCables(experiment.robot, none);
  TAUT_ASSERT(cables_.size() == driver.state().motors.size());
  if (const BoardsSpec* const boards = BoardsOf(experiment.controllers)) boards_ = *boards;
  const std::vector<CableDef>& cables = experiment.robot.def.cables;
  const std::size_t count = cables.size();
  rows_.resize(kRows * count);
  set_point_n_.resize(count);
  velocity_input_m_per_s_.resize(count);
  signal_.resize(count);
  command_mode_.resize(count);
  faults_.assign(count, kFaultNoReading);
  const auto row = [&](Row which) { return rows_.data() + which * count; };
  for (std::size_t c = 0; c < count; ++c) {
    row(kRestLength)[c] = row(kLength)[c] = cables[c].rest_length_m;
    row(kStiffness)[c] = cables[c].stiffness_n_per_m;
  }
  commands_ = {1,
               row(kCommanded),
               set_point_n_.data(),
               velocity_input_m_per_s_.data(),
               signal_.data(),
               command_mode_.data(),
               &gait_};
  seen_.time_s = &time_s_;
  seen_.cables = {row(kRestLength), row(kLength),  row(kRate),
                  row(kTension),    row(kElastic), row(kStiffness)};
  seen_.faults = faults_.data();
  Restart(0);
}

bool RobotPlant::Hold(Diagnostics& out) {
  const auto mode = ModeFor(experiment_, out);
  if (!mode || !driver_.Enable(Mode::kHold, false, out)) return false;
  mode_ = *mode;
  return true;
}

void RobotPlant::Begin() {
  // In position control, the first set point of a motor is its current position.
  for (std::size_t m = 0; m < cables_.size(); ++m) {
    const double here_m = driver_.state().motors[m].rest_length_m;
    driver_.SetValue(static_cast<int>(m), mode_ == Mode::kPosition ? here_m : 0.0);
  }
  holding_ = boards_.hold_s > 0;
  if (!holding_) driver_.Go(mode_, boards_.capture);
  driver_.ForgetStatistics();
  cycle_ = -1;
  time_s_ = 0;
  started_s_ = driver_.port().now_s();
  Read();
}

void RobotPlant::Restart(int /*lane*/) {
  time_s_ = 0;
  gait_ = -1;
  const std::vector<CableDef>& cables = experiment_.robot.def.cables;
  for (std::size_t c = 0; c < cables.size(); ++c) {
    rows_[kCommanded * cables.size() + c] = cables[c].rest_length_m;
    set_point_n_[c] = velocity_input_m_per_s_[c] = signal_[c] = 0;
    command_mode_[c] = CommandMode::kRestLength;
  }
}

bool RobotPlant::IsRunning(int /*lane*/) const {
  return driver_.state().stage == Stage::kActive && !driver_.state().stopping;
}

void RobotPlant::Read() {
  const State& state = driver_.state();
  if (!state.link.connected) std::fill(faults_.begin(), faults_.end(), kFaultNoReading);
  if (state.link.cycles == cycle_) return;
  const double since_s = cycle_ < 0 ? 0 : state.time_s - read_s_;
  cycle_ = state.link.cycles;
  read_s_ = state.time_s;
  const std::size_t count = faults_.size();
  const auto at = [&](Row which, int cable) -> double& {
    return rows_[which * count + static_cast<std::size_t>(cable)];
  };
  for (std::size_t m = 0; m < cables_.size(); ++m) {
    const int c = cables_[m];
    const MotorView& motor = state.motors[m];
    const BoardView& board = state.boards[m / board::kMotors];
    // Rate of the spool, as in the boards' control law. The load cell is too coarse to measure the
    // rate of the spring.
    at(kRate, c) = since_s > 0 ? (motor.rest_length_m - at(kRestLength, c)) / since_s : 0.0;
    at(kRestLength, c) = motor.rest_length_m;
    at(kLength, c) = motor.length_m;
    at(kTension, c) = motor.tension_n;
    at(kElastic, c) = std::max(0.0, motor.tension_n);
    if (motor.set_point_n == motor.set_point_n) {
      set_point_n_[static_cast<std::size_t>(c)] = motor.set_point_n;
    }
    std::uint32_t& faults = faults_[static_cast<std::size_t>(c)];
    faults = board.there ? kFaultNone : kFaultNoReading;
    faults |= plant::FaultBitsOf(motor.faults);
    if (board.faults != 0) faults |= kFaultActuator;
  }
}

const Observation& RobotPlant::Observe() {
  Read();
  return seen_;
}

void RobotPlant::Advance(const double* /*step_s*/, const double* to_s) {
  if (before_first_step) {
    std::exchange(before_first_step, {})();
    if (driver_.state().stage != Stage::kActive) return;  // start failed: keep the time
  }
  const std::size_t count = faults_.size();
  for (std::size_t m = 0; m < cables_.size(); ++m) {
    const auto c = static_cast<std::size_t>(cables_[m]);
    driver_.SetValue(static_cast<int>(m),
                     mode_ == Mode::kPosition
                         ? rows_[kCommanded * count + c]
                         : boards_.velocity_input_scale * velocity_input_m_per_s_[c]);
  }
  if (holding_ && to_s[0] > boards_.hold_s) {
    holding_ = false;
    driver_.Go(mode_, boards_.capture);
  }
  driver_.RunUntil(started_s_ + to_s[0]);
  time_s_ = to_s[0];
}

}  // namespace taut::link
