// Command `taut run`: simulation of an experiment.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>

#include "apps/viewer/report.h"
#include "commands.h"
#include "interrupt.h"
#include "output.h"
#include "overrides.h"
#include "shipped_inputs.h"
#include "standard_streams.h"
#include "taut/compare.h"
#include "taut/files.h"
#include "taut/plant.h"
#include "taut/run.h"
#include "taut/spec.h"
#include "taut/start.h"
#include "taut/summary.h"
#include "taut/time_limits.h"
#include "taut/trace.h"
#include "taut/version.h"
#include "taut/world_batch.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  std::string experiment, out, replay, final_pose;
  std::vector<std::string> set;
  double step_s = 0, duration_s = -1;
  std::uint64_t seed = 0;
  int threads = 1;
  bool csv = false, report = false, quiet = false, has_seed = false, strict = false;
  bool json = false, tables = false;
};

/// Progress line: rewritten in place on a terminal, printed every ten seconds elsewhere.
class RunProgressLine {
 public:
  explicit RunProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

  bool Show(const RunProgress& p) {
    if (!quiet_ && (terminal_ || p.wall_s - last_s_ >= 10)) {
      const double factor = p.wall_s > 0 ? p.time_s / p.wall_s : 0;
      const double left_s = factor > 0 ? (p.duration_s - p.time_s) / factor : 0;
      fmt::print(stderr, "{}t = {:.2f} of {:g} s  {:.3g} x real time  {:.0f} s left{}",
                 terminal_ ? "\r\033[K" : "", p.time_s, p.duration_s, factor, left_s,
                 terminal_ ? "" : "\n");
      std::fflush(stderr);
      last_s_ = p.wall_s;
    }
    return !interrupt_asked;
  }
  void Clear() const {
    if (!quiet_ && terminal_) fmt::print(stderr, "\r\033[K");
  }

 private:
  bool quiet_, terminal_;
  double last_s_ = 0;
};

/// Compares the result with the reference trace of the experiment.
void CompareWith(const std::string& reference, const std::string& result, const RunArguments& args,
                 Diagnostics& out) {
  const std::optional<Trace> a = ReadTraceOfRun(result, out), b = ReadTraceOfRun(reference, out);
  if (!a || !b || args.quiet || args.json) return;
  const Comparison comparison = Compare(*a, *b, {});
  if (args.tables) {
    fmt::print("\n{}\n", ComparisonTable(comparison, result, reference));
  } else {
    fmt::print("{}\n", ComparisonLines(comparison, result, reference).front());
  }
}

/// Returns the duration of a replay: the log's duration, or less on request.
double DurationOf(const ExperimentSpec& experiment, const Trace& log, bool asked) {
  const double of_log_s = log.time_s.back() - log.time_s.front();
  return asked ? std::min(experiment.duration_s, of_log_s) : of_log_s;
}

/// Checks before the run whether the robot's last pose can be written.
void CheckFinalPose(const RunArguments& args, const RobotSpec& robot, Diagnostics& out) {
  if (args.final_pose.empty()) return;
  ModelYaml(robot, "", out);
  const fs::path folder = fs::absolute(args.final_pose).parent_path();
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    out.Error("file.no_folder", {args.final_pose, 0, 0},
              "cannot write: there is no folder " + folder.string());
  }
}

/// Writes the robot in its last pose as a model file. Returns false on an error.
bool WriteFinalPose(const RunArguments& args, const ExperimentSpec& experiment,
                    const RunSummary& summary, Diagnostics& out) {
  if (summary.status.bits & kStatusNonFinite) {
    out.Error("run.state_not_finite", {},
              "the state is no longer finite: no pose was written to " + args.final_pose);
    return false;
  }
  const std::string heading = fmt::format(
      "Made by taut {}: pose of the robot of the experiment {} at t = {:g} s, at rest, with the "
      "rest\n"
      "lengths commanded then. Leave out an experiment's `place`, which would move the robot "
      "again.",
      kVersion, experiment.name, summary.simulated_s);
  const auto text = ModelYaml(RobotAt(experiment.robot, *summary.end), heading, out);
  return text && WriteWholeFile(args.final_pose, *text, out);
}

