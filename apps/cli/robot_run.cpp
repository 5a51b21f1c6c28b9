// `taut robot run`: an experiment on a robot, in real time.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "output.h"
#include "overrides.h"
#include "robot_console.h"
#include "robot_recording.h"
#include "robot_view.h"
#include "shipped_inputs.h"
#include "taut/run.h"
#include "taut/run_folder.h"
#include "taut/summary.h"
#include "taut/time_limits.h"
#include "view_server.h"

namespace taut::cli {
namespace {

struct RunArguments : RobotArguments {
  std::string experiment, out;
  double duration_s = -1;
  bool view = false;
  viewer::ServerOptions server;
};

constexpr double kShow_s = 1.0;

void ShowProgress(const RunProgress& progress, const link::State& state, bool terminal) {
  fmt::print(stderr, "{}t = {:.1f} of {:g} s  cycle {:.1f} ms  {} late{}",
             terminal ? "\r\033[K" : "", progress.time_s, progress.duration_s,
             state.link.mean_cycle_s * 1e3, state.link.late_cycles, terminal ? "" : "\n");
  std::fflush(stderr);
}

void ShowLink(const link::State& state, std::int64_t rows) {
  const link::LinkView& link = state.link;
  std::int64_t stale = 0;
  for (const link::BoardView& board : state.boards) stale += board.stale_frames;
  fmt::print("cycles: {} in the log, {} of the link; mean {:.2f} ms, longest {:.2f} ms\n", rows,
             link.cycles, link.mean_cycle_s * 1e3, link.longest_cycle_s * 1e3);
  fmt::print(
      "lateness: mean {:.2f} ms, longest {:.2f} ms; {} late cycles, {} bad frames, {} stale "
      "frames, {} transfers without a reply\n",
      link.mean_lateness_s * 1e3, link.longest_lateness_s * 1e3, link.late_cycles,
      link::BadFrames(state), stale, link.silent_transfers);
}

void SayDryRun(const RunArguments& args, const ExperimentSpec& experiment) {
  Diagnostics found;
  const auto mode = link::ModeFor(experiment, found);
  const auto settings = link::SettingsFor(experiment.robot, args.encoder_lines);
  fmt::print(
      "would set {} parameters on the boards of {}, turn motors on, hold, and run {} for {:g} s in "
      "mode {}\n",
      settings.size() + link::GainsFor(experiment).size(), args.port, experiment.name,
      experiment.duration_s, mode ? link::ModeName(*mode) : "?");
  for (const link::Setting& setting : link::GainsFor(experiment)) {
    fmt::print("  board {} motor {}: {} = {:g}\n", setting.place.board, setting.place.index,
               link::MotorParameters()[setting.place.parameter].key, setting.value);
  }
}

int RunOn(RobotConsole& desk, const RunArguments& args, const ExperimentSpec& experiment,
          RunFolder& folder, Diagnostics& found) {
  link::Driver& driver = desk.driver();
  std::unique_ptr<RobotView> view;
  if (args.view) {
    RobotViewOptions options;
    options.title = experiment.name;
    options.server = args.server;
    options.experiment = true;
    options.recording = args.out;
    int exit = kOk;
    view = RobotView::Open(desk, args.port, std::move(options), exit);
    if (!view) return exit;
    desk.on_cycle = [&](const link::State& state) { view->AfterCycle(state); };
    desk.on_event = [&](double time_s, const std::string& text) { view->Event(time_s, text); };
  }
  link::RobotPlant plant(experiment, driver);
  TraceMetadata metadata = RunMetadata(experiment);
  metadata.emplace_back(kRunIdKey, folder.id());
  metadata.emplace_back("plant", "robot at " + args.port);
  if (!args.calibration.empty()) metadata.emplace_back("calibration", args.calibration);
  // Boards time out after 0.1 s without a command. Slow work therefore precedes the first step,
  // which powers the motors, or runs in another thread.
  const std::vector<ChannelInfo> channels = RunChannels(experiment, &plant);
  if (!folder.Prepare(ResolvedYaml(experiment), found)) return Fail(found, kFailed);
  const auto recording = RobotRecording::StartHost(folder, desk.cables(), metadata, found);
  if (!recording) return Fail(found, kFailed);
  auto trace = CreateHdf5Trace(folder.Path("trace.h5"), channels, metadata, found);
  if (!trace) return Fail(found, kFailed);
  trace = recording->Announcing(folder.BeginWith(std::move(trace), {"trace.h5"}), "trace.h5");
  trace = WriteBehind(std::move(trace), channels.size());
  const bool terminal = isatty(STDERR_FILENO) == 1;
  double shown_s = 0;
  RunOptions how;
  how.plant = &plant;
  how.traces = {trace.get()};
  how.progress = [&](const RunProgress& progress) {
    if (!args.quiet && progress.time_s >= shown_s + kShow_s) {
      shown_s = progress.time_s;
      ShowProgress(progress, driver.state(), terminal);
    }
    // Without an adapter no cycles run, so update the page here.
    if (view && !driver.state().link.connected) view->AfterCycle(driver.state());
    return !desk.LookForStop();
  };
  desk.on_event = [&](double time_s, const std::string& text) {
    recording->Event(time_s, text);
    if (view) view->Event(time_s, text);
  };
  plant.before_first_step = [&] {
    recording->BeginAt(driver.port().now_s());
    if (!plant.Hold(found)) return;
    plant.Begin();
    recording->BeginAt(plant.started_s());
    if (view) view->BeginAt(plant.started_s());
    desk.on_cycle = [&](const link::State& state) {
      recording->Take(state);
      if (view) view->AfterCycle(state);
    };
  };
  auto summary = RunExperiment(experiment, how, found);
  if (terminal && !args.quiet) fmt::print(stderr, "\r\033[K");
  const link::State at_end = driver.state();
  desk.on_cycle = {};
  const bool off = desk.End();
  desk.on_event = {};
  trace.reset();  // so that the recording knows whether the run has begun
  recording->Finish(found);
  if (!summary || !found.ok()) return Fail(found, kFailed);
  summary->run = folder.id();
  const bool whole = summary->simulated_s >= experiment.duration_s - 1e-9;
  if (found.ok()) folder.Finish(SummaryJson(*summary), found);
  if (!found.ok()) return Fail(found, kFailed);
  if (args.json) {
    fmt::print("{}", SummaryJson(*summary));
  } else if (!args.quiet) {
    fmt::print("{}\n", SummaryTable(*summary));
    ShowLink(at_end, recording->rows());
    fmt::print("Trace, cycle log (host.h5), events, inputs and summary: {}\n", args.out);
  }
  if (!off) return kFailed;
  if (desk.stop_asked()) return desk.stop_exit();
  if (whole) return kOk;
  fmt::print(stderr, "error: the run ended at t = {:.2f} s (see events.jsonl)\n",
             summary->simulated_s);
  return kFailed;
}

int Run(RunArguments args) {
  Diagnostics found;
  const auto overrides = ParseOverrides(args.set);
  if (!overrides) return kUsage;
  auto experiment = LoadExperiment(args.experiment, *overrides, found);
  if (!experiment) return Fail(found, kBadInput);
  if (args.duration_s >= 0) experiment->duration_s = args.duration_s;
  if (args.view && !TokensOf(args.server)) return kUsage;
  CheckRecord(*experiment, found);
  WarnOfStep(*experiment, found);
  link::MotorCables(experiment->robot, found);
  link::ModeFor(*experiment, found);
  if (!Pass(found, false)) return Fail(found, kBadInput);
  if (args.dry_run) {
    SayDryRun(args, *experiment);
    return kOk;
  }
  if (args.out.empty()) args.out = "runs/" + experiment->name + "_on_robot";
  const auto folder = RunFolder::Open(args.out, {}, found);
  if (!folder) return Fail(found, kFailed);
  int exit = kOk;
  const auto desk = RobotConsole::Open(args, &*experiment, exit);
  if (!desk) return exit;
  return RunOn(*desk, args, *experiment, *folder, found);
}

}  // namespace

void AddRobotRun(CLI::App& robot, int& exit_code) {
  auto args = std::make_shared<RunArguments>();
  CLI::App* run = robot.add_subcommand("run", "Run an experiment on the robot, in real time.");
  AddInput(*run, "experiment", {"experiment"}, args->experiment, "Experiment file (YAML)")
      ->required();
  AddPort(*run, *args);
  run->add_option("--set", args->set, "Set a parameter of the experiment or model")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  AddDriving(*run, *args);
  run->add_option("--duration_s", args->duration_s, "Duration [s] (overrides the file)")
      ->option_text("S")
      ->check(NumberWithin(0.0, kLongestTime_s));
  run->add_option("--out", args->out, "Output folder (default: runs/<experiment>_on_robot)")
      ->option_text("FOLDER");
  auto* view = run->add_flag("--view", args->view, "Browser page to watch and stop the run");
  run->add_option("--view_port", args->server.port,
                  "Port of the page (default: 8080; 0: any free port)")
      ->option_text("N")
      ->check(WholeNumberWithin(0, 65535))
      ->needs(view);
  run->add_flag("--json", args->json, "Summary as JSON instead of the table");
  run->add_flag("--quiet", args->quiet, "No progress, no table");
  run->footer(
      "Examples:\n"
      "  taut robot run experiments/push_20n_motors.yaml --port virtual --duration_s 10\n"
      "  taut robot run experiments/cpg_learned_motors.yaml --calibration lab.yaml --clear_faults\n"
      "  taut robot run experiments/push_20n_motors.yaml --port virtual --view\n"
      "  taut compare runs/push_20n_motors/trace.h5 runs/push_20n_motors_on_robot/trace.h5\n"
      "Impedance control runs on the boards, gaits run on this computer. Reference the cables "
      "first\n"
      "(`taut robot reference`). The trace contains measurements of the boards; apply the forces "
      "of the\n"
      "experiment's timeline by hand. At the end, also by Ctrl-C, the motors are turned off.");
  run->callback([args, &exit_code] { exit_code = Run(*args); });
}

}  // namespace taut::cli
