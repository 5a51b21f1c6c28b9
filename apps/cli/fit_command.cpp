// Command `taut fit`: system identification.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "fit_runs.h"
#include "interrupt.h"
#include "member_groups.h"
#include "output.h"
#include "overrides.h"
#include "progress_line.h"
#include "shipped_inputs.h"
#include "standard_streams.h"
#include "taut/cluster.h"
#include "taut/files.h"
#include "taut/identify.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;

struct FitArguments {
  std::string path, out;
  std::vector<std::string> set, profiles;
  int threads = -1;
  bool check = false, resume = false, design = false, tables = false, quiet = false, strict = false;
};

/// Shows the state of a fit: values with units, and during the search an upper bound of the time
/// left. A search usually ends long before its largest number of iterations.
void Show(ProgressLine& line, const IdentifyProgress& p, const FitProblem& problem,
          double elapsed_s) {
  if (!line.Due()) return;
  std::string text = fmt::format("{}: {} iterations  chi2 {:.4g}", p.what, p.iterations, p.chi2);
  constexpr std::size_t kMost = 4;
  for (std::size_t i = 0; i < std::min({p.values.size(), problem.parameters.size(), kMost}); ++i) {
    const FitParameter& parameter = problem.parameters[i];
    text += fmt::format("  {} = {:.4g}{}{}", parameter.name, p.values[i],
                        parameter.unit.empty() ? "" : " ", parameter.unit);
  }
  text += fmt::format("  {} experiments computed", p.computed);
  if (p.most_iterations > p.iterations && p.iterations > 0) {
    const double left_s = elapsed_s / p.iterations * (p.most_iterations - p.iterations);
    text += "  at most " + Duration(left_s) + " left";
  }
  line.Show(text);
}

/// Prints the result of `--check` for a fit without errors.
void PrintCheck(const Identification& fit, bool tables) {
  const FitProblem& train = fit.train();
  std::string verdict =
      fmt::format("{}: {} parameters from {} data points in {} groups", fit.spec().name,
                  train.parameters.size(), train.rows.size(), train.group_names.size());
  if (fit.test()) verdict += fmt::format(", {} held out", fit.test()->rows.size());
  CappedLines lines(tables ? CappedLines::kAll : CappedLines::kMost);
  for (const FitParameter& p : train.parameters) {
    lines.Add(fmt::format("{:<40} {:>12.6g} {}", p.name, p.start, p.unit));
  }
  fmt::print("{}", lines.Text(verdict));
}

std::string MemoryIn(const std::string& folder) {
  return (fs::path(folder) / "fit.sqlite").string();
}

/// Returns the command that shows an experiment before and after the fit.
std::vector<std::string> LookAt(const FitExperiment& one, const std::string& folder) {
  const auto trace = [&](const char* which) {
    return (fs::path(folder) / (which + one.name) / "trace.h5").string();
  };
  return {"view", trace("fitted_"), "--compare", trace("untuned_")};
}

/// Prints the verdict, its summary and, on request, the tables of all parameters and channels.
void PrintOutcome(const Identification& fit, const FitOutcome& outcome, bool tables,
                  const std::string& folder) {
  const std::vector<std::string> lines = OutcomeLines(fit, outcome);
  fmt::print("{}", CappedLines(lines).Text(lines.front()));
  if (tables) fmt::print("\n{}\n", OutcomeText(fit, outcome));
  fmt::print("Summary, report and fitted experiments: {}\n", folder);
  const std::vector<FitExperiment>& experiments = fit.spec().experiments;
  if (tables && experiments.size() > 1) {
    fmt::print("Comparison of the other experiments before and after the fit:\n");
    for (std::size_t e = 1; e < experiments.size(); ++e) {
      const std::vector<std::string> words = LookAt(experiments[e], folder);
      fmt::print("  taut {} {} {} {}\n", words[0], words[1], words[2], words[3]);
    }
  }
  if (!experiments.empty()) SayNext(LookAt(experiments.front(), folder));
}

bool CheckProfiles(const Identification& fit, const std::vector<std::string>& asked, bool say) {
  for (const std::string& name : asked) {
    bool known = name.find('*') != name.npos;
    std::string all;
    for (const FitParameter& p : fit.train().parameters) {
      known |= p.name == name;
      all += (all.empty() ? "" : ", ") + p.name;
    }
    if (known) continue;
    if (!say) return false;
    fmt::print(stderr, "error: --profile: there is no parameter \"{}\" (expected {})\n", name, all);
    return false;
  }
  return true;
}

