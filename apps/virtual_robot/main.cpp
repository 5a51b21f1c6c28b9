// taut_virtual_robot: emulated boards of a robot behind a pseudo-terminal, in real time, or at full
// speed.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "apps/virtual_robot/load_host.h"
#include "apps/virtual_robot/motor_plant.h"
#include "apps/virtual_robot/paced.h"
#include "apps/virtual_robot/parent_watch.h"
#include "apps/virtual_robot/run_experiment.h"
#include "apps/virtual_robot/stand.h"
#include "apps/virtual_robot/truth_server.h"
#include "taut/calibration.h"
#include "taut/faults.h"
#include "taut/shipped.h"
#include "taut/version.h"

namespace taut::virtual_robot {
namespace {

/// Exit statuses, as for the command `taut` (docs/cli.md).
enum Exit : int { kOk = 0, kFailed = 1, kUsage = 2, kBadInput = 3 };

struct Arguments {
  std::string model, experiment, firmware, faults, calibration, link, truth, log;
  std::vector<std::string> set;
  std::vector<double> drift_ppm;
  std::uint64_t seed = 1;
  double measure_s = 0, duration_s = -1, recover_s = -1;
  std::vector<std::string> board;
  std::string out;
  double noise_counts = BoardLoadCell().noise_counts;
  double usb_latency_s = ToSeconds(UsbIssOptions().request_latency);
  double slip_s = PacedOptions().slip_s;
  bool frames = false, run = false, quiet = false, csv = false, stand = false, with_parent = false;
};

/// Returns the path of the default firmware: in the program's folder for a build, in share/taut for
/// an installation; empty if there is none.
std::string OwnFirmware() { return FindBesideProgram("firmware/taut_board.elf").value_or(""); }

std::atomic<bool> stop_asked{false};
extern "C" void AskToStop(int) { stop_asked = true; }

int Fail(const Diagnostics& found) {
  fmt::print(stderr, "{}", found.Format());
  return kBadInput;
}

/// Parses "name=value", like taut's `--set`.
std::optional<Overrides> ParseSet(const std::vector<std::string>& set) {
  Overrides overrides;
  for (const std::string& one : set) {
    const std::size_t equals = one.find('=');
    if (equals == std::string::npos || equals == 0) {
      fmt::print(stderr, "error: --set {}: expected name=value\n", one);
      return std::nullopt;
    }
    overrides.emplace_back(one.substr(0, equals), one.substr(equals + 1));
  }
  return overrides;
}

/// A text file of log lines; optional.
class LogFile {
 public:
  bool Open(const std::string& path) {
    if (path.empty()) return true;
    file_ = path == "-" ? stderr : std::fopen(path.c_str(), "w");
    return file_ != nullptr;
  }
  ~LogFile() {
    if (file_ && file_ != stderr) std::fclose(file_);
  }
  LogFile() = default;
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
  LogSink Sink() const {
    if (!file_) return {};
    return [file = file_](Time at, std::string_view who, std::string_view what) {
      const std::string line = LogLine(at, who, what);
      std::fwrite(line.data(), 1, line.size(), file);
      std::fflush(file);
    };
  }

