// Command `taut view`: 3D view of live runs, recordings and robots in a browser.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/live_inputs.h"
#include "apps/viewer/live_session.h"
#include "apps/viewer/recording.h"
#include "apps/viewer/replay_session.h"
#include "apps/viewer/server.h"
#include "apps/viewer/web_files.h"
#include "commands.h"
#include "output.h"
#include "overrides.h"
#include "shipped_inputs.h"
#include "standard_streams.h"
#include "taut/run.h"
#include "taut/run_folder.h"
#include "taut/spec.h"
#include "view_robot.h"
#include "view_server.h"
#include "view_statics.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;
using viewer::Session;

struct ViewArguments {
  std::string file, out;
  std::vector<std::string> compare, set;
  double speed = 1, step_s = 0;
  bool max = false, settled = false, paused = false;
  viewer::ServerOptions server;
  ViewRobotArguments robot;  ///< Its `port` is empty without a robot.
};

bool IsTrace(const std::string& path) {
  return path.ends_with(".h5") || path.ends_with(".csv") || path.ends_with(".csv.gz");
}

/// Creates a replay. Returns null on an error; then `exit` is the status.
std::unique_ptr<Session> MakeReplay(const ViewArguments& args, int& exit) {
  Diagnostics found;
  auto recorded = viewer::Recorded::Load(args.file, args.compare, found);
  if (recorded) {
    return std::make_unique<viewer::ReplaySession>(std::move(recorded), args.max ? 0 : args.speed);
  }
  fmt::print(stderr, "{}", found.Format());
  exit = kBadInput;
  return nullptr;
}

/// Creates a live run of an experiment or a model. Returns null on an error; then `exit` is the
/// status.
std::unique_ptr<Session> MakeLive(const ViewArguments& args, int& exit) {
  Diagnostics found;
  exit = kUsage;
  const std::optional<Overrides> overrides = ParseOverrides(args.set);
  if (!overrides) return nullptr;
  exit = kBadInput;
  std::optional<viewer::LiveInputs> inputs =
      viewer::LoadLiveInputs(args.file, *overrides, args.settled, found);
  if (!inputs || !Pass(found, false)) {
    Fail(found, kBadInput);
    return nullptr;
  }
  const bool model = inputs->model;
  ExperimentSpec& experiment = inputs->experiment;
  viewer::LiveOptions options;
  options.inputs = {args.file, *overrides, args.step_s, std::nullopt};
  if (args.settled) {
    options.inputs.start = model ? StartKind::kSettledFloating : StartKind::kSettled;
  }
  if (args.step_s > 0) experiment.step_s = args.step_s;
  exit = kFailed;
  if (!args.out.empty()) {
    std::error_code error;
    fs::create_directories(args.out, error);
    if (error) {
      fmt::print(stderr, "{}: error: cannot create the folder: {}\n", args.out, error.message());
      return nullptr;
    }
  }
  options.speed = args.max ? 0 : args.speed;
  options.paused = args.paused || model;
  options.watch = true;
  options.record = viewer::RecordInto(args.out);
  options.tell = Tell;
  if (model) options.statics = ViewStatics;
  auto session = viewer::LiveSession::Create(model ? "model" : "live", experiment, options, found);
  fmt::print(stderr, "{}",
             found.Format());  // a settled start far from the described pose is only a warning
  return session;
}

/// Serves the control page of a robot after checking that no other arguments conflict.
int Dashboard(const ViewArguments& args) {
  if (!args.file.empty() || !args.compare.empty() || args.settled || args.paused || args.max ||
      args.speed != 1 || args.step_s > 0) {
    fmt::print(stderr,
               "error: --robot cannot be combined with a file, --compare, --settled, --paused, "
               "--max, --speed or --step_s\n");
    return kUsage;
  }
  ViewRobotArguments robot = args.robot;
  robot.set = args.set;
  robot.out = args.out;
  robot.server = args.server;
  return ViewRobot(std::move(robot));
}

