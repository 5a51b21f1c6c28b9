// Command `taut analyze`: statics, load cases and modes of a structure.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include "analyze_form.h"
#include "analyze_inverse.h"
#include "analyze_linear.h"
#include "analyze_page.h"
#include "analyze_path.h"
#include "analyze_pose.h"
#include "analyze_report.h"
#include "analyze_shapes.h"
#include "commands.h"
#include "output.h"
#include "overrides.h"
#include "shipped_inputs.h"
#include "taut/minimal_experiment.h"
#include "taut/start.h"

namespace taut::cli {
namespace {

struct AnalyzeArguments {
  std::string path, page;
  std::vector<std::string> set, load_cases;
  int modes = 10;
  bool tables = false, strict = false, backwards = false, form = false, linear = false,
       follow = false;
  PoseArguments pose;
  InverseArguments inverse;       ///< Arguments of `--inverse`; `json` applies to all analyses.
  FormArguments forms;            ///< Arguments of `--form`; `out` also applies to shapes.
  PathArguments load_path;        ///< Arguments of `--path`.
  LinearArguments linear_system;  ///< Arguments of `--linear` and `--response`.
};

const std::map<std::string, HoldingCost> kCosts{{"force_density", HoldingCost::kForceDensity},
                                                {"tension", HoldingCost::kTension},
                                                {"energy", HoldingCost::kEnergy}};

struct Loaded {
  ExperimentSpec experiment;  ///< For a model: default experiment with its robot.
  std::vector<LoadCaseSpec> cases;
  bool model = false;
  /// Pose from `--pose`, also set in `robot`.
  std::optional<Pose> pose;
  std::vector<double> file_rest_m;
};

/// Loads a model or an experiment and checks it as `taut check` does.
std::optional<Loaded> Load(const AnalyzeArguments& args, const Overrides& overrides,
                           Diagnostics& out) {
  const std::optional<std::string> kind = FileKind(args.path, out);
  if (!kind) return std::nullopt;
  if (*kind != "model" && *kind != "experiment") {
    out.Error("file.wrong_kind", {args.path, 0, 0}, "the file is a " + *kind,
              "expected a model or an experiment");
    return std::nullopt;
  }
  Loaded loaded;
  ExperimentSpec& experiment = loaded.experiment;
  loaded.model = *kind == "model";
  if (loaded.model) {
    auto robot = LoadRobot(args.path, overrides, out);
    if (!robot) return std::nullopt;
    experiment = MinimalExperiment(std::move(*robot));
  } else {
    auto whole = LoadExperiment(args.path, overrides, out);
    if (!whole) return std::nullopt;
    experiment = std::move(*whole);
    loaded.cases = experiment.load_cases;
  }
  for (const CableDef& cable : experiment.robot.def.cables) {
    loaded.file_rest_m.push_back(cable.rest_length_m);
  }
  if (!args.pose.file.empty()) {
    loaded.pose = ReadPose(args.pose, experiment.robot, out);
    if (!loaded.pose) return std::nullopt;
  }
  // Overlaps of bodies are checked at the analyzed pose only.
  const RobotSpec there = loaded.pose ? RobotAt(experiment.robot, *loaded.pose) : experiment.robot;
  if (!CheckStart(there, StartKind::kSettled, out)) return std::nullopt;
  return loaded;
}

/// Selects the load cases named on the command line; otherwise all cases of the file. A file
/// without load cases gets one: the weight, or no load if nothing supports the robot in the world.
bool ChooseCases(const AnalyzeArguments& args, Loaded& loaded, std::vector<std::string>& notes,
                 Diagnostics& out) {
  if (loaded.cases.empty() && args.load_cases.empty()) {
    const LoadCaseSpec own = OwnWeight(loaded.experiment.robot.def);
    if (!own.weight) notes.push_back("the robot has no support in the world: weight is left out");
    loaded.cases.push_back(own);
  }
  if (args.load_cases.empty()) return true;
  std::vector<std::string> names;
  for (const LoadCaseSpec& one : loaded.cases) names.push_back(one.name);
  std::vector<LoadCaseSpec> chosen;
  for (const std::string& name : args.load_cases) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      out.Error("load_case.unknown", {args.path, 0, 0}, "there is no load case \"" + name + "\"",
                names.empty() ? "the file has no `load_cases`" : DidYouMean(name, names));
      continue;
    }
    chosen.push_back(loaded.cases[static_cast<std::size_t>(found - names.begin())]);
  }
  loaded.cases = std::move(chosen);
  return out.ok();
}

