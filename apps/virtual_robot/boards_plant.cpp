#include "apps/virtual_robot/boards_plant.h"

#include <algorithm>

namespace taut::virtual_robot {
namespace {

link::DriverOptions DriverOptionsFor(const MotorPlant& motors) {
  link::DriverOptions options;
  options.motors = motors.motor_count();
  options.cables = motors.cable_names();
  return options;
}

}  // namespace

BoardsPlant::BoardsPlant(const ExperimentSpec& experiment, MotorPlant& motors,
                         const BoardsOptions& options)
    : experiment_(experiment),
      motors_(motors),
      options_(options),
      truth_(PlantOf(motors.batch())),
      robot_(motors, options.robot),
      port_(robot_),
      driver_(port_, DriverOptionsFor(motors)),
      plant_(experiment, driver_) {
  robot_.after_plant_step = [this](Time) {
    for (int m = 0; m < motors_.motor_count(); ++m) {
      most_n_ = std::max(most_n_, motors_.LoadCellForce(m));
    }
  };
}

std::vector<link::Setting> BoardsPlant::Settings() const {
  std::vector<link::Setting> all =
      link::SettingsFor(experiment_.robot, options_.robot.encoder.lines);
  const auto add = [&](const std::vector<link::Setting>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  add(link::GainsFor(experiment_));
  const BoardLoadCell& cell = options_.robot.load_cell;
  const auto add_for_all = [&](const link::ParameterValue& value) {
    add(ForAll(value, motors_.motor_count()));
  };
  add_for_all({true, board::kNewtonsPerCount, static_cast<float>(cell.n_per_count)});
  add_for_all({true, board::kCountsAtZero, static_cast<float>(cell.counts_at_zero)});
  if (options_.calibration) add(link::SettingsFor(*options_.calibration, experiment_.robot));
  for (const link::ParameterValue& value : options_.settings) add_for_all(value);
  return all;
}

bool BoardsPlant::SetUp(Diagnostics& out) {
  if (!driver_.Configure(Settings(), out, link::Driver::Meanwhile::kHold)) return false;
  for (int motor = 0; motor < motors_.motor_count(); ++motor) {
    const auto cable = static_cast<std::size_t>(motors_.cable(motor));
    if (!driver_.SetReference(motor, truth_->Observe().cables.rest_length_m[cable], out)) {
      return false;
    }
  }
  driver_.Off();  // a board that has restarted is not armed and would report an error at a hold
                  // command
  driver_.ClearFaults();
  driver_.Cycle(1);
  return true;
}

bool BoardsPlant::Recover(Diagnostics& out) {
  // A board with a timeout or a fault accepts no mode until these are cleared.
  if (driver_.Go(board::Mode::kHold)) {
    driver_.ClearFaults();
    driver_.Cycle(3);
  }
  if (!SetUp(out) || !plant_.Hold(out)) return false;
  const auto mode = link::ModeFor(experiment_, out);
  return mode && driver_.Go(*mode);
}

bool BoardsPlant::Prepare(Diagnostics& out) {
  motors_.SetHeld(true);
  robot_.AdvanceTo(100 * kMillisecond);  // time for the boards to boot
  if (!SetUp(out)) return false;
  late_before_ = CountLateTicks();
  if (!plant_.Hold(out)) return false;
  motors_.SetHeld(false);
  plant_.Begin();
  return true;
}

int BoardsPlant::CountLateTicks() {
  int late = 0;
  for (int b = 0; b < robot_.board_count(); ++b) {
    Diagnostics silent;
    if (const auto counters = driver_.requests().Counters(b, silent)) late += counters->late_ticks;
  }
  return late;
}

int BoardsPlant::LateTicks() {
  driver_.Cycle(1);  // no cycle is in progress
  return CountLateTicks() - late_before_;
}

void BoardsPlant::Advance(const double* step_s, const double* to_s) {
  if (to_s[0] >= options_.recover_s && !asked_to_recover_) {
    asked_to_recover_ = true;
    recovered_ = Recover(recovery_);
  }
  plant_.Advance(step_s, to_s);
  time_s_ = to_s[0];
}

const Observation& BoardsPlant::Observe() {
  seen_ = truth_->Observe();
  seen_.time_s = &time_s_;
  return seen_;
}

}  // namespace taut::virtual_robot