/// Writes every experiment with its estimates, runs to view, the report page, and the summary last.
bool WriteOutcome(const Identification& fit, const FitOutcome& outcome, const fs::path& folder,
                  Diagnostics& out) {
  for (std::size_t e = 0; e < fit.spec().experiments.size(); ++e) {
    const std::string name = "fitted_" + fit.spec().experiments[e].name + ".yaml";
    if (!WriteWholeFile((folder / name).string(),
                        FittedExperimentYaml(fit, e, outcome.fit.values, folder.string()), out)) {
      return false;
    }
  }
  const auto looks = WriteBeforeAndAfter(fit, folder.string(), out);
  return looks &&
         WriteWholeFile((folder / "report.html").string(), OutcomePage(fit, outcome, *looks),
                        out) &&
         WriteWholeFile((folder / "summary.json").string(), OutcomeJson(fit, outcome), out);
}

int Judge(const FitVerdict& verdict) {
  return verdict.judgement == FitJudgement::kGood ? kOk : kFailed;
}

int FailOfInput(const Identification& fit) {
  fmt::print(stderr, "error: {}; run the same command again to resume\n", fit.input_error());
  return kFailed;
}

/// Runs a prepared fit on rank 0 and writes its results.
int Search(const FitArguments& args, const Identification& fit, const std::string& folder) {
  Diagnostics found;
  const bool depends = CheckDependence(fit, found);
  if (interrupt_asked) return kInterrupted;
  if (!fit.input_error().empty()) return FailOfInput(fit);
  if (!depends) return Fail(found, kBadInput);
  if (args.check) {
    if (args.quiet) return kOk;
    PrintCheck(fit, args.tables);
    SayNext(WithOverrides({"fit", args.path}, args.set));
    return kOk;
  }
  if (fit.counts().damaged > 0) {
    fmt::print(stderr, "warning: {}: {} damaged records are computed again\n", MemoryIn(folder),
               fit.counts().damaged);
  }
  ProgressLine line(args.quiet, true);
  OutcomeOptions how;
  how.profiles = args.profiles;
  how.design = args.design;
  how.stop = &interrupt_asked;
  const auto begin = std::chrono::steady_clock::now();
  how.progress = [&](const IdentifyProgress& p) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    Show(line, p, fit.train(), elapsed.count());
  };
  const FitOutcome outcome = RunFit(fit, how);
  line.Clear();
  if (!fit.memory_error().empty()) {
    found.Error("fit.memory_not_writable", {MemoryIn(folder)},
                "cannot write: " + fit.memory_error());
    return Fail(found, kFailed);
  }
  if (!fit.input_error().empty()) return FailOfInput(fit);
  if (!outcome.interrupted && !outcome.why.empty()) {
    fmt::print(stderr, "error: the fit failed: {}\n", outcome.why);
    return kFailed;
  }
  const bool written = !outcome.interrupted && WriteOutcome(fit, outcome, folder, found);
  if (outcome.interrupted || (!written && interrupt_asked)) {
    fmt::print(stderr, "interrupted; run the same command again to resume\n");
    return kInterrupted;
  }
  if (!written) return Fail(found, kFailed);
  if (!args.quiet) PrintOutcome(fit, outcome, args.tables, folder);
  return Judge(outcome.verdict);
}

/// Result of the preparations on rank 0: locked folder and validated fit.
struct Ready {
  std::unique_ptr<FolderLock> lock;
  std::unique_ptr<Identification> fit;
  int exit = kOk;  ///< Exit status if preparation failed.
};

Ready Begin(const FitArguments& args, const FitSpec& spec, const std::string& folder, int threads,
            bool first) {
  Ready ready;
  Diagnostics found;
  std::error_code ignored;
  const auto end = [&](int exit) {
    if (first) Fail(found, kFailed);
    ready.exit = exit;
    ready.fit.reset();
    return std::move(ready);
  };
  if (args.resume && !fs::exists(MemoryIn(folder), ignored)) {
    found.Error("fit.nothing_to_resume", {MemoryIn(folder)}, "there is no fit to resume",
                "leave out --resume to start the fit");
    return end(kBadInput);
  }
  if (first && !args.check) {
    ready.lock = FolderLock::Take(folder, found);
    if (!ready.lock) return end(kFailed);
  }
  IdentifyOptions options;
  options.threads = threads;
  options.stop = &interrupt_asked;
  if (first && !args.check) options.memory_file = MemoryIn(folder);
  ready.fit = Identification::Make(spec, options, found);
  if (!ready.fit || !(first ? Pass(found, args.strict) : Passes(found, args.strict))) {
    return end(kBadInput);
  }
  if (!CheckProfiles(*ready.fit, args.profiles, first)) return end(kUsage);
  return ready;
}