/// Reports an error for load cases that act along a motion that the supports allow, and a note for
/// each other motion that the supports allow.
bool CheckSupportsOf(const std::string& file, const ModelDef& def,
                     const std::vector<LoadCaseSpec>& cases, std::vector<std::string>& notes,
                     Diagnostics& out) {
  for (const LoadCaseSpec& one : cases) {
    const SupportCheck check = CheckSupports(def, one);
    if (!check.missing.empty()) {
      out.Error("analysis.supports_missing", {file, 0, 0},
                "load case " + one.name + ": " + check.missing, check.fix);
      continue;
    }
    if (!IsHeld(def) || !def.planes.empty()) continue;
    for (const std::string& motion : check.free_motions) {
      const std::string note = motion + ": no member resists this motion";
      if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
    }
  }
  return out.ok();
}

/// Returns the words of a `taut analyze` command for the same structure with other flags.
std::vector<std::string> Again(const AnalyzeArguments& args,
                               const std::vector<std::string>& flags) {
  std::vector<std::string> words = WithOverrides({"analyze", args.path}, args.set);
  for (const std::string& one : args.load_cases) words.insert(words.end(), {"--load_case", one});
  if (!args.pose.file.empty()) words.insert(words.end(), {"--pose", args.pose.file});
  if (args.pose.at_s) words.insert(words.end(), {"--at_s", fmt::format("{}", *args.pose.at_s)});
  words.insert(words.end(), flags.begin(), flags.end());
  return words;
}

/// Prints equilibria, members and modes as text or JSON and writes shapes for the viewer.
int Statics(const AnalyzeArguments& args, const Loaded& loaded, AnalysisResult result) {
  result.forces = AnalyseForces(result.robot.def);
  result.cases = SolveCases(result.robot.def, loaded.cases, args.modes > 0);
  const bool json = args.inverse.json;
  if (json) {
    fmt::print("{}\n", AnalysisJson(result, args.modes));
  } else {
    fmt::print("{}", AnalysisSummary(result));
    if (args.tables) fmt::print("\n{}", AnalysisTables(result, args.modes));
  }
  for (const CaseResult& one : result.cases) {
    if (one.at.found) continue;
    fmt::print(stderr, "error: load case {}: {}\n", one.loads.name, one.at.why);
  }
  int exit = kOk;
  Diagnostics found;
  for (const CaseResult& one : result.cases) {
    if (!ExceedsDisplacement(one)) continue;
    fmt::print(stderr, "error: load case {}: {} moves by {:.4g} m, above the limit of {:.4g} m\n",
               one.loads.name, one.move.name, one.move.distance_m, *one.loads.max_displacement_m);
    exit = kFailed;
  }
  for (const CaseResult& one : result.cases) {
    const std::string far = one.at.found ? one.move.Warning() : "";
    if (far.empty()) continue;
    found.Warning("analysis.large_displacement", {args.path, 0, 0},
                  "load case " + one.loads.name + ": " + far,
                  "the supports allow a large rotation, or a mechanism moves");
  }
  if (!Pass(found, args.strict)) exit = Fail(found, kFailed);
  std::vector<std::string> next = !result.Found() ? Again(args, {"--tables"})
                                  : FormFindingMayHelp(result.forces)
                                      ? Again(args, {"--form", "--tension_n", "10"})
                                      : Again(args, {"--page", "analysis.html"});
  if (!args.forms.out.empty()) {
    ExperimentSpec there = loaded.experiment;
    there.robot = result.robot;
    std::string first;
    const int written = WriteShapes(args.forms.out, there, result, args.modes, json, first);
    if (exit == kOk) exit = written;
    if (!first.empty()) next = {"view", first};
  }
  const bool paged = !args.page.empty();
  if (paged) {
    ExperimentSpec there = loaded.experiment;
    there.robot = result.robot;
    const int written = WriteAnalysisPage(args.page, there, result, args.modes);
    if (written != kOk) return written;
    if (!json) fmt::print("Page: {}\n", args.page);
  }
  if (!json && paged) SayNextProgram({"xdg-open", args.page});
  if (!json && !paged) SayNext(next);
  return result.Found() ? exit : kFailed;
}

