#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "interrupt.h"
#include "output.h"
#include "overrides.h"
#include "progress_line.h"
#include "streams.h"
#include "taut/files.h"
#include "taut/identify.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;

struct FitArguments {
  std::string path, out;
  std::vector<std::string> set, profiles;
  int threads = 0;
  bool check = false, resume = false, design = false, quiet = false, strict = false;
};

void Show(ProgressLine& line, const IdentifyProgress& p) {
  if (!line.Due()) return;
  line.Show(fmt::format("{}: {} iterations  chi2 {:.6g}  {} experiments computed", p.what,
                        p.iterations, p.chi2, p.computed));
}

/// What `--check` says of a fit that has no mistakes.
void PrintCheck(const Identification& fit) {
  const FitProblem& train = fit.train();
  fmt::print("{}: {} numbers from {} data in {} groups", fit.spec().name, train.parameters.size(),
             train.rows.size(), train.group_names.size());
  if (fit.test()) fmt::print(", {} data held out", fit.test()->rows.size());
  fmt::print("\n");
  for (const FitParameter& p : train.parameters) {
    fmt::print("  {:<40} {:>12.6g} {}\n", p.name, p.start, p.unit);
  }
}

bool CheckProfiles(const Identification& fit, const std::vector<std::string>& asked) {
  for (const std::string& name : asked) {
    bool known = name.find('*') != name.npos;
    std::string all;
    for (const FitParameter& p : fit.train().parameters) {
      known |= p.name == name;
      all += (all.empty() ? "" : ", ") + p.name;
    }
    if (known) continue;
    fmt::print(stderr, "error: --profile: nothing is called \"{}\" (there are {})\n", name, all);
    return false;
  }
  return true;
}

/// Every experiment with what was found, the page, and the summary last.
bool WriteOutcome(const Identification& fit, const FitOutcome& outcome, const fs::path& folder,
                  Diagnostics& out) {
  for (std::size_t e = 0; e < fit.spec().experiments.size(); ++e) {
    const std::string name = "fitted_" + fit.spec().experiments[e].name + ".yaml";
    if (!WriteWholeFile((folder / name).string(),
                        FittedExperimentYaml(fit, e, outcome.fit.values, folder.string()), out)) {
      return false;
    }
  }
  return WriteWholeFile((folder / "report.html").string(), OutcomePage(fit, outcome), out) &&
         WriteWholeFile((folder / "summary.json").string(), OutcomeJson(fit, outcome), out);
}

int Judge(const FitVerdict& verdict) {
  return verdict.judgement == FitJudgement::kGood ? kOk : kFailed;
}

int Search(const FitArguments& args, const FitSpec& spec) {
  const std::string folder = args.out.empty() ? (fs::path("runs") / spec.name).string() : args.out;
  const std::string memory = (fs::path(folder) / "fit.sqlite").string();
  Diagnostics found;
  std::unique_ptr<FolderLock> lock;
  std::error_code ignored;
  if (args.resume && !fs::exists(memory, ignored)) {
    found.Error({memory}, "there is nothing to go on from", "without --resume it begins");
    return Fail(found, kBadInput);
  }
  if (!args.check) lock = FolderLock::Take(folder, found);
  if (!args.check && !lock) return Fail(found, kFailed);
  IdentifyOptions options;
  options.threads = args.threads;
  options.stop = &interrupt_asked;
  if (!args.check) options.memory_file = memory;
  CatchInterrupts();
  const auto fit = Identification::Make(spec, options, found);
  if (!fit || !Pass(found, args.strict)) return Fail(found, kBadInput);
  if (!CheckProfiles(*fit, args.profiles)) return kUsage;
  const bool depends = CheckDependence(*fit, found);
  if (interrupt_asked) return kInterrupted;
  if (!depends) return Fail(found, kBadInput);
  if (args.check) {
    if (!args.quiet) PrintCheck(*fit);
    return kOk;
  }
  if (fit->counts().damaged > 0) {
    fmt::print(stderr, "warning: {}: {} damaged records, computed again\n", memory,
               fit->counts().damaged);
  }
  ProgressLine line(args.quiet, false);
  OutcomeOptions how;
  how.profiles = args.profiles;
  how.design = args.design;
  how.stop = &interrupt_asked;
  how.progress = [&](const IdentifyProgress& p) { Show(line, p); };
  const FitOutcome outcome = RunFit(*fit, how);
  line.Clear();
  if (!fit->memory_error().empty()) {
    found.Error({memory}, "cannot be written: " + fit->memory_error());
    return Fail(found, kFailed);
  }
  if (outcome.interrupted) {
    fmt::print(stderr, "interrupted; the same command goes on from here\n");
    return kInterrupted;
  }
  if (!outcome.why.empty()) {
    fmt::print(stderr, "error: no fit: {}\n", outcome.why);
    return kFailed;
  }
  if (!WriteOutcome(*fit, outcome, folder, found)) return Fail(found, kFailed);
  if (!args.quiet) {
    fmt::print("{}\nSummary, report and fitted experiments: {}\n", OutcomeText(*fit, outcome),
               folder);
  }
  return Judge(outcome.verdict);
}

int Run(const FitArguments& args) {
  const auto overrides = ParseOverrides(args.set);
  if (!overrides) return kUsage;
  OutputIsNews();
  Diagnostics found;
  const auto spec = LoadFit(args.path, *overrides, found);
  if (!spec || !Pass(found, args.strict)) return Fail(found, kBadInput);
  return Search(args, *spec);
}

}  // namespace

void AddFit(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<FitArguments>();
  CLI::App* fit =
      app.add_subcommand("fit", "Find numbers of models and experiments from measurements.");
  fit->add_option("fit", args->path, "Fit file (YAML)")->required();
  fit->add_option("--set", args->set, "Parameter of the fit, its experiments or models")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  fit->add_option("--out", args->out, "Folder to write into (default: runs/<fit>)")
      ->option_text("FOLDER");
  fit->add_option("--threads", args->threads, "Threads, 0: one a core (default)")
      ->option_text("N")
      ->check(WholeNumberWithin(0, 1024));
  fit->add_option("--profile", args->profiles,
                  "Also the profile of this parameter, all others fitted anew; '*': of all")
      ->option_text("PARAMETER")
      ->allow_extra_args(false);
  auto* design = fit->add_flag("--design", args->design,
                               "Also what the fit's `design` would tell if it were measured");
  auto* check = fit->add_flag("--check", args->check, "Look for mistakes only, and fit nothing");
  fit->add_flag("--resume", args->resume, "Insist that the folder has something to go on from")
      ->excludes(check);
  fit->add_flag("--quiet", args->quiet, "No progress and no table");
  fit->add_flag("--strict", args->strict, kStrictHelp);
  design->excludes(check);
  fit->footer(
      "Examples:\n"
      "  taut fit fits/tetraspine3_push.yaml\n"
      "  taut fit fits/tetraspine3_push.yaml --profile push_n\n"
      "Stopped by Ctrl-C or killed, the same command goes on where it was, to the same result.\n"
      "Exit status: 0 good; 1 rejected, not identifiable, or worse than untuned on what was held\n"
      "out; 2 bad usage, 3 bad input.");
  fit->callback([args, &exit_code] { exit_code = Run(*args); });
}

}  // namespace taut::cli
