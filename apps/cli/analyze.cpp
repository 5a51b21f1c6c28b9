// `taut analyze`: what holds a structure up.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include "analyze_form.h"
#include "analyze_inverse.h"
#include "analyze_report.h"
#include "commands.h"
#include "output.h"
#include "overrides.h"
#include "taut/start.h"

namespace taut::cli {
namespace {

struct AnalyzeArguments {
  std::string path;
  std::vector<std::string> set, load_cases;
  int modes = 10;
  bool strict = false, backwards = false, form = false;
  InverseArguments inverse;  ///< Of `--inverse`; its `json` of all.
  FormArguments forms;       ///< Of `--form`.
};

const std::map<std::string, HoldingCost> kCosts{{"force_density", HoldingCost::kForceDensity},
                                                {"tension", HoldingCost::kTension},
                                                {"energy", HoldingCost::kEnergy}};

struct Loaded {
  RobotSpec robot;
  std::vector<LoadCaseSpec> cases;
};

/// A model or an experiment, checked as `taut check` does.
std::optional<Loaded> Load(const AnalyzeArguments& args, const Overrides& overrides,
                           Diagnostics& out) {
  const std::optional<std::string> kind = FileKind(args.path, out);
  if (!kind) return std::nullopt;
  if (*kind == "gait") {
    out.Error({args.path, 0, 0}, "is a gait", "analyze takes a model or an experiment");
    return std::nullopt;
  }
  Loaded loaded;
  if (*kind == "experiment") {
    const auto experiment = LoadExperiment(args.path, overrides, out);
    if (!experiment) return std::nullopt;
    loaded.robot = experiment->robot;
    loaded.cases = experiment->load_cases;
  } else {
    auto robot = LoadRobot(args.path, overrides, out);
    if (!robot) return std::nullopt;
    loaded.robot = std::move(*robot);
  }
  // What is in each other is statics' business only where it stands.
  if (!CheckStart(loaded.robot, StartKind::kSettled, out)) return std::nullopt;
  return loaded;
}

/// Whether something keeps the robot in the world.
bool IsHeld(const ModelDef& def) {
  if (!def.planes.empty()) return true;
  const auto fixed = [&](int body) {
    return body == kWorld || def.bodies[static_cast<std::size_t>(body)].fixed;
  };
  for (const JointDef& joint : def.joints) {
    if (fixed(joint.body_a) || fixed(joint.body_b)) return true;
  }
  for (const CableDef& cable : def.cables) {
    for (const AttachmentDef& at : cable.attachments) {
      if (fixed(at.body)) return true;
    }
  }
  return false;
}

/// Those asked for; of a file without any, its own weight, or, where nothing holds the robot, none.
bool ChooseCases(const AnalyzeArguments& args, Loaded& loaded, std::vector<std::string>& notes,
                 Diagnostics& out) {
  if (loaded.cases.empty() && args.load_cases.empty()) {
    LoadCaseSpec own;
    own.weight = IsHeld(loaded.robot.def);
    own.name = own.weight ? "own_weight" : "unloaded";
    if (!own.weight) notes.push_back("nothing holds the robot in the world: without weight");
    loaded.cases.push_back(own);
  }
  if (args.load_cases.empty()) return true;
  std::vector<std::string> names;
  for (const LoadCaseSpec& one : loaded.cases) names.push_back(one.name);
  std::vector<LoadCaseSpec> chosen;
  for (const std::string& name : args.load_cases) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      out.Error({args.path, 0, 0}, "there is no load case \"" + name + "\"",
                names.empty() ? "load_cases of an experiment" : DidYouMean(name, names));
      continue;
    }
    chosen.push_back(loaded.cases[static_cast<std::size_t>(found - names.begin())]);
  }
  loaded.cases = std::move(chosen);
  return out.ok();
}

