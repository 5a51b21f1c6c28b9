/// Plant (taut/plant.h) whose cables are controlled by emulated boards: the link's driver and
/// plant, in the robot's virtual time, on a robot whose true state is known.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "apps/virtual_robot/emulated_robot.h"
#include "apps/virtual_robot/motor_plant.h"
#include "apps/virtual_robot/robot_port.h"
#include "taut/calibration.h"
#include "taut/link/robot_plant.h"

namespace taut::virtual_robot {

struct BoardsOptions {
  RobotOptions robot;
  std::optional<Calibration> calibration;  ///< The PC's assumptions about load cells, encoders and
                                           ///< springs; empty: the true values.
  std::vector<link::ParameterValue> settings;  ///< Settings of all boards and motors, applied last.
  double recover_s =
      std::numeric_limits<double>::infinity();  ///< Experiment time at which `Recover` is called.
};

/// Plant with one lane. A stand holds the robot until `Prepare` is complete: boards booted,
/// parameters and references set, armed, holding.
class BoardsPlant final : public taut::Plant {
 public:
  /// The experiment's impedance controller determines the commands to the boards. `experiment` and
  /// `motors` must outlive the plant.
  BoardsPlant(const ExperimentSpec& experiment, MotorPlant& motors, const BoardsOptions& options);

  /// Returns false, with errors in `out`, if a board does not answer or refuses.
  bool Prepare(Diagnostics& out);

  /// Recovers after a fault, as an operator would: configures everything again, sets references to
  /// the true lengths of the cables, clears faults, arms and continues. Returns false, with errors
  /// in `out`, if a board does not answer, or
  /// refuses a setting, a reference or a mode. The experiment's time does not advance meanwhile.
  bool Recover(Diagnostics& out);

  /// Returns the true state, not the boards' measurements.
  const Observation& Observe() override;
  Commands& commands() override { return plant_.commands(); }
  void Advance(const double* step_s, const double* to_s) override;
  void Restart(int lane) override { plant_.Restart(lane); }
  bool IsRunning(int lane) const override { return truth_->IsRunning(lane); }
  World* world() noexcept override { return truth_->world(); }

  link::Driver& driver() { return driver_; }
  const link::State& heard() const { return driver_.state(); }
  /// Returns the driver's time at which the experiment's time is 0.
  double started_s() const { return plant_.started_s(); }
  /// Returns the number of late ticks of all boards since the experiment began; queries the boards.
  int LateTicks();
  /// Returns the number of frames since the experiment began that were missing or had a wrong
  /// checksum.
  std::int64_t bad_frames() const { return link::BadFrames(heard()); }
  Robot& robot() { return robot_; }
  /// Returns the largest tension of any cable with a motor, over all steps of the plant.
  double most_n() const { return most_n_; }
  /// Returns whether a requested recovery was made.
  bool recovered() const { return recovered_; }
  const Diagnostics& recovery() const { return recovery_; }

 private:
  std::vector<link::Setting> Settings() const;
  bool SetUp(Diagnostics& out);
  int CountLateTicks();

  const ExperimentSpec& experiment_;
  MotorPlant& motors_;
  BoardsOptions options_;
  std::unique_ptr<taut::Plant> truth_;
  Robot robot_;
  RobotPort port_;
  link::Driver driver_;
  link::RobotPlant plant_;
  Observation seen_;
  double time_s_ = 0;
  int late_before_ = 0;  ///< Late ticks during the setup of the boards.
  double most_n_ = 0;
  bool asked_to_recover_ = false, recovered_ = false;
  Diagnostics recovery_;
};

}  // namespace taut::virtual_robot