 private:
  std::FILE* file_ = nullptr;
};

/// Measures the speed of this machine: runs the boards under full load without waiting.
int Measure(Robot& robot, double seconds) {
  LoadHost host(robot);
  if (!host.Start()) {
    fmt::print(stderr, "error: the adapter does not answer\n");
    return kFailed;
  }
  const Time begun = robot.now();
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t processor_start = std::clock();
  while (!stop_asked && robot.now() < begun + FromSeconds(seconds)) host.Cycle();
  const double took_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double done_s = ToSeconds(robot.now() - begun);
  const double processor_s = static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
  fmt::print("{:.2f} x real time: {:.2f} s of {} boards in {:.2f} s\n", done_s / took_s, done_s,
             robot.board_count(), took_s);
  fmt::print("{:.2f} x real time per processor time, {:.0f} million cycles/s\n",
             done_s / processor_s, 16.0 * robot.board_count() * done_s / processor_s);
  fmt::print(
      "broadcast and {} reads with USB: mean {:.2f} ms, longest {:.2f} ms; clock stretching per "
      "byte: mean {:.1f} us, longest {:.1f} us\n",
      robot.board_count(), host.mean_cycle_s() * 1e3, host.longest_cycle_s() * 1e3,
      1e6 * ToSeconds(robot.bus().stretch().sum) / static_cast<double>(robot.bus().stretch().bytes),
      1e6 * ToSeconds(robot.bus().stretch().longest));
  return kOk;
}

std::unique_ptr<MotorPlant> LoadPlant(const Arguments& arguments, const Overrides& overrides,
                                      Diagnostics& found) {
  if (!arguments.experiment.empty()) {
    const auto experiment = LoadExperiment(arguments.experiment, overrides, found);
    return experiment ? MotorPlant::Make(experiment->robot, found) : nullptr;
  }
  auto robot = LoadRobot(arguments.model, overrides, found);
  if (!robot) return nullptr;
  PlaneDef floor;
  floor.name = "floor";
  robot->def.planes.push_back(floor);
  return MotorPlant::Make(*robot, found);
}

/// Returns the options of boards and surroundings.
RobotOptions OptionsOf(const Arguments& arguments, Diagnostics& found) {
  RobotOptions options;
  options.program = ReadAvrProgram(arguments.firmware, found);
  options.seed = arguments.seed;
  options.drift_ppm = arguments.drift_ppm;
  options.log_frames = arguments.frames;
  options.load_cell.noise_counts = arguments.noise_counts;
  options.usb.request_latency = options.usb.reply_latency = FromSeconds(arguments.usb_latency_s);
  return options;
}

int RunAnExperiment(const Arguments& arguments, const Overrides& overrides) {
  Diagnostics found;
  auto experiment = LoadExperiment(arguments.experiment, overrides, found);
  BoardsOptions options;
  options.robot = OptionsOf(arguments, found);
  for (const std::string& one : arguments.board) {
    if (const auto value = link::ReadParameter(one, "--board", found)) {
      options.settings.push_back(*value);
    }
  }
  if (!arguments.calibration.empty() && experiment) {
    options.calibration =
        LoadCalibration(arguments.calibration, link::MotorNames(experiment->robot), found);
  }
  if (!arguments.faults.empty() && experiment) {
    const auto motors = MotorPlant::Make(experiment->robot, found);
    const auto script =
        motors ? LoadFaults(arguments.faults, motors->cable_names(), found) : std::nullopt;
    if (script) options.robot.faults = script->faults;
  }
  if (!found.ok()) return Fail(found);
  LogFile log;
  if (!log.Open(arguments.log)) {
    fmt::print(stderr, "error: cannot write {}\n", arguments.log);
    return kFailed;
  }
  options.robot.log = log.Sink();
  if (arguments.recover_s >= 0) options.recover_s = arguments.recover_s;
  if (arguments.duration_s >= 0) experiment->duration_s = arguments.duration_s;
  return RunOnBoards(*experiment, options, {arguments.out, arguments.quiet, arguments.csv},
                     stop_asked, found);
}

/// Time after which boards answer: they take 4 ms to boot.
constexpr Time kBegun = 10 * kMillisecond;

/// Runs in real time behind a terminal until interrupted.
int RunInRealTime(const Arguments& arguments, MotorPlant& plant, Robot& robot, const LogSink& log) {
  Diagnostics found;
  std::unique_ptr<TruthServer> truth;
  if (!arguments.truth.empty()) {
    truth = TruthServer::Open(arguments.truth, plant, found);
    if (!truth) {
      fmt::print(stderr, "{}", found.Format());
      return kFailed;
    }
  }
  std::optional<Stand> stand;
  if (arguments.stand) stand.emplace(plant, robot, log);
  robot.after_plant_step = [&](Time now) {
    if (stand) stand->Step(now);
    if (truth) truth->Step(now);
  };
  robot.AdvanceTo(kBegun);  // a reader of the path may talk to the boards at once
  // fputs does not throw: if the reader of the output has ended, the program must still clean up.
  PacedOptions paced;
  paced.link = arguments.link;
  paced.slip_s = arguments.slip_s;
  paced.on_path = [&](const std::string& path) {
    const std::string link = arguments.link.empty() ? "" : " (" + arguments.link + ")";
    std::fputs((path + link + "\n").c_str(), stdout);
    std::fflush(stdout);
  };
  paced.on_late = [&](double late_s) {
    std::fputs(
        fmt::format("warning: {:.2f} s late: this machine is too slow or overloaded\n", late_s)
            .c_str(),
        stderr);
  };
  if (!RunPaced(robot, paced, stop_asked, found)) {
    fmt::print(stderr, "{}", found.Format());
    return kFailed;
  }
  return kOk;
}

int Run(const Arguments& arguments) {
  const auto overrides = ParseSet(arguments.set);
  if (!overrides) return kUsage;
  std::signal(SIGINT, AskToStop);
  std::signal(SIGTERM, AskToStop);
  std::signal(SIGHUP, AskToStop);
  std::signal(SIGPIPE, SIG_IGN);
  std::optional<ParentWatch> parent;
  if (arguments.with_parent) parent.emplace(stop_asked);
  if (arguments.run) return RunAnExperiment(arguments, *overrides);
  Diagnostics found;
  const auto plant = LoadPlant(arguments, *overrides, found);
  RobotOptions options = OptionsOf(arguments, found);
  std::optional<FaultScript> script;
  if (!arguments.faults.empty() && plant) {
    script = LoadFaults(arguments.faults, plant->cable_names(), found);
  }
  if (!found.ok()) return Fail(found);
  fmt::print(stderr, "{}", found.Format());  // prints warnings
  LogFile log;
  if (!log.Open(arguments.log)) {
    fmt::print(stderr, "error: cannot write {}\n", arguments.log);
    return kFailed;
  }
  options.log = log.Sink();
  if (script) options.faults = script->faults;
  Robot robot(*plant, options);
  if (arguments.measure_s > 0) return Measure(robot, arguments.measure_s);
  return RunInRealTime(arguments, *plant, robot, options.log);
}

int Main(int argc, char** argv) {
  CLI::App app{
      "Emulates the boards of a robot instruction by instruction, with taut's physics at their "
      "motors.\n"
      "Prints the device that emulates the robot's USB-ISS, and runs in real time until Ctrl-C.",
      "taut_virtual_robot"};
  Arguments arguments;
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.set_version_flag("-V,--version", std::string("taut ") + kVersion,
                       "Print the version and exit");
  CLI::Option* model =
      app.add_option("--model", arguments.model,
                     "Model of the robot, with motors as actuators, on a floor with friction 0.5")
          ->option_text("FILE");
  app.add_option(
         "--experiment", arguments.experiment,
         "Experiment with robot and terrain, instead of --model; its controllers are ignored")
      ->option_text("FILE")
      ->excludes(model);
  app.add_option("--set", arguments.set, "Set a parameter of the model")
      ->option_text("NAME=VALUE ...");
  app.add_option("--firmware", arguments.firmware,
                 "Firmware of the boards (default: shipped with taut)")
      ->option_text("ELF");
  app.add_option("--faults", arguments.faults, "Faults to inject (docs/formats/faults.md)")
      ->option_text("FILE");
  app.add_option("--link", arguments.link, "Symbolic link to create to the device")
      ->option_text("PATH");
  CLI::Option* stand = app.add_flag(
      "--stand", arguments.stand,
      "Hold the robot on a stand until the drivers of all boards have been on for 0.1 s");
  CLI::Option* truth =
      app.add_option("--truth", arguments.truth,
                     "Socket that serves the true state of the robot (docs/formats/truth.md)")
          ->option_text("PATH");
  app.add_option("--slip_s", arguments.slip_s, "Largest lateness to catch up [s] (default: 1)")
      ->option_text("S")
      ->check(CLI::Range(0.001, 1000.0));
  app.add_flag("--with_parent", arguments.with_parent, "Exit with the parent process");
  app.add_option("--log", arguments.log, "Log file; -: standard error")->option_text("FILE");
  app.add_flag("--frames", arguments.frames, "Log all USB frames, too");
  app.add_option("--seed", arguments.seed, "Seed of all noise")->option_text("NUMBER");
  app.add_option("--drift_ppm", arguments.drift_ppm, "Clock drift of each board [ppm]")
      ->expected(1, 6)
      ->check(CLI::Range(-100'000.0, 100'000.0))
      ->option_text("NUMBER ...");
  CLI::Option* measure =
      app.add_option("--measure", arguments.measure_s,
                     "Run a benchmark instead: emulated time [s], at full speed with a busy host")
          ->check(CLI::Range(0.01, 3600.0))
          ->option_text("SECONDS");
  CLI::Option* run = app.add_flag(
      "--run", arguments.run,
      "Run the experiment in virtual time instead, with an emulated PC that drives the boards");
  for (CLI::Option* in_real_time : {stand, truth}) in_real_time->excludes(measure)->excludes(run);
  app.add_option("--out", arguments.out, "With --run: output folder (default: runs/NAME_on_boards)")
      ->option_text("FOLDER")
      ->needs(run);
  app.add_option("--duration_s", arguments.duration_s,
                 "With --run: duration [s] (overrides the file)")
      ->option_text("S")
      ->check(CLI::Range(0.0, 1e9))
      ->needs(run);
  app.add_option("--recover_s", arguments.recover_s,
                 "With --run: time at which the PC configures all boards again, clears faults and "
                 "resumes [s]")
      ->option_text("S")
      ->check(CLI::Range(0.0, 1e9))
      ->needs(run);
  app.add_option(
         "--board", arguments.board,
         "With --run: set a parameter of all motors or boards (docs/hardware/parameters.md)")
      ->option_text("NAME=VALUE ...")
      ->needs(run);
  app.add_option("--calibration", arguments.calibration,
                 "With --run: calibration assumed by the PC, instead of the true values "
                 "(docs/formats/calibration.md)")
      ->option_text("FILE")
      ->needs(run);
  app.add_flag("--csv", arguments.csv, "With --run: also write trace.csv and host.csv")->needs(run);
  app.add_flag("--quiet", arguments.quiet, "With --run: no progress, no table")->needs(run);
  app.add_option("--noise_counts", arguments.noise_counts,
                 "Standard deviation of the load cells' noise [counts]")
      ->option_text("NUMBER")
      ->check(CLI::Range(0.0, 100.0));
  app.add_option("--usb_latency_s", arguments.usb_latency_s,
                 "Latency of the adapter in each direction [s]")
      ->option_text("S")
      ->check(CLI::Range(0.0, 0.1));
  app.footer(
      "Examples:\n"
      "  taut_virtual_robot --model robot.yaml --link /tmp/robot --log robot.log\n"
      "  taut_virtual_robot --model robot.yaml --faults noisy_bus.yaml --seed 7\n"
      "  taut_virtual_robot --model robot.yaml --measure 5\n"
      "  taut_virtual_robot --experiment experiments/push_20n_motors.yaml --run --out "
      "runs/on_boards\n"
      "  taut_virtual_robot --experiment experiments/push_20n_motors.yaml --run --csv "
      "--calibration calibrations/as_assumed.yaml\n"
      "This program contains libsimavr and is under the GNU General Public License, version 3.\n"
      "Exit status: 0 success, 1 failure, 2 bad usage, 3 bad input.");
  try {
    app.parse(argc, argv);
    for (std::string* path :
         {&arguments.model, &arguments.experiment, &arguments.faults, &arguments.calibration}) {
      *path = FindInput(*path);
    }
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "error: {}; see `taut_virtual_robot --help`\n", error.what());
    return kUsage;
  }
  if (arguments.model.empty() && arguments.experiment.empty()) {
    fmt::print(stderr, "error: --model FILE or --experiment FILE is missing\n");
    return kUsage;
  }
  if (arguments.run && arguments.experiment.empty()) {
    fmt::print(stderr, "error: --run needs --experiment FILE\n");
    return kUsage;
  }
  if (arguments.firmware.empty()) arguments.firmware = OwnFirmware();
  if (arguments.firmware.empty()) {
    fmt::print(stderr,
               "error: --firmware ELF is missing, because taut was built without firmware\n");
    return kUsage;
  }
  return Run(arguments);
}

}  // namespace
}  // namespace taut::virtual_robot

int main(int argc, char** argv) { return taut::virtual_robot::Main(argc, argv); }