int Analyze(const AnalyzeArguments& args) {
  const std::optional<Overrides> overrides = ParseOverrides(args.set);
  if (!overrides) return kUsage;
  Diagnostics found;
  auto loaded = Load(args, *overrides, found);
  AnalysisResult result;
  if (loaded) ChooseCases(args, *loaded, result.notes, found);
  if (!Pass(found, args.strict)) return Fail(found, kBadInput);
  ExperimentSpec& experiment = loaded->experiment;
  if (args.linear) {
    // A model without connections to the world is analyzed without weight, as in statics.
    if (loaded->model && !IsHeld(experiment.robot.def)) {
      experiment.robot.def.gravity_m_per_s2 = {};
    }
    LinearArguments linear = args.linear_system;
    linear.json = args.inverse.json, linear.tables = args.tables;
    linear.again = Again(args, {});
    return Linear(args.path, experiment, loaded->pose, result.notes, args.modes, linear);
  }
  result.file = args.path;
  result.robot = loaded->pose ? RobotAt(experiment.robot, *loaded->pose) : experiment.robot;
  if (args.form) {
    FormArguments forms = args.forms;
    forms.tables = args.tables;
    forms.again = Again(args, {"--form"});
    return FindFormOf(args.path, result.robot, loaded->cases.front().weight, forms);
  }
  if (args.backwards) {
    InverseArguments inverse = args.inverse;
    inverse.tables = args.tables;
    inverse.again = Again(args, {"--inverse"});
    if (loaded->pose) inverse.calibration_rest_m = loaded->file_rest_m;
    return Inverse(args.path, result.robot, loaded->cases, result.notes, inverse);
  }
  if (!CheckSupportsOf(args.path, result.robot.def, loaded->cases, result.notes, found)) {
    return Fail(found, kBadInput);
  }
  if (args.follow) {
    PathArguments path = args.load_path;
    path.json = args.inverse.json, path.tables = args.tables;
    return FollowPaths(args.path, result.robot, loaded->cases, result.notes, path);
  }
  return Statics(args, *loaded, std::move(result));
}

void AddInverse(CLI::App& analyze, AnalyzeArguments& args) {
  InverseArguments& inverse = args.inverse;
  auto* const backwards =
      analyze.add_flag("--inverse", args.backwards,
                       "Inverse statics: cable tensions of least cost that hold "
                       "the described pose, with the rest lengths");
  backwards->excludes(analyze.get_option("--modes"));
  AddChoice(
      analyze, "--minimise", inverse.minimise, kCosts,
      "With --inverse: objective, summed over all cables: energy, or square of force_density or "
      "tension (default: force_density)")
      ->needs(backwards);
  const auto bound = [&](const char* flag, double& value, const char* help) {
    analyze.add_option(flag, value, help)
        ->option_text("NUMBER")
        ->check(NumberWithin(0, 1e12))
        ->needs(backwards);
  };
  bound("--at_least_n", inverse.bounds.at_least_n,
        "With --inverse: lower bound of every cable's tension [N]");
  bound("--at_most_n", inverse.bounds.at_most_n,
        "With --inverse: upper bound of every cable's tension [N]");
  bound("--at_least_n_per_m", inverse.bounds.at_least_n_per_m,
        "With --inverse: lower bound of every cable's force density [N/m]");
  bound("--at_most_n_per_m", inverse.bounds.at_most_n_per_m,
        "With --inverse: upper bound of every cable's force density [N/m]");
}

void AddForm(CLI::App& analyze, AnalyzeArguments& args) {
  auto* const form = analyze.add_flag(
      "--form", args.form, "Form finding: equilibrium shape under the described tensions");
  for (const char* const other : {"--inverse", "--modes", "--json"}) {
    form->excludes(analyze.get_option(other));
  }
  const auto of_all = [&](const char* flag, std::optional<double>& value, const char* help) {
    return analyze.add_option(flag, value, help)
        ->option_text("NUMBER")
        ->check(NumberWithin(1e-9, 1e12))
        ->needs(form);
  };
  auto* const tension =
      of_all("--tension_n", args.forms.tension_n, "With --form: tension of every cable [N]");
  of_all("--force_density_n_per_m", args.forms.force_density_n_per_m,
         "With --form: force density of every cable [N/m]")
      ->excludes(tension);
}

void AddLinear(CLI::App& analyze, AnalyzeArguments& args) {
  LinearArguments& linear = args.linear_system;
  const auto file = [&args](const std::string& path) {
    args.linear = true, args.linear_system.file = path;
  };
  auto* const whole =
      analyze
          .add_option_function<std::string>(
              "--linear", file,
              "HDF5 file to write with the linearization about the equilibrium: A, B, C, D")
          ->option_text("FILE");
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  const auto pairs = [&args](const Pairs& all) {
    args.linear = true, args.linear_system.responses = all;
  };
  auto* const response =
      analyze
          .add_option_function<Pairs>(
              "--response", pairs,
              "Frequency response of an output to an input about the equilibrium: gain and phase")
          ->option_text("INPUT OUTPUT")
          ->allow_extra_args(false);
  for (CLI::Option* const one : {whole, response}) {
    for (const char* const other : {"--inverse", "--form", "--load_case", "--out"}) {
      one->excludes(analyze.get_option(other));
    }
  }
  analyze
      .add_option("--from_hz", linear.from_hz,
                  "With --response: first frequency [Hz] (default: 0.1)")
      ->option_text("NUMBER")
      ->check(NumberWithin(1e-9, 1e9))
      ->needs(response);
  analyze
      .add_option("--to_hz", linear.to_hz,
                  "With --response: last frequency [Hz] (default: half the tick rate; a tick is "
                  "one period of the controllers, or one step without controllers)")
      ->option_text("NUMBER")
      ->check(NumberWithin(1e-9, 1e9))
      ->needs(response);
  analyze
      .add_option(
          "--points", linear.points,
          "With --response: number of frequencies, spaced by a constant factor (default: 40)")
      ->option_text("NUMBER")
      ->check(WholeNumberWithin(1, 1000000))
      ->needs(response);
  analyze.add_flag("--csv", linear.csv, "With --response: CSV instead of text")
      ->needs(response)
      ->excludes(analyze.get_option("--json"));
}

}  // namespace