MemberForces Forces(const ModelDef& def, const LoadCaseSpec& loads, const Equilibrium& at,
                    std::vector<Reaction>& anchors) {
  std::vector<BodyForce> forces = ForcesUnder(def, at.cable_tension_n, at.joint_loads);
  for (const ContactState& contact : at.contacts) {
    forces.push_back({contact.body_a, contact.point_m, contact.force_n, {}});
  }
  for (const LoadCaseSpec::NodeForce& load : loads.forces) {
    const NodeDef& node = def.nodes[static_cast<std::size_t>(load.node)];
    if (node.body != kWorld) forces.push_back({node.body, node.position_m, load.force_n, {}});
  }
  ModelDef weighed = def;
  if (!loads.weight) weighed.gravity_m_per_s2 = {};
  anchors = AnchorReactions(weighed, forces);
  return {at.cable_tension_n, at.bar_force_n, StrutForces(weighed, forces)};
}

/// Against the cables that end in the world.
std::vector<CaseResult::End> Ends(const ModelDef& def, const Equilibrium& at) {
  const auto same = [](const Vec3& a, const Vec3& b) {
    return std::fabs(a.x - b.x) + std::fabs(a.y - b.y) + std::fabs(a.z - b.z) < 1e-9;
  };
  std::vector<CaseResult::End> ends;
  for (const BodyForce& force : ForcesUnder(def, at.cable_tension_n, {})) {
    if (force.body != kWorld) continue;
    auto end = std::find_if(ends.begin(), ends.end(), [&](const CaseResult::End& e) {
      return same(e.point_m, force.point_m);
    });
    if (end == ends.end()) {
      const auto node = std::find_if(def.nodes.begin(), def.nodes.end(), [&](const NodeDef& n) {
        return n.body == kWorld && same(n.position_m, force.point_m);
      });
      ends.push_back({node == def.nodes.end() ? "world" : node->name, force.point_m, {}});
      end = ends.end() - 1;
    }
    end->force_n.x -= force.force_n.x;
    end->force_n.y -= force.force_n.y;
    end->force_n.z -= force.force_n.z;
  }
  return ends;
}

CaseResult Solve(const ModelDef& def, const LoadCaseSpec& loads, const MemberForces* unloaded,
                 bool with_modes) {
  CaseResult result;
  result.loads = loads;
  result.at = FindEquilibrium(def, loads);
  result.def = ModelAt(def, result.at.pose);
  if (!result.at.found) return result;
  const MemberForces forces = Forces(result.def, loads, result.at, result.anchors);
  result.ends = Ends(result.def, result.at);
  result.members = MemberLoads(result.def, forces, unloaded);
  if (with_modes) {
    LoadCaseSpec there = loads;
    there.cables.clear();  // the pose has these rest lengths
    result.modes = FindModes(result.def, there);
  }
  return result;
}

int Analyze(const AnalyzeArguments& args) {
  const std::optional<Overrides> overrides = ParseOverrides(args.set);
  if (!overrides) return kUsage;
  Diagnostics found;
  auto loaded = Load(args, *overrides, found);
  AnalysisResult result;
  if (loaded) ChooseCases(args, *loaded, result.notes, found);
  if (!Pass(found, args.strict)) return Fail(found, kBadInput);
  result.file = args.path;
  result.robot = loaded->robot;
  const ModelDef& def = loaded->robot.def;
  if (args.form) {
    return FindFormOf(args.path, loaded->robot, loaded->cases.front().weight, args.forms);
  }
  if (args.backwards) {
    return Inverse(args.path, loaded->robot, loaded->cases, result.notes, args.inverse);
  }

  result.forces = AnalyseForces(def);
  LoadCaseSpec nothing;
  nothing.weight = false;
  const CaseResult unloaded = Solve(def, nothing, nullptr, false);
  std::vector<Reaction> ignored;
  std::optional<MemberForces> before;
  if (unloaded.at.found) before = Forces(unloaded.def, nothing, unloaded.at, ignored);
  for (const LoadCaseSpec& loads : loaded->cases) {
    result.cases.push_back(Solve(def, loads, before ? &*before : nullptr, args.modes > 0));
  }
  fmt::print("{}", args.inverse.json ? AnalysisJson(result, args.modes) + "\n"
                                     : AnalysisTables(result, args.modes));
  for (const CaseResult& one : result.cases) {
    if (one.at.found) continue;
    fmt::print(stderr, "error: load case {}: {}\n", one.loads.name, one.at.why);
  }
  return result.Found() ? kOk : kFailed;
}

