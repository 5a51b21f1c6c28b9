// Runs of each experiment before and after a fit, for the viewer.
#include "fit_runs.h"

#include <filesystem>

#include "apps/viewer/report.h"
#include "apps/viewer/web_files.h"
#include "interrupt.h"
#include "output.h"
#include "taut/run.h"
#include "taut/spec.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;

/// Writes one of the two runs. A run that fails, for example by divergence, is written too, for
/// inspection.
bool WriteOne(const Identification& fit, std::size_t e, const ExperimentSpec& experiment,
              const std::string& folder, Diagnostics& out) {
  if (fit.spec().experiments[e].forward != FitForward::kDynamic) {
    return WriteRests(fit, e, experiment, folder, out);
  }
  const auto run = RunFolder::Open(folder, {}, out);
  if (!run) return false;
  RunOptions options;
  options.progress = [](const RunProgress&) { return !interrupt_asked; };
  return RunInto(*run, experiment, options, false, out) && out.ok() && !interrupt_asked;
}

}  // namespace

std::optional<std::vector<std::string>> WriteBeforeAndAfter(const Identification& fit,
                                                            const std::string& folder,
                                                            Diagnostics& out) {
  std::vector<std::string> reports;
  std::string
      no_pages;  // without the viewer's pages there is no report, but the runs can be viewed
  const bool pages = viewer::FindWebFolder(no_pages).has_value();
  for (std::size_t e = 0; e < fit.spec().experiments.size(); ++e) {
    const FitExperiment& one = fit.spec().experiments[e];
    const fs::path untuned = fs::path(folder) / ("untuned_" + one.name);
    const fs::path fitted = fs::path(folder) / ("fitted_" + one.name);
    const auto with = LoadExperiment(fitted.string() + ".yaml", {}, out);
    if (!with || !WriteOne(fit, e, one.experiment, untuned.string(), out) ||
        !WriteOne(fit, e, *with, fitted.string(), out)) {
      return std::nullopt;
    }
    if (pages &&
        !viewer::WriteReport((fitted / "trace.h5").string(), {(untuned / "trace.h5").string()},
                             (fitted / "report.html").string(), out)) {
      return std::nullopt;
    }
    reports.push_back(pages ? "fitted_" + one.name + "/report.html" : "");
  }
  return reports;
}

}  // namespace taut::cli
