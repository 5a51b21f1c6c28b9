// Command `taut robot`: its subcommands.
#include "robot_console.h"

namespace taut::cli {

void AddRobot(CLI::App& app, int& exit_code) {
  CLI::App* robot =
      app.add_subcommand("robot", "Drive a real or emulated robot over its motor boards.");
  robot->require_subcommand(1);
  AddRobotScan(*robot, exit_code);
  AddRobotStatus(*robot, exit_code);
  AddRobotRun(*robot, exit_code);
  AddRobotLog(*robot, exit_code);
  AddRobotCalibrate(*robot, exit_code);
  AddRobotReference(*robot, exit_code);
  AddRobotHold(*robot, exit_code);
  AddRobotRelease(*robot, exit_code);
  AddRobotSet(*robot, exit_code);
  AddRobotFlash(*robot, exit_code);
  AddRobotSelftest(*robot, exit_code);
  AddRobotEstop(*robot, exit_code);
  robot->footer(
      "Examples:\n"
      "  taut robot scan --port /dev/ttyACM0\n"
      "  taut robot run experiments/push_20n_motors.yaml --port virtual\n"
      "  taut robot estop\n"
      "One program at a time drives a robot; `taut robot estop` stops it from any terminal.\n"
      "Ctrl-C turns motors off before a command ends (exit status 130).");
}

}  // namespace taut::cli