int View(ViewArguments args) {
  if (!args.robot.port.empty()) return Dashboard(args);
  if (args.file.empty()) {
    fmt::print(stderr, "error: FILE is missing (expected a file, or --robot PORT)\n");
    return kUsage;
  }
  if (!args.robot.model.empty() || !args.robot.calibration.empty()) {
    fmt::print(stderr, "error: --model and --calibration need --robot\n");
    return kUsage;
  }
  args.file = TraceOfRun(args.file);
  for (std::string& other : args.compare) other = TraceOfRun(other);
  OutputIsNews();
  std::string error;
  const std::optional<std::string> web = viewer::FindWebFolder(error);
  if (!web) {
    fmt::print(stderr, "error: {}\n", error);
    return kFailed;
  }
  if (IsTrace(args.file) &&
      (!args.set.empty() || args.settled || !args.out.empty() || args.step_s > 0)) {
    fmt::print(stderr,
               "error: --set, --step_s, --settled and --out cannot be combined with a trace\n");
    return kUsage;
  }
  if (!IsTrace(args.file) && !args.compare.empty()) {
    fmt::print(stderr, "error: --compare needs a trace\n");
    return kUsage;
  }
  if (!TokensOf(args.server)) return kUsage;
  int exit = kOk;
  const std::unique_ptr<Session> session =
      IsTrace(args.file) ? MakeReplay(args, exit) : MakeLive(args, exit);
  if (!session) return exit;
  viewer::Server server(*session, viewer::ReadWebFiles(*web), args.server);
  if (!server.Listen(error)) {
    fmt::print(stderr, "error: {}\n", error);
    return kFailed;
  }
  SayAddresses(session->title(), args.server, server.port(), "Ctrl-C ends it.");
  server.Run();
  return session->Finish() ? kOk : kFailed;
}

}  // namespace

void AddView(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<ViewArguments>();
  CLI::App* view =
      app.add_subcommand("view", "Show a model, experiment, recorded run or robot in the browser.");
  AddInput(*view, "file", {"trace", "model", "experiment"}, args->file,
           "Trace (.h5, .csv, .csv.gz), model or experiment (YAML), or folder of a run or a robot");
  args->robot.port.clear();
  view->add_option(
          "--robot", args->robot.port,
          "Robot to drive, instead of a file: serial port, or `virtual` for an emulated one")
      ->option_text("virtual|PORT");
  AddInput(*view, "--model", {"model"}, args->robot.model,
           "With --robot: model (default: tetraspine3_motors.yaml of taut)")
      ->option_text("FILE");
  AddInput(*view, "--calibration", {"calibration"}, args->robot.calibration,
           "With --robot: calibration file to set on the boards")
      ->option_text("FILE");
  view->add_option("--set", args->set, "Set a parameter of the experiment or model")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  view->add_option("--step_s", args->step_s, "Time step [s] (overrides the file)")
      ->option_text("S")
      ->check(NumberWithin(1e-9, 1.0));
  auto* speed =
      view->add_option("--speed", args->speed, "Simulated seconds per second (default: 1)")
          ->option_text("X")
          ->check(NumberWithin(0.001, 1000.0));
  view->add_flag("--max", args->max, "Run as fast as possible")->excludes(speed);
  view->add_flag("--paused", args->paused, "Start paused");
  view->add_flag("--settled", args->settled, "Start with the settled robot, at rest");
  view->add_option(
          "--compare", args->compare,
          "With a trace: traces or folders of at most 7 other runs to compare with, each with a "
          "ghost of its robot")
      ->option_text("TRACE");
  view->add_option(
          "--out", args->out,
          "Live run or --robot: folder for recordings (trace, inputs, events) (default: none)")
      ->option_text("FOLDER");
  view->add_option("--listen", args->server.address,
                   "Address to listen on (default: 127.0.0.1, this machine only)")
      ->option_text("ADDRESS")
      ->check([](const std::string& address) {
        if (viewer::IsAddress(address)) return std::string();
        return fmt::format(
            "\"{}\" is not an address (expected 127.0.0.1 for this machine only, or 0.0.0.0 for "
            "all)",
            address);
      });
  view->add_option("--port", args->server.port,
                   "Port of the web server (default: 8080; 0: any free port)")
      ->option_text("N")
      ->check(WholeNumberWithin(0, 65535));
  view->footer(
      "Examples:\n"
      "  taut view experiments/push_20n.yaml --speed 0.25\n"
      "  taut view runs/push_20n/trace.h5 --compare runs/a/trace.h5 runs/b/trace.h5\n"
      "  taut view models/tetraspine3.yaml --settled\n"
      "  taut view --robot virtual\n"
      "  taut view models/puppy.yaml --listen 0.0.0.0\n"
      "The command prints two addresses with secret tokens, to open in a browser: the first to "
      "watch\n"
      "and drive, the second to watch only. The tokens are random, unless the environment "
      "variables\n"
      "TAUT_TOKEN and TAUT_WATCH_TOKEN set them. With --listen 0.0.0.0 it also prints a QR code, "
      "which\n"
      "opens the page on a phone in the same network. With --robot only this machine can connect, "
      "and\n"
      "Ctrl-C turns the motors off.");
  view->callback([args, &exit_code] { exit_code = View(*args); });
}

}  // namespace taut::cli
