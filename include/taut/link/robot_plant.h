/// Robot as a plant (taut/plant.h): the boards provide the observations of an experiment's
/// controllers and receive their commands. Impedance control runs on the boards: gains become board
/// parameters, and the signal of a gait becomes V0 in broadcasts. Rest lengths become motor
/// positions.
///
/// Motor m of board b winds the actuated cable number 2 b + m, in model order, starting at 0.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "taut/calibration.h"
#include "taut/link/driver.h"
#include "taut/plant.h"

namespace taut::link {

/// Returns the indices of the actuated cables. Returns an empty list and adds errors if there are
/// none or more than the boards have motors.
std::vector<int> MotorCables(const RobotSpec& robot, Diagnostics& out);
/// Returns the names of the actuated cables.
std::vector<std::string> MotorNames(const RobotSpec& robot);

/// Returns the board mode for an experiment: impedance control if the experiment uses it for
/// cables, otherwise position control. If only some motors use impedance control, returns nothing
/// and adds an error.
std::optional<board::Mode> ModeFor(const ExperimentSpec& experiment, Diagnostics& out);

/// Returns the board parameters that depend on gear, spool and spring. `encoder_lines`: marks per
/// revolution of the motor shaft; boards count two edges per mark.
std::vector<Setting> SettingsFor(const RobotSpec& robot, int encoder_lines);
/// Returns the board parameters for the impedance gains of the experiment, and those of its
/// `boards` except the load cells.
std::vector<Setting> GainsFor(const ExperimentSpec& experiment);
/// Returns the calibrated board parameters. The cables of the calibration must belong to this
/// robot.
std::vector<Setting> SettingsFor(const Calibration& calibration, const RobotSpec& robot);

/// Plant with one lane. Threads: use it from the thread that uses the driver.
class RobotPlant final : public Plant {
 public:
  /// Experiment and driver must outlive the plant. The motors of the driver must be those of the
  /// robot.
  RobotPlant(const ExperimentSpec& experiment, Driver& driver);

  /// Gives motors power and holds their positions. Returns false and adds an error if a board does
  /// not follow or the boards cannot run the experiment.
  bool Hold(Diagnostics& out);
  /// Starts the experiment after `Hold`: its time is 0 now, and the boards enter its mode
  /// (`ModeFor`) with the next broadcast, or after `BoardsSpec::hold_s`.
  void Begin();

  const Observation& Observe() override;
  Commands& commands() override { return commands_; }
  void Advance(const double* step_s, const double* to_s) override;
  void Restart(int lane) override;
  /// Returns false after the motors were stopped or turned off.
  bool IsRunning(int lane) const override;

  /// Called once, in the first `Advance`. Call `Hold` and `Begin` in it, because boards time out
  /// while an experiment is prepared.
  std::function<void()> before_first_step;

  Driver& driver() { return driver_; }
  double started_s() const { return started_s_; }  ///< Start time on the clock of the port.

 private:
  void Read();

  const ExperimentSpec& experiment_;
  Driver& driver_;
  std::vector<int> cables_;  ///< Cable indices of the motors.
  board::Mode mode_ = board::Mode::kHold;
  BoardsSpec boards_;         ///< Boards of the experiment, or the defaults.
  bool holding_ = false;      ///< Whether motors hold, until `BoardsSpec::hold_s`.
  std::vector<double> rows_;  ///< Rows of six readings and of the commanded rest lengths.
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