int Run(const FitArguments& args) {
  const auto overrides = ParseOverrides(args.set);
  if (!overrides) return kUsage;
  OutputIsNews();
  Diagnostics found;
  const auto cluster = Cluster::Join(found);
  if (!cluster) return Fail(found, kFailed);
  const bool first = cluster->rank() == 0;
  // Processes of a cluster use one core each unless `--threads` is given.
  const int threads = args.threads < 0 ? (cluster->size() > 1 ? 1 : 0) : args.threads;
  const auto spec = LoadFit(args.path, *overrides, found);
  const bool passed = first ? Pass(found, args.strict) : Passes(found, args.strict);
  CatchInterrupts();
  const bool read = spec && passed;
  const std::string folder =
      !read || !args.out.empty() ? args.out : (fs::path("runs") / spec->name).string();
  Ready ready;
  if (read) ready = Begin(args, *spec, folder, threads, first);
  const auto local = [&](std::span<const std::string> pieces) { return ready.fit->Do(pieces); };
  const bool agree = cluster->Agree(ready.fit ? ready.fit->Agreed() : "");
  if (!read) return first ? Fail(found, kBadInput) : kBadInput;
  if (!ready.fit) return ready.exit;
  if (!agree) {
    if (!first) return kFailed;  // rank 0 prints the reason
    found.Error("cluster.different_fits", {args.path},
                "the processes of the cluster have read different fits",
                "give all machines the same files and the same version of taut");
    return Fail(found, kFailed);
  }
  if (!first) {
    cluster->Serve(local);
    return kOk;
  }
  if (cluster->size() > 1) {
    ready.fit->SpreadBy(cluster->Spread(local, &interrupt_asked), cluster->size());
  }
  const int exit = Search(args, *ready.fit, folder);
  ready.fit.reset();  // releases the other processes before the cluster ends
  return exit;
}

}  // namespace

void AddFit(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<FitArguments>();
  CLI::App* fit =
      app.add_subcommand("fit", "Estimate parameters of models and experiments from measurements.");
  AddInput(*fit, "fit", {"fit"}, args->path, "Fit file (YAML)")->required();
  fit->add_option("--set", args->set, "Set a parameter of the fit, its experiments or models")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  fit->add_option("--out", args->out, "Output folder (default: runs/<fit>)")->option_text("FOLDER");
  fit->add_option("--threads", args->threads,
                  "Number of threads; 0: one per core (default: 0; 1 under mpirun)")
      ->option_text("N")
      ->check(WholeNumberWithin(0, 1024));
  fit->add_option(
         "--profile", args->profiles,
         "Also compute the profile likelihood of this parameter, refitting all others; '*': of all")
      ->option_text("PARAMETER")
      ->allow_extra_args(false);
  auto* design = fit->add_flag(
      "--design", args->design,
      "Also compute the expected information of the fit's planned measurements (`design`)");
  auto* check = fit->add_flag("--check", args->check, "Check files and data only");
  fit->add_flag("--resume", args->resume, "Fail if the folder has no fit to resume")
      ->excludes(check);
  fit->add_flag("--tables", args->tables, "Also print the tables of all parameters and channels");
  fit->add_flag("--quiet", args->quiet, "No progress, no summary");
  fit->add_flag("--strict", args->strict, kStrictHelp);
  design->excludes(check);
  fit->footer(
      "Examples:\n"
      "  taut fit fits/hanging_mass.yaml\n"
      "  taut fit fits/tetraspine3_push.yaml --profile push_n\n"
      "  mpirun -np 8 taut fit fits/tetraspine3_push.yaml\n"
      "After an interruption (Ctrl-C, kill) the same command resumes, with the same result.\n"
      "Exit status: 0 success; 1 rejected, contradiction between experiments, not identifiable,\n"
      "unreliable, or worse than untuned on held-out data;\n"
      "2 bad usage, 3 bad input.");
  fit->callback([args, &exit_code] { exit_code = Run(*args); });
}

}  // namespace taut::cli