void AddInverse(CLI::App& analyze, AnalyzeArguments& args) {
  InverseArguments& inverse = args.inverse;
  auto* const backwards = analyze.add_flag(
      "--inverse", args.backwards,
      "The other way round: which tensions hold the robot as described, and the rest lengths");
  backwards->excludes(analyze.get_option("--modes"));
  AddChoice(analyze, "--minimise", inverse.minimise, kCosts,
            "With --inverse: of what the sum is to be least (default: force_density)")
      ->needs(backwards);
  const auto bound = [&](const char* flag, double& value, const char* help) {
    analyze.add_option(flag, value, help)
        ->option_text("NUMBER")
        ->check(NumberWithin(0, 1e12))
        ->needs(backwards);
  };
  bound("--at_least_n", inverse.bounds.at_least_n, "With --inverse: tension of every cable");
  bound("--at_most_n", inverse.bounds.at_most_n, "The same");
  bound("--at_least_n_per_m", inverse.bounds.at_least_n_per_m,
        "With --inverse: tension by length of every cable");
  bound("--at_most_n_per_m", inverse.bounds.at_most_n_per_m, "The same");
}

void AddForm(CLI::App& analyze, AnalyzeArguments& args) {
  auto* const form = analyze.add_flag(
      "--form", args.form, "The form that the robot's cables give it, if they keep their tensions");
  for (const char* const other : {"--inverse", "--modes", "--json"}) {
    form->excludes(analyze.get_option(other));
  }
  const auto of_all = [&](const char* flag, std::optional<double>& value, const char* help) {
    return analyze.add_option(flag, value, help)
        ->option_text("NUMBER")
        ->check(NumberWithin(1e-9, 1e12))
        ->needs(form);
  };
  auto* const tension = of_all("--tension_n", args.forms.tension_n, "With --form: of every cable");
  of_all("--force_density_n_per_m", args.forms.force_density_n_per_m,
         "With --form: tension by length of every cable")
      ->excludes(tension);
  analyze.add_option("--out", args.forms.out, "With --form: write it as a model file")
      ->option_text("FILE")
      ->needs(form);
}

}  // namespace

void AddAnalyze(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<AnalyzeArguments>();
  CLI::App* analyze = app.add_subcommand(
      "analyze", "Say what holds a structure up: its equilibrium, safety and modes.");
  analyze->add_option("file", args->path, "Model or experiment file (YAML)")->required();
  analyze->add_option("--set", args->set, "Parameter of the file")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  analyze
      ->add_option("--load_case", args->load_cases,
                   "Only this load case of the experiment; may be repeated")
      ->option_text("NAME")
      ->allow_extra_args(false);
  analyze->add_option("--modes", args->modes, "How many modes to show (default: 10)")
      ->option_text("NUMBER")
      ->check(WholeNumberWithin(0, 100000));
  analyze->add_flag("--json", args->inverse.json, "JSON instead of tables");
  AddInverse(*analyze, *args);
  AddForm(*analyze, *args);
  analyze->add_flag("--strict", args->strict, kStrictHelp);
  analyze->footer(
      "Examples:\n"
      "  taut analyze models/prism3.yaml\n"
      "  taut analyze models/six_strut.yaml --modes 20 --json\n"
      "  taut analyze models/prism3.yaml --inverse --minimise energy --at_least_n 5\n"
      "  taut analyze models/prism3.yaml --form --tension_n 20 --out form.yaml\n"
      "Statics alone: it depends on no step, and on masses as weights only.\n"
      "Exit status: 0 good, 1 a load case has no equilibrium, 2 bad usage, 3 the file has errors.");
  analyze->callback([args, &exit_code] { exit_code = Analyze(*args); });
}

}  // namespace taut::cli