void AddAnalyze(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<AnalyzeArguments>();
  CLI::App* analyze = app.add_subcommand(
      "analyze", "Analyze the statics of a structure: equilibria, self-stress, modes.");
  AddInput(*analyze, "file", {"model", "experiment"}, args->path, "Model or experiment file (YAML)")
      ->required();
  analyze->add_option("--set", args->set, "Set a parameter of the file")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  analyze
      ->add_option("--load_case", args->load_cases,
                   "Load case of the experiment to analyze (default: all)")
      ->option_text("NAME")
      ->allow_extra_args(false);
  analyze
      ->add_option(
          "--pose", args->pose.file,
          "Trace (.h5, .csv, .csv.gz) or folder of a run, with the pose to analyze instead of the "
          "described pose")
      ->option_text("FILE");
  analyze
      ->add_option("--at_s", args->pose.at_s,
                   "With --pose: time of the pose [s] (default: last row)")
      ->option_text("NUMBER")
      ->check(NumberWithin(-1e12, 1e12))
      ->needs(analyze->get_option("--pose"));
  analyze
      ->add_option("--modes", args->modes,
                   "Number of modes besides the rigid motions (default: 10)")
      ->option_text("NUMBER")
      ->check(WholeNumberWithin(0, 100000));
  analyze->add_flag("--json", args->inverse.json, "JSON instead of text");
  analyze->add_flag("--tables", args->tables, kTablesHelp);
  AddInverse(*analyze, *args);
  AddForm(*analyze, *args);
  analyze
      ->add_option("--out", args->forms.out,
                   "Folder for modes, mechanisms and states of self-stress as runs for `taut "
                   "view`; with --form: model file to write")
      ->option_text("PATH")
      ->excludes(analyze->get_option("--inverse"));
  AddLinear(*analyze, *args);
  auto* const page = analyze
                         ->add_option("--page", args->page,
                                      "Also write the load cases as an HTML page: members colored "
                                      "by utilization, displacements, modes, tables")
                         ->option_text("FILE");
  auto* const path = analyze->add_flag(
      "--path", args->follow,
      "Load-displacement path of each load case, through limit points and slackening");
  for (const char* const other : {"--inverse", "--form", "--linear", "--response"}) {
    page->excludes(analyze->get_option(other));
    path->excludes(analyze->get_option(other));
  }
  for (const char* const other : {"--page", "--out", "--modes"}) {
    path->excludes(analyze->get_option(other));
  }
  analyze
      ->add_option("--to_factor", args->load_path.to_factor,
                   "With --path: load factor at which the path ends (default: 2)")
      ->option_text("NUMBER")
      ->check(NumberWithin(1e-9, 1e9))
      ->needs(path);
  analyze->add_flag("--strict", args->strict, kStrictHelp);
  analyze->footer(
      "Examples:\n"
      "  taut analyze models/prism3.yaml\n"
      "  taut analyze models/six_strut.yaml --modes 20 --json\n"
      "  taut analyze models/prism3.yaml --inverse --minimise energy --at_least_n 5\n"
      "  taut analyze models/prism3.yaml --form --tension_n 20 --out form.yaml\n"
      "  taut analyze models/prism3.yaml --out shapes && taut view shapes/mode_1/trace.h5\n"
      "  taut analyze experiments/drop_six_strut.yaml --pose runs/drop_six_strut\n"
      "  taut analyze experiments/bridge_crowd.yaml --page analysis.html\n"
      "  taut analyze experiments/dome_snow.yaml --load_case snow --path --to_factor 5\n"
      "  taut analyze models/prism3.yaml --linear prism.h5\n"
      "  taut analyze models/hanging_mass.yaml --response node/mass/force_z node/mass/position_z\n"
      "Equilibria, self-stress, --inverse and --form are static: independent of the step, with "
      "masses\n"
      "as weights only. Modes also use the inertia of the bodies.\n"
      "Exit status: 0 success, 1 a load case has no equilibrium or exceeds its displacement "
      "limit,\n"
      "2 bad usage, 3 the file has errors or supports are missing.");
  analyze->callback([args, &exit_code] { exit_code = Analyze(*args); });
}

}  // namespace taut::cli
