// Command `taut learn`: searches for the best parameters of a controller.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "interrupt.h"
#include "learn_show.h"
#include "output.h"
#include "overrides.h"
#include "progress_line.h"
#include "shipped_inputs.h"
#include "standard_streams.h"
#include "taut/cluster.h"
#include "taut/learn.h"
#include "taut/run.h"
#include "taut/study.h"
#include "taut/version.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;

struct LearnArguments {
  std::string path, out;
  std::vector<std::string> set;
  int threads = -1, top = 0;
  bool best = false, parameters = false, json = false, tables = false, quiet = false;
  bool strict = false;
  bool skip_damaged = false;
};

/// Returns a score with the name and the unit of its measure. Penalties are subtracted in this
/// unit.
std::string ScoreText(double score, Measure measure) {
  switch (measure) {
    case Measure::kDistance:
      return fmt::format("distance {:.4g} m", score);
    case Measure::kHeading:
      return fmt::format("distance ahead {:.4g} m", score);
    case Measure::kDistancePerEnergy:
      return fmt::format("distance per energy {:.4g} m/J", score);
    case Measure::kNearer:
      return fmt::format("distance gained {:.4g} m", score);
    case Measure::kTracking:
      return fmt::format("tracking {:.4g} N", score);
    case Measure::kNone:
      break;
  }
  return fmt::format("score {:.4g}", score);
}

void Show(ProgressLine& line, const LearnProgress& p, Measure measure) {
  if (!line.Due()) return;
  const std::string best = p.best_score ? ScoreText(*p.best_score, measure) : "none";
  line.Show(fmt::format("{} of {} evaluations  best: {}  {} failed  {:.3g} simulated s/s  {} left",
                        p.evaluations, p.budget, best, p.failed, p.simulated_s_per_s,
                        Duration(p.left_s)));
}

void PrintSummary(const LearnSummary& s, const StudySpec& study, const std::string& folder) {
  fmt::print("{}: {} evaluations, {} failed", study.name, s.evaluations, s.failed);
  if (s.resumed_from > 0) fmt::print(", {} of them from earlier", s.resumed_from);
  if (s.wall_s > 0) {
    fmt::print("; {} ({:.3g} simulated s/s)", Duration(s.wall_s), s.simulated_s / s.wall_s);
  }
  fmt::print("\n");
  if (s.best) {
    fmt::print("best: {}, evaluation {}\n", ScoreText(s.best->score, study.objective.measure),
               s.best->id);
  } else {
    fmt::print("best: none, every evaluation failed\n");
  }
  SayNext(s.best ? std::vector<std::string>{"learn", "--best", folder}
                 : std::vector<std::string>{"learn", "--top", "10", folder});
}

int ListParameters(const LearnArguments& args, const Overrides& overrides) {
  Diagnostics found;
  auto experiment = LoadExperiment(args.path, overrides, found);
  if (!experiment || !Pass(found, args.strict)) return Fail(found, kBadInput);
  auto scales = TunableScales(experiment->robot);
  for (const Tunable& t : FindTunables(experiment->controllers, scales, experiment->robot)) {
    fmt::print("{:<60} {:>14.8g} {}\n", t.name, *t.value, t.unit);
  }
  return kOk;
}

/// Returns the data on which all processes of a cluster must agree.
std::string Agreed(const StudySpec& study) {
  return std::string(kVersion) + "\n" + StudyText(study) + ResolvedYaml(study.experiment);
}

int SearchAlone(const StudySpec& study, const LearnArguments& args, Evaluator& evaluator) {
  Diagnostics found;
  LearnOptions options;
  options.folder = args.out.empty() ? (fs::path("runs") / study.name).string() : args.out;
  options.stop = &interrupt_asked;
  ProgressLine line(args.quiet, true);
  options.progress = [&](const LearnProgress& p) { Show(line, p, study.objective.measure); };
  options.skip_damaged = args.skip_damaged;
  const LearnSummary summary = RunStudy(study, evaluator, options, found);
  line.Clear();
  WarnOfDamage(options.folder, summary.skipped);
  if (!found.ok()) return Fail(found, summary.end == LearnEnd::kRefused ? kBadInput : kFailed);
  if (!args.quiet) PrintSummary(summary, study, options.folder);
  if (summary.end == LearnEnd::kInterrupted) {
    fmt::print(stderr, "interrupted; run the same command again to resume\n");
    return kInterrupted;
  }
  return summary.best ? kOk : kFailed;
}