int Run(const RunArguments& args) {
  if (!args.replay.empty() && !args.final_pose.empty()) {
    fmt::print(stderr,
               "error: --final_pose cannot be combined with --replay, which simulates no motion\n");
    return kUsage;
  }
  Diagnostics found;
  const std::optional<Overrides> overrides = ParseOverrides(args.set);
  if (!overrides) return kUsage;
  std::optional<ExperimentSpec> experiment = LoadExperiment(args.experiment, *overrides, found);
  if (!experiment) return Fail(found, kBadInput);
  if (args.step_s > 0) experiment->step_s = args.step_s;
  if (args.duration_s >= 0) experiment->duration_s = args.duration_s;
  if (args.has_seed) experiment->seed = args.seed;

  // All inputs are checked before any file of an earlier run is overwritten.
  std::optional<Trace> log;
  std::unique_ptr<Plant> plant;
  if (!args.replay.empty()) {
    log = ReadTraceOfRun(args.replay, found);
    if (log) plant = ReplayOf(*log, experiment->robot, found);
    if (plant) experiment->duration_s = DurationOf(*experiment, *log, args.duration_s >= 0);
  } else {
    CheckStart(experiment->robot, experiment->start, found);
  }
  CheckRecord(*experiment, found);
  WarnOfStep(*experiment, found);
  CheckFinalPose(args, experiment->robot, found);
  if (!Pass(found, args.strict)) return Fail(found, kBadInput);
  if (args.strict && !plant && experiment->start != StartKind::kAsDescribed) {
    // Finds the start once more in advance, so that an error leaves the folder of the run
    // unchanged.
    if (!FindSettledStart(*experiment, found)) return Fail(found, kFailed);
    if (!Pass(found, true)) return Fail(found, kBadInput);
  }

  const std::string path =
      args.out.empty() ? (fs::path("runs") / experiment->name).string() : args.out;
  const auto folder = RunFolder::Open(path, {}, found);
  if (!folder) return Fail(found, kFailed);
  if (!args.json) OutputIsNews();
  RunProgressLine line(args.quiet);
  RunOptions options;
  options.threads = args.threads;
  options.plant = plant.get();
  options.progress = [&](const RunProgress& p) { return line.Show(p); };
  CatchInterrupts();
  TraceMetadata more;
  if (plant) more.emplace_back("replay_of", args.replay);
  const std::optional<RunSummary> summary =
      RunInto(*folder, *experiment, options, args.csv, found, more);
  line.Clear();
  if (!summary) return Fail(found, kFailed);

  const bool text = !args.quiet && !args.json;
  if (args.json) fmt::print("{}", SummaryJson(*summary));
  if (text) {
    if (args.tables) {
      fmt::print("{}\n", SummaryTable(*summary));
    } else {
      PrintRun(*summary, experiment->robot);
    }
    if (found.ok()) fmt::print("Trace, inputs and summary: {}\n", path);
  }
  if (!args.final_pose.empty() && WriteFinalPose(args, *experiment, *summary, found) && text) {
    fmt::print("Final pose, without velocities: {}\n", args.final_pose);
  }
  if (args.report && found.ok()) {
    const std::string report = folder->Path("report.html");
    if (viewer::WriteReport(folder->Path("trace.h5"), {}, report, found) && text) {
      fmt::print("Report: {}\n", report);
    }
  }
  if (experiment->compare_with && found.ok()) {
    CompareWith(*experiment->compare_with, folder->Path("trace.h5"), args, found);
  }
  if (!summary->status_text.empty()) fmt::print(stderr, "warning: {}\n", summary->status_text);
  if (!found.ok()) return Fail(found, kFailed);
  if (summary->interrupted) {
    fmt::print(stderr, "interrupted at t = {:.3f} s; the trace is complete up to this time\n",
               summary->simulated_s);
    return kInterrupted;
  }
  if (text) SayNext({"view", path});
  return summary->status.bits & kStatusNonFinite ? kFailed : kOk;
}

}  // namespace

void AddRun(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<RunArguments>();
  CLI::App* run = app.add_subcommand("run", "Simulate an experiment and record a trace.");
  AddInput(*run, "experiment", {"experiment"}, args->experiment, "Experiment file (YAML)")
      ->required();
  run->add_option("--set", args->set, "Set a parameter of the experiment or model")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  run->add_option("--step_s", args->step_s, "Time step [s] (overrides the file)")
      ->option_text("S")
      ->check(NumberWithin(kShortestStep_s, kLongestStep_s));
  run->add_option("--duration_s", args->duration_s, "Duration [s] (overrides the file)")
      ->option_text("S")
      ->check(NumberWithin(0.0, kLongestTime_s));
  run->add_option("--seed", args->seed, "Random seed (overrides the file)")
      ->option_text("N")
      ->check(WholeNumberWithin(0, std::numeric_limits<std::uint64_t>::max()))
      ->each([args](const std::string&) { args->has_seed = true; });
  run->add_option("--out", args->out, "Output folder (default: runs/<experiment>)")
      ->option_text("FOLDER");
  run->add_option(
         "--replay", args->replay,
         "Recording (.h5, .csv, .csv.gz) or folder of a run to run the controllers on, instead of "
         "a simulation")
      ->option_text("FILE");
  run->add_option("--final_pose", args->final_pose,
                  "Model file to write with the final pose, without velocities")
      ->option_text("FILE");
  run->add_option("--threads", args->threads, "Number of threads; 0: one per core (default: 1)")
      ->option_text("N")
      ->check(WholeNumberWithin(0, 1024));
  run->add_flag("--csv", args->csv, "Also write trace.csv");
  run->add_flag("--report", args->report,
                "Also write report.html, one file that opens in any browser");
  run->add_flag("--json", args->json, "Summary as JSON instead of text");
  run->add_flag("--tables", args->tables, kTablesHelp);
  run->add_flag("--quiet", args->quiet, "No progress, no summary");
  run->add_flag("--strict", args->strict, kStrictHelp);
  run->footer(
      "Examples:\n"
      "  taut run experiments/push_20n.yaml\n"
      "  taut run experiments/push_20n.yaml --set push_n=15 --step_s 0.0005 --out runs/push_15n\n"
      "  taut run experiments/push_20n.yaml --csv --quiet\n"
      "  taut run experiments/push_20n.yaml --replay measured.csv --out runs/would_have\n"
      "Ctrl-C ends a run early; its trace is complete up to that time (exit status 130).\n"
      "A folder contains one run: a new run replaces it, and a second run at the same time is an "
      "error.");
  run->callback([args, &exit_code] { exit_code = Run(*args); });
}

}  // namespace taut::cli
