/// `taut robot`: what its commands have in common.
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
  std::string port = "/dev/ttyACM0";  ///< "virtual": an emulated one.
  std::string model;                  ///< Empty: Tetraspine3 with motors, as it comes with taut.
  std::string calibration;
  std::vector<std::string> set;  ///< Parameters of model and experiment.
  int encoder_lines = 16;
  std::string on_fault = "hold";
  bool clear_faults = false, dry_run = false, json = false, quiet = false;
};

/// Flags of the robot commands.
void AddPort(CLI::App& command, RobotArguments& args);
void AddModelFile(CLI::App& command, RobotArguments& args);
/// The model file and its parameters.
void AddModel(CLI::App& command, RobotArguments& args);
void AddCalibration(CLI::App& command, RobotArguments& args);
/// Flags of commands that give motors power.
void AddDriving(CLI::App& command, RobotArguments& args);
void AddJson(CLI::App& command, RobotArguments& args);

/// A robot's port, which is this command's alone while it lives.
struct RobotLine {
  /// Where no virtual robot runs yet, `virtual_words` say with which experiment or model to start
  /// one. Nothing and a complaint if there is no port to be had.
  static std::optional<RobotLine> Open(const RobotArguments& args,
                                       std::vector<std::string> virtual_words, Diagnostics& out);

  std::unique_ptr<link::VirtualRobot> virtual_robot;  ///< Null: a real one.
  std::string device;
  std::unique_ptr<link::Port> port;
  std::unique_ptr<link::StopListener> stops;
};

/// A robot that this command alone drives. Ctrl-C and `taut robot estop` stop its motors, whatever
/// the command is about.
class RobotDesk {
 public:
  /// Reads model and calibration, opens the port, asks the boards and sets `settings` on them.
  /// `experiment`: instead of the model. Null, after messages on stderr: `exit` says how to end. A
  /// virtual robot that was started for it begins well: set as its model says, references set, no
  /// faults.
  static std::unique_ptr<RobotDesk> Open(const RobotArguments& args,
                                         const ExperimentSpec* experiment, int& exit);
  ~RobotDesk();

  link::Driver& driver() { return *driver_; }
  const RobotSpec& robot() const { return robot_; }
  const std::vector<std::string>& cables() const { return cables_; }
  std::optional<int> MotorOf(const std::string& cable) const;
  /// The same; a complaint if no motor has that cable.
  std::optional<int> MotorOf(const std::string& cable, Diagnostics& out) const;
  const link::VirtualRobot* virtual_robot() const { return line_->virtual_robot.get(); }
  /// Whether an interrupt or a stop request has arrived; the motors stop.
  bool stop_asked() const { return stop_asked_; }
  /// Polls for an interrupt or a stop request: for loops that may run without cycles.
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

  /// After each cycle, and what happens; also where `taut robot` prints it.
  std::function<void(const link::State&)> on_cycle;
  std::function<void(double time_s, const std::string& text)> on_event;

 private:
  RobotDesk() = default;
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

/// The device behind `--port`, where somebody may drive it already: for those who only stop it.
/// Empty and a complaint if there is none.
std::string DeviceOf(const RobotArguments& args, Diagnostics& out);

/// The model that `--model` means.
std::string ModelPath(const RobotArguments& args);

// Each adds one command to `taut robot`.
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
