/// Common parts of the commands of `taut robot`: arguments, connection, orderly end.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "taut/calibration.h"
#include "taut/link/driver.h"
#include "taut/link/power.h"
#include "taut/link/robot_plant.h"
#include "taut/link/stop_listener.h"
#include "taut/link/virtual_robot.h"
#include "taut/spec.h"

namespace taut::cli {

struct RobotArguments {
  std::string port = "/dev/ttyACM0";  ///< "virtual": an emulated robot.
  std::string model;                  ///< Empty: the Tetraspine3 with motors that comes with taut.
  std::string calibration;
  std::vector<std::string> set;  ///< Overrides of parameters of the model and the experiment.
  int encoder_lines = 16;
  std::string on_fault = "hold";
  bool clear_faults = false, dry_run = false, json = false, quiet = false;
};

/// Adds the flags common to all robot commands.
void AddPort(CLI::App& command, RobotArguments& args);
void AddModelFile(CLI::App& command, RobotArguments& args);
/// Adds the flags of the model file and its parameters.
void AddModel(CLI::App& command, RobotArguments& args);
void AddCalibration(CLI::App& command, RobotArguments& args);
/// Adds the flags of commands that power motors.
void AddDriving(CLI::App& command, RobotArguments& args);
void AddJson(CLI::App& command, RobotArguments& args);

/// Port of a robot, held exclusively during its lifetime.
struct RobotLine {
  /// Opens the port. If no virtual robot runs yet, `virtual_words` contain the experiment or model
  /// to start one with. Returns nothing, with an error in `out`, if no port is available.
  static std::optional<RobotLine> Open(const RobotArguments& args,
                                       std::vector<std::string> virtual_words, Diagnostics& out);

  std::unique_ptr<link::VirtualRobot> virtual_robot;  ///< Null for a real robot.
  std::string device;
  std::unique_ptr<link::Port> port;
  std::unique_ptr<link::StopListener> stops;
};

/// A robot under exclusive control of this command. Ctrl-C and `taut robot estop` stop its motors
/// in any state of the command.
class RobotConsole {
 public:
  /// Reads model and calibration, opens the port, queries the boards and sends them their settings.
  /// `experiment`: replaces the model. Returns null after messages on stderr; then `exit` is the
  /// status. If this command starts a virtual robot, the robot is ready at once: settings from its
  /// model, references set, no faults.
  static std::unique_ptr<RobotConsole> Open(const RobotArguments& args,
                                            const ExperimentSpec* experiment, int& exit);
  ~RobotConsole();

  link::Driver& driver() { return *driver_; }
  const RobotSpec& robot() const { return robot_; }
  const std::vector<std::string>& cables() const { return cables_; }
  std::optional<int> MotorOf(const std::string& cable) const;
  /// Returns the motor of a cable; nothing, with an error in `out`, if no motor has this cable.
  std::optional<int> MotorOf(const std::string& cable, Diagnostics& out) const;
  const link::VirtualRobot* virtual_robot() const { return line_->virtual_robot.get(); }
  /// Returns whether an interrupt or a stop request has arrived. The driver then stops the motors,
  /// except after an interrupt of a command that only reads.
  bool stop_asked() const { return stop_asked_; }
  /// Polls for an interrupt or a stop request. Call it where cycles may be absent, as without
  /// an adapter.
  bool LookForStop();
  /// Exit status after a stop: kInterrupted, or kFailed if another program requested it.
  Exit stop_exit() const;
  /// Cycles until `go_on` returns false, an interrupt or a stop request arrives. Checks all three
  /// after each cycle and at 20 Hz, also while the adapter is disconnected or silent.
  void RunWhile(const std::function<bool()>& go_on);
  bool ClearFaults(Diagnostics& out);
  /// Turns powered motors off, waits for the boards' confirmation, answers pending stop requests,
  /// and prints an error for each board without confirmation. Later calls have no effect. Returns
  /// true if every board confirmed or no motor had power.
  bool End();
  /// Calls End and, if all boards confirmed, prints "Motors are off." as the last line of stdout.
  bool EndAndReport(bool quiet);

  /// `on_cycle` is called after each cycle; `on_event` at each event, which `taut robot` also
  /// prints.
  std::function<void(const link::State&)> on_cycle;
  std::function<void(double time_s, const std::string& text)> on_event;

 private:
  RobotConsole() = default;
  bool Read(const RobotArguments& args, const ExperimentSpec* experiment, Diagnostics& found);
  bool Connect(const RobotArguments& args, const ExperimentSpec* experiment, Diagnostics& found);
  bool SetUp(const RobotArguments& args, const ExperimentSpec* experiment, Diagnostics& found);
  void AfterCycle(const link::State& state);
  void Finish();

  RobotSpec robot_;
  std::vector<std::string> cables_;
  std::optional<Calibration> calibration_;
  std::optional<RobotLine> line_;
  std::unique_ptr<link::Driver> driver_;
  bool stop_asked_ = false, quiet_ = false;
  bool confirm_ = false;  ///< Wait for the boards' confirmation even if no motor had power.
  bool ended_ = false, ended_well_ = true;
  std::optional<link::PowerReport> power_;
};

/// Returns the device of `--port` for commands that only stop the robot, even while another program
/// drives it. Empty, with an error in `out`, if there is none.
std::string DeviceOf(const RobotArguments& args, Diagnostics& out);

/// Returns the path of the model of `--model`.
std::string ModelPath(const RobotArguments& args);

// Each function adds one command to `taut robot`.
void AddRobotScan(CLI::App& robot, int& exit_code);
void AddRobotStatus(CLI::App& robot, int& exit_code);
void AddRobotRun(CLI::App& robot, int& exit_code);
void AddRobotLog(CLI::App& robot, int& exit_code);
void AddRobotCalibrate(CLI::App& robot, int& exit_code);
void AddRobotReference(CLI::App& robot, int& exit_code);
void AddRobotHold(CLI::App& robot, int& exit_code);
void AddRobotRelease(CLI::App& robot, int& exit_code);
void AddRobotSet(CLI::App& robot, int& exit_code);
void AddRobotFlash(CLI::App& robot, int& exit_code);
void AddRobotSelftest(CLI::App& robot, int& exit_code);
void AddRobotEstop(CLI::App& robot, int& exit_code);

}  // namespace taut::cli