int Search(const LearnArguments& args, const Overrides& overrides) {
  OutputIsNews();
  Diagnostics found;
  const auto cluster = Cluster::Join(found);
  if (!cluster) return Fail(found, kFailed);
  const auto study = LoadStudy(args.path, overrides, found);
  // Processes of a cluster use one core each unless `--threads` is given.
  const int threads = args.threads < 0 ? (cluster->size() > 1 ? 1 : 0) : args.threads;
  const bool good = study && CheckStart(study->experiment.robot, study->experiment.start, found);
  const bool passed = cluster->rank() == 0 ? Pass(found, args.strict) : Passes(found, args.strict);
  const auto local =
      good && passed ? MakeEvaluator(*study, threads, &interrupt_asked, found) : nullptr;
  CatchInterrupts();
  const bool agree = cluster->Agree(local ? Agreed(*study) : "");
  if (cluster->rank() > 0) {
    if (!agree || !local) return local ? kFailed : kBadInput;  // rank 0 prints the reason
    cluster->Serve(*local);
    return kOk;
  }
  if (!local) return Fail(found, kBadInput);
  if (!agree) {
    found.Error("cluster.different_studies", {args.path},
                "the processes of the cluster have read different studies",
                "give all machines the same files and the same version of taut");
    return Fail(found, kFailed);
  }
  return SearchAlone(*study, args, *cluster->Spread(*local, &interrupt_asked));
}

int Run(LearnArguments args) {
  if (!args.best && args.top == 0) {
    const std::string error = FindFile({args.parameters ? "experiment" : "study"}, args.path);
    if (!error.empty()) {
      fmt::print(stderr, "error: {}\n", error);
      return kUsage;
    }
  }
  const auto overrides = ParseOverrides(args.set);
  if (!overrides) return kUsage;
  if (args.parameters) return ListParameters(args, *overrides);
  if (args.best) return ReplayBest(args.path, args.skip_damaged, args.tables, args.quiet);
  if (args.top > 0) return PrintTop(args.path, args.top, args.skip_damaged, args.json);
  return Search(args, *overrides);
}

}  // namespace

void AddLearn(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<LearnArguments>();
  CLI::App* learn =
      app.add_subcommand("learn", "Search for the best parameters of a controller, gait or model.");
  learn
      ->add_option(
          "study", args->path,
          "Study file (YAML); with --best and --top: folder of a study; with --parameters: "
          "experiment file")
      ->required();
  learn->add_option("--set", args->set, "Set a parameter of the study, experiment or model")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  learn->add_option("--out", args->out, "Output folder (default: runs/<study>)")
      ->option_text("FOLDER");
  learn
      ->add_option("--threads", args->threads,
                   "Number of threads; 0: one per core (default: 0; 1 under mpirun)")
      ->option_text("N")
      ->check(WholeNumberWithin(0, 1024));
  auto* best =
      learn->add_flag("--best", args->best,
                      "Replay the best evaluation of a folder: trace, summary and report in best/");
  auto* top = learn->add_option("--top", args->top, "List the best N evaluations of a folder")
                  ->option_text("N")
                  ->check(WholeNumberWithin(1, 1'000'000));
  auto* parameters = learn->add_flag("--parameters", args->parameters,
                                     "List all parameters that a study of an experiment can vary");
  learn->add_flag("--json", args->json, "With --top: JSON instead of a table")->needs(top);
  learn
      ->add_flag("--tables", args->tables,
                 "With --best: also print all parameters and the tables of the run")
      ->needs(best);
  learn
      ->add_flag("--skip_damaged", args->skip_damaged,
                 "Ignore damaged records of the folder; a search evaluates them again")
      ->excludes(parameters);
  learn->add_flag("--quiet", args->quiet, "No progress, no summary");
  learn->add_flag("--strict", args->strict, kStrictHelp);
  best->excludes(top)->excludes(parameters);
  top->excludes(parameters);
  learn->footer(
      "Examples:\n"
      "  taut learn studies/sidewinder3.yaml\n"
      "  taut learn --top 10 runs/sidewinder3\n"
      "  taut learn --best runs/sidewinder3\n"
      "  taut learn --parameters experiments/push_20n.yaml\n"
      "After an interruption (Ctrl-C, kill) the same command resumes, with the same result.");
  learn->callback([args, &exit_code] { exit_code = Run(*args); });
}

}  // namespace taut::cli
