/// A robot as a plant (taut/plant.h): an experiment's controllers see what boards sense and command
/// what boards do. Impedance control runs on the boards: its gains become their parameters, a
/// gait's part V0 of broadcasts; rest lengths become positions.
///
/// Motor m of board b is actuated cable 2 b + m, in the model's order.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "taut/calibration.h"
#include "taut/link/driver.h"
#include "taut/plant.h"

namespace taut::link {

/// The actuated cables of a robot. Nothing and complaints if there is none, or more than boards can
/// drive.
std::vector<int> MotorCables(const RobotSpec& robot, Diagnostics& out);
/// Their names.
std::vector<std::string> MotorNames(const RobotSpec& robot);

/// How the boards run an experiment: by impedance control if it controls cables so, else by
/// position. Nothing and a complaint if it does both, or leaves out a motor.
std::optional<board::Mode> ModeFor(const ExperimentSpec& experiment, Diagnostics& out);

/// What follows for the boards from gear, spool, spring and gains. `encoder_lines`: marks a turn of
/// the motor's shaft, of which boards count two states each.
std::vector<Setting> SettingsFor(const RobotSpec& robot, int encoder_lines);
std::vector<Setting> GainsFor(const ExperimentSpec& experiment);
/// What was measured. Its cables are of this robot.
std::vector<Setting> SettingsFor(const Calibration& calibration, const RobotSpec& robot);

/// One lane. Threads: belongs to the one that has the driver.
class RobotPlant final : public Plant {
 public:
  /// The driver's motors are those of the experiment's robot. Both outlive it.
  RobotPlant(const ExperimentSpec& experiment, Driver& driver);

  /// Motors get power and hold where they are. False and a complaint if a board does not obey, or
  /// boards cannot run the experiment.
  bool Hold(Diagnostics& out);
  /// After `Hold`: the experiment's mode from the next broadcast on; its time 0 is now.
  void Begin();

  const Observation& Observe() override;
  Commands& commands() override { return commands_; }
  void Advance(const double* step_s, const double* to_s) override;
  void Restart(int lane) override;
  /// False once motors have been stopped or turned off.
  bool Goes(int lane) const override;

  /// Called in the first `Advance`, once: for who gives power then, with `Hold` and `Begin`, since
  /// boards do not wait while an experiment is made ready.
  std::function<void()> before_first_step;

  Driver& driver() { return driver_; }
  double started_s() const { return started_s_; }  ///< By the port's clock.

 private:
  void Read();

  const ExperimentSpec& experiment_;
  Driver& driver_;
  std::vector<int> cables_;  ///< Of the motors.
  board::Mode mode_ = board::Mode::kHold;
  std::vector<double> rows_;  ///< Six readings, and the rest lengths that are commanded.
  std::vector<double> set_point_n_, velocity_input_m_per_s_, signal_;
  std::vector<CommandMode> command_mode_;
  std::vector<std::uint32_t> faults_;
  int gait_ = -1;
  Commands commands_;
  Observation seen_;
  double time_s_ = 0, started_s_ = 0, read_s_ = -1;
  std::int64_t cycle_ = -1;
};

}  // namespace taut::link
