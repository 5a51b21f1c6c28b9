/// A robot whose cables emulated boards control, as a plant (taut/plant.h): the driver and its
/// plant, in the robot's own time, on a robot whose true state is known.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "apps/virtual_robot/motor_plant.h"
#include "apps/virtual_robot/robot.h"
#include "apps/virtual_robot/robot_port.h"
#include "taut/calibration.h"
#include "taut/link/robot_plant.h"

namespace taut::virtual_robot {

struct BoardsOptions {
  RobotOptions robot;
  std::optional<Calibration> calibration;      ///< What the PC believes of cells, encoders and
                                               ///< springs, in place of what is so.
  std::vector<link::ParameterValue> settings;  ///< Of all boards and motors, after all of that.
  double recover_s = std::numeric_limits<double>::infinity();  ///< By the experiment's clock: when
                                                               ///< `Recover` is called.
};

/// One lane. The robot is held on a stand until `Prepare` is through: boards began, parameters set,
/// references set, armed, holding.
class BoardsPlant final : public taut::Plant {
 public:
  /// The experiment's impedance controller says what the boards are told. Both outlive it.
  BoardsPlant(const ExperimentSpec& experiment, MotorPlant& motors, const BoardsOptions& options);

  /// False and complaints if a board does not answer or refuses.
  bool Prepare(Diagnostics& out);

  /// After a fault, as an operator would have it: configures all anew, sets references to what the
  /// cables really are, clears faults, arms and goes on. False and complaints if a board does not
  /// play along. The experiment's clock stands still meanwhile.
  bool Recover(Diagnostics& out);

  /// The truth, not what boards sense.
  const Observation& Observe() override;
  Commands& commands() override { return plant_.commands(); }
  void Advance(const double* step_s, const double* to_s) override;
  void Restart(int lane) override { plant_.Restart(lane); }
  bool Goes(int lane) const override { return truth_->Goes(lane); }
  World* world() noexcept override { return truth_->world(); }

  link::Driver& driver() { return driver_; }
  const link::State& heard() const { return driver_.state(); }
  /// By the driver's clock, where the experiment's time is 0.
  double started_s() const { return plant_.started_s(); }
  /// Ticks of all boards that came late since the experiment began; asks them.
  int LateTicks();
  /// Frames that came with a wrong checksum, or not at all, since then.
  std::int64_t bad_frames() const { return link::BadFrames(heard()); }
  Robot& robot() { return robot_; }
  /// The largest tension of any cable with a motor, at any step of the plant so far.
  double most_n() const { return most_n_; }
  /// Whether it was asked to recover, and did.
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
  int late_before_ = 0;  ///< Ticks, while the boards were set up.
  double most_n_ = 0;
  bool asked_to_recover_ = false, recovered_ = false;
  Diagnostics recovery_;
};

}  // namespace taut::virtual_robot
