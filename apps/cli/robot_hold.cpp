// `taut robot hold`, `release`, `estop`, `log`: power the motors, remove power, stop, record.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "output.h"
#include "overrides.h"
#include "robot_console.h"
#include "robot_recording.h"
#include "taut/run_folder.h"
#include "taut/time_limits.h"
#include "taut/version.h"

namespace taut::cli {
namespace {

/// Interval of status lines [s].
constexpr double kReport_s = 1.0;
/// Timeout of a stop request [s]; the driving program waits for its boards' confirmation.
constexpr double kStopPatience_s = 0.9;
constexpr double kHoldConfirm_s = 0.5;
constexpr int kStops = 3;

struct HoldArguments : RobotArguments {
  double duration_s = -1;
  std::string out = "runs/robot_log";
};

void ShowLine(const link::State& state, double since_s) {
  double most = 0, least = 1e9, duty = 0;
  for (const link::MotorView& motor : state.motors) {
    most = std::max(most, motor.tension_n);
    least = std::min(least, motor.tension_n);
    duty = std::max(duty, std::abs(motor.duty));
  }
  fmt::print("{:7.1f} s  {}  {:.1f} to {:.1f} N  duty up to {:.2f}  cycle {:.1f} ms, {} late\n",
             since_s, link::ModeName(state.commanded), least, most, duty,
             state.link.mean_cycle_s * 1e3, state.link.late_cycles);
  std::fflush(stdout);
}

int Hold(const HoldArguments& args) {
  if (args.dry_run) {
    fmt::print("would turn on all motors of {} and hold their positions\n", args.port);
    return kOk;
  }
  int exit = kOk;
  const auto desk = RobotConsole::Open(args, nullptr, exit);
  if (!desk) return exit;
  Diagnostics found;
  if (!desk->driver().Enable(board::Mode::kHold, false, found)) return Fail(found, kFailed);
  if (!args.quiet) fmt::print("All motors hold. Ctrl-C turns them off.\n");
  const double begun_s = desk->driver().port().now_s();
  double shown_s = begun_s;
  bool active = true;
  desk->RunWhile([&] {
    const link::State& state = desk->driver().state();
    if (!args.quiet && state.time_s >= shown_s + kReport_s) {
      shown_s = state.time_s;
      ShowLine(state, state.time_s - begun_s);
    }
    active = state.stage == link::Stage::kActive;
    const double since_s = desk->driver().port().now_s() - begun_s;
    return active && (args.duration_s < 0 || since_s < args.duration_s);
  });
  if (!desk->EndAndReport(args.quiet)) return kFailed;
  return desk->stop_asked() ? desk->stop_exit() : active ? kOk : kFailed;
}

int Release(const RobotArguments& args) {
  if (args.dry_run) {
    fmt::print("would turn off all motors of {}\n", args.port);
    return kOk;
  }
  int exit = kOk;
  const auto desk = RobotConsole::Open(args, nullptr, exit);
  if (!desk) return exit;
  link::Driver& driver = desk->driver();
  const link::PowerReport power = link::TurnOff(driver, kHoldConfirm_s);
  Diagnostics found;
  link::ReportPower(power, found);
  if (!found.ok()) return Fail(found, kFailed);
  if (!args.quiet) fmt::print("{}\nMotors are off.\n", link::DescribeConfirmation(power));
  return kOk;
}

/// Sends stop frames directly on the bus, even if another program drives it: frames of that program
/// may be lost, and its boards stop.
int StopDirectly(const std::string& device, int boards) {
  Diagnostics found;
  const auto port = link::OpenSerialPort(device, link::PortUse::kStop, found);
  if (!port) return Fail(found, kFailed);
  link::UsbIss adapter(*port);
  const bool answers = adapter.SetMode();
  std::uint8_t stop[board::kStopSize];
  board::EncodeStop(stop);
  bool heard = false;
  for (int i = 0; i < kStops; ++i) heard = adapter.Write(board::kBroadcastAddress, stop) || heard;
  if (!answers && !heard) {
    fmt::print(stderr,
               "error: no board confirmed the stop, because the adapter does not answer: cut the "
               "motors' supply\n");
    return kFailed;
  }
  link::Requests requests(adapter);
  int stopped = 0;
  for (int b = 0; b < boards; ++b) {
    Diagnostics silent;
    const auto faults = requests.Faults(b, silent);
    if (faults && faults->stopped) ++stopped;
    if (!faults) fmt::print(stderr, "board {} does not answer\n", b);
    if (faults && !faults->stopped) fmt::print(stderr, "board {} has NOT stopped\n", b);
  }
  if (stopped == boards) {
    fmt::print("All {} boards have stopped.\n", boards);
    return kOk;
  }
  fmt::print(stderr, "error: {} of {} boards have stopped{}: cut the motors' supply\n", stopped,
             boards, heard ? "" : "; no acknowledgment");
  return kFailed;
}

int Estop(const RobotArguments& args, int boards) {
  Diagnostics found;
  const std::string device = DeviceOf(args, found);
  if (device.empty()) return Fail(found, kFailed);
  switch (link::AskToStop(device, kStopPatience_s)) {
    case link::StopAnswer::kStopped:
      fmt::print("All boards have stopped (confirmed to the program that drives the robot).\n");
      return kOk;
    case link::StopAnswer::kUnconfirmed:
      fmt::print(
          stderr,
          "the program that drives the robot sent the stop, but some boards did not confirm it: "
          "this command stops them directly\n");
      break;
    case link::StopAnswer::kSilent:
      fmt::print(stderr,
                 "the program that drives the robot does not answer: this command stops the boards "
                 "directly\n");
      break;
    case link::StopAnswer::kNobody:
      break;
  }
  return StopDirectly(device, boards);
}

int Log(const HoldArguments& args) {
  Diagnostics found;
  const auto folder = RunFolder::Open(args.out, {}, found);
  if (!folder) return Fail(found, kFailed);
  int exit = kOk;
  const auto desk = RobotConsole::Open(args, nullptr, exit);
  if (!desk) return exit;
  const auto recording = RobotRecording::Start(*folder, desk->cables(),
                                               {{"taut_version", kVersion},
                                                {"model", desk->robot().def.name},
                                                {kRunIdKey, folder->id()},
                                                {"plant", "robot at " + args.port}},
                                               found);
  if (!recording) return Fail(found, kFailed);
  link::Driver& driver = desk->driver();
  const double begun_s = driver.port().now_s();
  recording->BeginAt(begun_s);
  desk->on_cycle = [&](const link::State& state) { recording->Take(state); };
  desk->on_event = [&](double time_s, const std::string& text) { recording->Event(time_s, text); };
  if (!args.quiet) fmt::print("Recording, without commands. Ctrl-C ends it.\n");
  double shown_s = begun_s;
  desk->RunWhile([&] {
    const link::State& state = driver.state();
    if (!args.quiet && state.time_s >= shown_s + kReport_s) {
      shown_s = state.time_s;
      ShowLine(state, state.time_s - begun_s);
    }
    return args.duration_s < 0 || driver.port().now_s() < begun_s + args.duration_s;
  });
  desk->on_cycle = {};
  desk->on_event = {};
  if (!recording->Finish(found)) return Fail(found, kFailed);
  fmt::print("{} rows: {}\n", recording->rows(), folder->Path("trace.h5"));
  return desk->stop_asked() ? desk->stop_exit() : kOk;
}

void AddDuration(CLI::App& command, HoldArguments& args) {
  command.add_option("--duration_s", args.duration_s, "Duration [s] (default: until Ctrl-C)")
      ->option_text("S")
      ->check(NumberWithin(0.0, kLongestTime_s));
}

}  // namespace

void AddRobotHold(CLI::App& robot, int& exit_code) {
  auto args = std::make_shared<HoldArguments>();
  CLI::App* hold = robot.add_subcommand("hold", "Turn motors on and hold their positions.");
  AddPort(*hold, *args);
  AddModel(*hold, *args);
  AddDriving(*hold, *args);
  AddDuration(*hold, *args);
  hold->add_flag("--quiet", args->quiet, "Print problems only");
  hold->footer(
      "Examples:\n"
      "  taut robot hold\n"
      "  taut robot hold --port virtual --duration_s 5\n"
      "At the end, also by Ctrl-C, the motors are turned off.");
  hold->callback([args, &exit_code] { exit_code = Hold(*args); });
}

void AddRobotRelease(CLI::App& robot, int& exit_code) {
  auto args = std::make_shared<RobotArguments>();
  CLI::App* release = robot.add_subcommand(
      "release", "Turn off motors that still hold without a driving program; they coast.");
  AddPort(*release, *args);
  AddModel(*release, *args);
  release->add_flag("--dry_run,--dry-run", args->dry_run, "Print the planned actions only");
  release->add_flag("--quiet", args->quiet, "Print problems only");
  release->footer("Examples:\n  taut robot release\n  taut robot release --port /tmp/robot");
  release->callback([args, &exit_code] { exit_code = Release(*args); });
}

void AddRobotEstop(CLI::App& robot, int& exit_code) {
  auto args = std::make_shared<RobotArguments>();
  auto boards = std::make_shared<int>(board::kBoards);
  CLI::App* estop = robot.add_subcommand("estop",
                                         "Stop all motors (emergency stop) from any terminal, also "
                                         "while another program drives them.");
  AddPort(*estop, *args);
  estop->add_option("--boards", *boards, "Number of boards that must answer (default: 6)")
      ->option_text("N")
      ->check(WholeNumberWithin(1, board::kBoards));
  estop->footer(
      "Examples:\n"
      "  taut robot estop\n"
      "  taut robot estop --port virtual\n"
      "Motors stay off until faults are cleared. This command does not replace a switch in the "
      "motors'\n"
      "supply.\n"
      "Exit status: 0 if all boards have stopped, else 1.");
  estop->callback([args, boards, &exit_code] { exit_code = Estop(*args, *boards); });
}

void AddRobotLog(CLI::App& robot, int& exit_code) {
  auto args = std::make_shared<HoldArguments>();
  CLI::App* log = robot.add_subcommand(
      "log", "Record the sensors of the boards, one row per cycle, without commands.");
  AddPort(*log, *args);
  AddModel(*log, *args);
  AddDuration(*log, *args);
  log->add_option("--out", args->out, "Output folder (default: runs/robot_log)")
      ->option_text("FOLDER");
  log->add_flag("--quiet", args->quiet, "Print problems only");
  log->footer(
      "Examples:\n  taut robot log --duration_s 60 --out runs/by_hand\n"
      "  taut view runs/by_hand/trace.h5");
  log->callback([args, &exit_code] { exit_code = Log(*args); });
}

}  // namespace taut::cli
