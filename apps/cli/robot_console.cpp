// Connection of the `taut robot` commands to a robot: model, calibration, port, orderly end.
#include "robot_console.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "interrupt.h"
#include "interruptible_port.h"
#include "output.h"
#include "overrides.h"
#include "shipped_inputs.h"

namespace taut::cli {
namespace {

constexpr char kVirtual[] = "virtual";
/// Time for boards to boot after power-up.
constexpr double kBoot_s = 0.2;
/// Polling interval for interrupts and stop requests while no cycle ends.
constexpr double kLook_s = 0.05;
/// Timeouts for all boards to confirm that their motors are off: of a real robot, and of an
/// emulated one on a busy machine.
constexpr double kConfirm_s = 0.4, kConfirmVirtual_s = 3.0;

const std::map<std::string, link::OnFault> kOnFault{
    {"hold", link::OnFault::kHold}, {"off", link::OnFault::kOff}, {"stop", link::OnFault::kStop}};

}  // namespace

void AddPort(CLI::App& command, RobotArguments& args) {
  command
      .add_option(
          "--port", args.port,
          "Serial port of the adapter, or `virtual`: an emulated robot (default: /dev/ttyACM0)")
      ->option_text("PORT")
      ->envname("TAUT_ROBOT_PORT");
}

void AddModelFile(CLI::App& command, RobotArguments& args) {
  AddInput(
      command, "--model", {"model"}, args.model,
      "Model of the robot, for the names of its cables (default: tetraspine3_motors.yaml of taut)")
      ->option_text("FILE");
}

void AddModel(CLI::App& command, RobotArguments& args) {
  AddModelFile(command, args);
  command.add_option("--set", args.set, "Set a parameter of the model")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
}

void AddCalibration(CLI::App& command, RobotArguments& args) {
  AddInput(command, "--calibration", {"calibration"}, args.calibration,
           "Calibration file to set on the boards")
      ->option_text("FILE");
}

void AddDriving(CLI::App& command, RobotArguments& args) {
  AddCalibration(command, args);
  command.add_option("--encoder_lines", args.encoder_lines, "Encoder lines per turn (default: 16)")
      ->option_text("N")
      ->check(WholeNumberWithin(1, 10'000));
  command
      .add_option("--on_fault", args.on_fault,
                  "Reaction of all motors to a fault of a motor or board (default: hold)")
      ->option_text("hold|off|stop")
      ->check(OneOf({"hold", "off", "stop"}));
  command.add_flag("--clear_faults,--clear-faults", args.clear_faults,
                   "Clear latched faults, time-outs and emergency stops first");
  command.add_flag("--dry_run,--dry-run", args.dry_run, "Print the planned actions only");
}

void AddJson(CLI::App& command, RobotArguments& args) {
  command.add_flag("--json", args.json, "JSON instead of text");
}

std::string ModelPath(const RobotArguments& args) {
  if (!args.model.empty()) return args.model;
  const auto folder = ShippedFolderOf("models");
  return folder.value_or("models") + "/tetraspine3_motors.yaml";
}

std::string DeviceOf(const RobotArguments& args, Diagnostics& out) {
  if (args.port != kVirtual) return args.port;
  const auto found = link::VirtualRobot::Find(out);
  if (found) return found->device();
  if (out.ok())
    out.Error("robot.no_virtual_robot", {}, "no virtual robot is running",
              "start one with `taut robot hold --port virtual`");
  return {};
}

bool RobotConsole::Read(const RobotArguments& args, const ExperimentSpec* experiment,
                        Diagnostics& found) {
  if (experiment != nullptr) {
    robot_ = experiment->robot;
  } else {
    const auto overrides = ParseOverrides(args.set);
    if (!overrides) return false;
    auto robot = LoadRobot(ModelPath(args), *overrides, found);
    if (!robot) return false;
    robot_ = std::move(*robot);
  }
  if (link::MotorCables(robot_, found).empty()) return false;
  cables_ = link::MotorNames(robot_);
  if (args.calibration.empty()) return true;
  calibration_ = LoadCalibration(args.calibration, cables_, found);
  return calibration_.has_value();
}

std::optional<RobotLine> RobotLine::Open(const RobotArguments& args,
                                         std::vector<std::string> virtual_words, Diagnostics& out) {
  RobotLine line;
  line.device = args.port;
  if (args.port == kVirtual) {
    line.virtual_robot = link::VirtualRobot::Find(out);
    if (!line.virtual_robot && out.ok()) {
      line.virtual_robot =
          link::VirtualRobot::Start(WithOverrides(std::move(virtual_words), args.set), out);
    }
    if (!line.virtual_robot) return std::nullopt;
    line.device = line.virtual_robot->device();
  }
  auto port = link::OpenSerialPort(line.device, link::PortUse::kDrive, out);
  if (port) line.stops = link::StopListener::Open(line.device, out);
  if (!line.stops) return std::nullopt;
  line.port = std::make_unique<InterruptiblePort>(std::move(port));
  return line;
}

bool RobotConsole::Connect(const RobotArguments& args, const ExperimentSpec* experiment,
                           Diagnostics& found) {
  line_ = experiment != nullptr
              ? RobotLine::Open(args, {"--experiment", experiment->files.front()}, found)
              : RobotLine::Open(args, {"--model", ModelPath(args)}, found);
  return line_.has_value();
}

bool RobotConsole::SetUp(const RobotArguments& args, const ExperimentSpec* experiment,
                         Diagnostics& found) {
  link::DriverOptions options;
  options.motors = static_cast<int>(cables_.size());
  options.cables = cables_;
  options.on_fault = kOnFault.at(args.on_fault);
  // A virtual robot runs on the same machine: a reply may be late, but is never lost.
  if (virtual_robot() != nullptr) options.patience_s = 0.5;
  driver_ = std::make_unique<link::Driver>(*line_->port, options);
  driver_->on_cycle = [this](const link::State& state) { AfterCycle(state); };
  driver_->on_event = [this](double time_s, const std::string& text) {
    if (!quiet_) fmt::print(stderr, "{}\n", text);
    if (on_event) on_event(time_s, text);
  };
  const bool ours = virtual_robot() != nullptr && virtual_robot()->is_ours();
  std::vector<link::Setting> settings;
  const auto add = [&](const std::vector<link::Setting>& more) {
    settings.insert(settings.end(), more.begin(), more.end());
  };
  if (experiment != nullptr || ours) add(link::SettingsFor(robot_, args.encoder_lines));
  if (experiment != nullptr) add(link::GainsFor(*experiment));
  if (calibration_) add(link::SettingsFor(*calibration_, robot_));
  if (ours) link::WaitUntil(*line_->port, line_->port->now_s() + kBoot_s);
  if (!driver_->Configure(settings, found)) return false;
  driver_->Cycle(1);  // receives the first sensor readings
  if (ours) {
    for (std::size_t m = 0; m < cables_.size(); ++m) {
      const auto cable = std::find_if(robot_.def.cables.begin(), robot_.def.cables.end(),
                                      [&](const CableDef& one) { return one.name == cables_[m]; });
      if (!driver_->SetReference(static_cast<int>(m), cable->rest_length_m, found)) return false;
    }
  }
  return !(ours || args.clear_faults) || ClearFaults(found);
}

std::unique_ptr<RobotConsole> RobotConsole::Open(const RobotArguments& args,
                                                 const ExperimentSpec* experiment, int& exit) {
  Diagnostics found;
  std::unique_ptr<RobotConsole> desk(new RobotConsole());
  desk->quiet_ = args.quiet;
  exit = kBadInput;
  if (!desk->Read(args, experiment, found)) {
    if (found.ok()) exit = kUsage;
    fmt::print(stderr, "{}", found.Format());
    return nullptr;
  }
  exit = kFailed;
  CatchInterrupts();
  const bool good = desk->Connect(args, experiment, found) && desk->SetUp(args, experiment, found);
  if (!good && interrupt_asked) {
    fmt::print(stderr, "interrupted before this command powered any motor\n");
    exit = kInterrupted;
    return nullptr;
  }
  fmt::print(stderr, "{}", found.Format());
  return good ? std::move(desk) : nullptr;
}

RobotConsole::~RobotConsole() { End(); }

bool RobotConsole::End() {
  if (!ended_) Finish();
  ended_ = true;
  return ended_well_;
}

void RobotConsole::Finish() {
  if (!driver_) return;
  on_cycle = {};
  const double patience_s = virtual_robot() != nullptr ? kConfirmVirtual_s : kConfirm_s;
  if (!confirm_ && !driver_->state().power_commanded) {
    // Sends the last command. Boards that were holding before this program started keep holding.
    const double until_s = driver_->port().now_s() + patience_s;
    for (int i = 0; i < 3 && driver_->state().link.connected; ++i) driver_->CycleBy(until_s);
  } else {
    power_ = link::TurnOff(*driver_, patience_s);
    Diagnostics found;
    link::ReportPower(*power_, found);
    fmt::print(stderr, "{}", found.Format());
    ended_well_ = power_->all_off();
  }
  line_->stops->StopAsked();
  line_->stops->Answer(power_ && power_->all_off() ? link::StopAnswer::kStopped
                                                   : link::StopAnswer::kUnconfirmed);
}

bool RobotConsole::EndAndReport(bool quiet) {
  const bool good = End();
  if (good && power_ && !quiet) {
    fmt::print("{}\nMotors are off.\n", link::DescribeConfirmation(*power_));
  }
  return good;
}

std::optional<int> RobotConsole::MotorOf(const std::string& cable) const {
  const auto found = std::find(cables_.begin(), cables_.end(), cable);
  if (found == cables_.end()) return std::nullopt;
  return static_cast<int>(found - cables_.begin());
}

std::optional<int> RobotConsole::MotorOf(const std::string& cable, Diagnostics& out) const {
  const auto motor = MotorOf(cable);
  if (!motor) {
    out.Error("cable.not_actuated", {}, "there is no actuated cable \"" + cable + "\"",
              DidYouMean(cable, cables_));
  }
  return motor;
}

void RobotConsole::AfterCycle(const link::State& state) {
  const bool all_stopped =
      !state.boards.empty() &&
      std::all_of(state.boards.begin(), state.boards.end(), [&](const link::BoardView& board) {
        return board.there && board.status.mode == board::Mode::kStopped;
      });
  if (state.stopping && all_stopped) line_->stops->Answer(link::StopAnswer::kStopped);
  LookForStop();
  if (on_cycle) on_cycle(state);
}

bool RobotConsole::LookForStop() {
  if (line_->stops->StopAsked()) {
    stop_asked_ = confirm_ = true;
    driver_->Stop("requested by `taut robot estop`");
  }
  if (interrupt_asked && !stop_asked_) {
    stop_asked_ = true;
    // A program that only reads does not change the state of motors that hold.
    if (driver_->state().stage == link::Stage::kActive) driver_->Stop("interrupted");
  }
  return stop_asked_;
}

Exit RobotConsole::stop_exit() const { return interrupt_asked ? kInterrupted : kFailed; }

void RobotConsole::RunWhile(const std::function<bool()>& go_on) {
  for (;;) {
    if (LookForStop() || !go_on()) return;  // End sends the stop frames
    driver_->CycleBy(driver_->port().now_s() + kLook_s);
  }
}

bool RobotConsole::ClearFaults(Diagnostics& out) {
  driver_->ClearFaults();
  driver_->Cycle(3);
  if (!driver_->state().link.connected) out.Error("adapter.lost", {}, "the adapter is gone");
  return out.ok();
}

}  // namespace taut::cli
