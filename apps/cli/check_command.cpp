// Command `taut check`: validation of models, experiments and gaits.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "check_report.h"
#include "commands.h"
#include "gait_report.h"
#include "member_groups.h"
#include "output.h"
#include "overrides.h"
#include "shipped_inputs.h"
#include "standard_streams.h"
#include "taut/env.h"
#include "taut/fit_spec.h"
#include "taut/run.h"
#include "taut/spec.h"
#include "taut/start.h"
#include "taut/study.h"
#include "taut/version.h"

namespace taut::cli {
namespace {

struct CheckArguments {
  std::string path;
  std::vector<std::string> set;
  bool json = false, tables = false, quiet = false, couplings = false, strict = false,
       settled = false;
  CpgSymmetry symmetry = CpgSymmetry::kSegments;
  std::string svg, out;
};

/// Prints all diagnostics on stderr as text and, if requested, on stdout as JSON. Returns the exit
/// status.
int Bad(const CheckArguments& args, const Diagnostics& found) {
  const int exit = Fail(found, kBadInput);
  if (args.json) fmt::print("{}\n", ErrorsJson(args.path, found));
  return exit;
}

/// Prints the oscillator network of the experiment's gait, or the network that a new gait would
/// have.
int Couplings(const CheckArguments& args, const RobotSpec& robot,
              const ExperimentSpec* experiment) {
  CpgSymmetry symmetry = args.symmetry;
  std::vector<std::string> order;
  for (const ControllerSpec& controller :
       experiment ? experiment->controllers : std::vector<ControllerSpec>()) {
    const GaitInputSpec* input = GaitInputOf(controller);
    if (!input || !input->gait.cpg) continue;
    symmetry = input->gait.cpg->symmetry;
    order = input->gait.cpg->order;
  }
  Diagnostics found;
  const auto graph = FindCouplings(robot, symmetry, order, {args.path, 0, 0}, found);
  if (!graph) return Bad(args, found);
  fmt::print("{}\n", args.json ? CouplingJson(robot, *graph) : CouplingTables(robot, *graph));
  if (args.svg.empty()) return kOk;
  return WriteNamed(args.svg, CouplingSvg(robot, *graph));
}

/// Checks a gait file alone; whether the gait fits a robot is checked with an experiment.
int CheckGait(const CheckArguments& args, Diagnostics& found) {
  auto gait = LoadGait(args.path, found);
  if (!gait || !Pass(found, args.strict)) return Bad(args, found);
  if (args.json) {
    fmt::print("{}\n", GaitJson(*gait));
  } else if (!args.quiet) {
    const std::string values = GaitTable(*gait);
    fmt::print("{}: good: gait {}, {}\n", args.path, gait->name,
               Counted(std::count(values.begin(), values.end(), '\n'), "parameter"));
    if (args.tables) fmt::print("\n{}", values);
    SayNext({"gait", "values", args.path});
  }
  return kOk;
}

/// Checks a study or a fit, with the experiments and models that it refers to.
int CheckSearch(const CheckArguments& args, const std::string& kind, const Overrides& overrides) {
  Diagnostics found;
  std::string summary;
  if (kind == "study") {
    if (const auto study = LoadStudy(args.path, overrides, found)) {
      int evaluations = 0;
      for (const SearchSpec& search : study->searches) evaluations += search.evaluations;
      summary = fmt::format("study {}, {}, {} in {}", study->name,
                            Counted(std::ssize(study->parameters), "parameter"),
                            Counted(evaluations, "evaluation"),
                            Counted(study->perturbation.worlds, "world"));
    }
  } else if (const auto fit = LoadFit(args.path, overrides, found)) {
    summary =
        fmt::format("fit {}, {}, {}", fit->name, Counted(std::ssize(fit->estimates), "parameter"),
                    Counted(std::ssize(fit->experiments), "experiment"));
  }
  if (!Pass(found, args.strict)) return Bad(args, found);
  if (!args.quiet) {
    fmt::print("{}: good: {}\n", args.path, summary);
    SayNext(WithOverrides({kind == "study" ? "learn" : "fit", args.path}, args.set));
  }
  return kOk;
}

/// Returns the kind of the file. Only this command accepts all kinds, including "study" and "fit".
std::optional<std::string> KindToCheck(const std::string& path, Diagnostics& out) {
  Diagnostics head;
  const auto read = ReadFileHead(path, head);
  if (read && (read->kind == "study" || read->kind == "fit")) return read->kind;
  return FileKind(path, out);
}

/// Returns the experiment in which to settle the robot: the given one, or for a model one without
/// weight and terrain.
ExperimentSpec ToSettle(const RobotSpec& robot, const ExperimentSpec* experiment) {
  ExperimentSpec to_settle;
  if (experiment) {
    to_settle = *experiment;
    if (to_settle.start == StartKind::kAsDescribed) to_settle.start = StartKind::kSettled;
  } else {
    to_settle.robot = robot;
    to_settle.start = StartKind::kSettledFloating;
  }
  return to_settle;
}

/// Writes the settled robot as a model file.
int WriteModel(const CheckArguments& args, const RobotSpec& robot) {
  Diagnostics found;
  const std::optional<std::string> text = ModelYaml(
      robot,
      fmt::format(
          "Made by taut {} from {}: settled pose of the robot, at rest. An experiment with\n"
          "`start: as_described` starts in it. Leave out `place`, which would "
          "move the robot again.",
          kVersion, std::filesystem::path(args.path).filename().string()),
      found);
  if (!text) return Fail(found, kFailed);
  OutputIsNews();
  const int exit = WriteNamed(args.out, *text);
  if (exit == kOk && !args.quiet && !args.json) fmt::print("Model: {}\n\n", args.out);
  return exit;
}

int Check(const CheckArguments& args) {
  const std::optional<Overrides> overrides = ParseOverrides(args.set);
  if (!overrides) return kUsage;
  Diagnostics found;
  const std::optional<std::string> kind = KindToCheck(args.path, found);
  if (!kind) return Bad(args, found);

  const bool search = *kind == "study" || *kind == "fit";
  if (search && (args.settled || args.couplings || args.tables || args.json)) {
    fmt::print(stderr,
               "error: --settled, --couplings, --tables and --json cannot be combined with a {}\n",
               *kind);
    return kUsage;
  }
  if (search) return CheckSearch(args, *kind, *overrides);
  if (*kind == "gait" && args.settled) {
    fmt::print(stderr, "error: --settled needs an experiment or a model\n");
    return kUsage;
  }
  if (*kind == "gait") return CheckGait(args, found);
  std::optional<ExperimentSpec> experiment;
  std::optional<RobotSpec> robot;
  if (*kind == "experiment") {
    experiment = LoadExperimentAndChannels(args.path, *overrides, found);
    if (experiment) robot = experiment->robot;
  } else {
    robot = LoadRobot(args.path, *overrides, found);
  }
  // Cases that the simulator refuses are errors, too.
  if (!robot) return Bad(args, found);
  const ExperimentSpec* const of = experiment ? &*experiment : nullptr;
  const StartKind described = of ? of->start : StartKind::kAsDescribed;
  const bool settles = (args.settled || described != StartKind::kAsDescribed) && !args.couplings;
  const ExperimentSpec to_settle = settles ? ToSettle(*robot, of) : ExperimentSpec{};
  if (experiment) {
    CheckRecord(*experiment, found);
    WarnOfStep(*experiment, found);
  }
  if (experiment && experiment->environment) CheckEnvironment(*experiment, found);
  if (!CheckStart(*robot, settles ? to_settle.start : described, found)) return Bad(args, found);
  std::optional<SettledStart> settled;
  if (settles && found.ok()) settled = FindSettledStart(to_settle, found);
  const Diagnostics all = found;
  if (!Pass(found, args.strict)) return Bad(args, found);

  if (args.couplings) return Couplings(args, *robot, of);
  if (args.settled) robot = RobotAt(*robot, settled->pose);
  if (!args.out.empty()) {
    const int written = WriteModel(args, *robot);
    if (written != kOk) return written;
  }
  if (args.json) {
    fmt::print("{}\n", CheckJson(*robot, of, all, settled ? &settled->change : nullptr));
  } else if (!args.quiet) {
    fmt::print("{}", CheckSummary(args.path, *robot, of, settled ? &settled->change : nullptr));
    if (args.tables) {
      if (experiment) fmt::print("\n{}", ExperimentTables(*experiment));
      fmt::print("\n{}\n", RobotTables(*robot));
    }
    auto next = WithOverrides({experiment ? "run" : "view", args.path}, args.set);
    if (args.settled && !experiment) next.push_back("--settled");
    SayNext(next);
  }
  return kOk;
}

}  // namespace

void AddCheck(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<CheckArguments>();
  CLI::App* check = app.add_subcommand(
      "check", "Check a model, experiment, gait, study or fit file and summarize it.");
  AddInput(*check, "file", {"model", "experiment", "gait", "study", "fit"}, args->path,
           "Model, experiment, gait, study or fit file (YAML)")
      ->required();
  check->add_option("--set", args->set, "Set a parameter of the file")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  auto* couplings = check->add_flag(
      "--couplings", args->couplings,
      "Print only the oscillator network of the experiment's gait, or of a new gait for the robot");
  AddChoice(*check, "--symmetry", args->symmetry, kSymmetries,
            "With --couplings: rule by which couplings share parameters (default: segments)");
  check->add_option("--svg", args->svg, "With --couplings: SVG drawing of the network to write")
      ->option_text("FILE");
  auto* settled = check->add_flag("--settled", args->settled,
                                  "Print the settled pose (at rest) instead of the described pose");
  settled->excludes(couplings);
  check->add_option("--out", args->out, "With --settled: model file to write")
      ->option_text("FILE")
      ->needs(settled);
  check->add_flag("--json", args->json, "JSON instead of text");
  check->add_flag("--tables", args->tables, kTablesHelp);
  check->add_flag("--quiet", args->quiet, "No output for a valid file");
  check->add_flag("--strict", args->strict, kStrictHelp);
  check->footer(
      "Examples:\n"
      "  taut check models/tetraspine3.yaml\n"
      "  taut check models/tetraspine3.yaml --set segments=12 --set edge_m=0.4\n"
      "  taut check models/prism3.yaml --tables\n"
      "  taut check experiments/push_20n.yaml --json\n"
      "  taut check models/tetraspine3.yaml --couplings --svg couplings.svg\n"
      "  taut check experiments/drop_six_strut.yaml --settled --out settled.yaml\n"
      "Errors have the form file:line:column: error: problem (hint).\n"
      "Exit status: 0 the file is valid, 1 a file cannot be written, 2 bad usage, 3 the file has "
      "errors.");
  check->callback([args, &exit_code] { exit_code = Check(*args); });
}

}  // namespace taut::cli
