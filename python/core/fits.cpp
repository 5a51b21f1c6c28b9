// System identification: `taut.fit` and `taut.Fitted`.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "interruptible.h"
#include "taut/files.h"
#include "taut/identify.h"
#include "text.h"

namespace taut::python {
namespace {

/// A completed fit. `fit` is used for no further computation, since its stop function no longer
/// exists.
struct Fitted {
  std::unique_ptr<Identification> fit;
  FitOutcome outcome;
};

/// Returns experiment `number` with the estimated parameters, identical to the file written by
/// `taut fit`.
std::shared_ptr<ExperimentSpec> ExperimentOf(const Fitted& f, py::ssize_t number) {
  const auto& all = f.fit->spec().experiments;
  const auto e =
      static_cast<std::size_t>(Index(number, static_cast<int>(all.size()), "experiment"));
  Overrides set = all[e].set;  // the last value of a name counts
  const FitProblem& problem = f.fit->train();
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const FitEstimate& estimate = f.fit->spec().estimates[f.fit->estimates()[i]];
    const auto& on = estimate.experiments;
    if (estimate.kind != FitEstimate::Kind::kParameter ||
        std::find(on.begin(), on.end(), e) == on.end()) {
      continue;
    }
    set.emplace_back(estimate.parameter, fmt::format("{}", f.outcome.fit.values[i]));
  }
  Diagnostics said;
  auto experiment = LoadExperiment(all[e].experiment_file, set, said);
  if (!experiment) Refuse(said);
  return std::make_shared<ExperimentSpec>(std::move(*experiment));
}

/// Reports names in `profiles` that are not parameters of the fit.
void CheckProfiles(const Identification& fit, const std::vector<std::string>& profiles,
                   Diagnostics& said) {
  const std::vector<std::string> names = NamesOf(fit.train().parameters);
  for (const std::string& name : profiles) {
    if (name.find('*') != name.npos || std::find(names.begin(), names.end(), name) != names.end()) {
      continue;
    }
    said.Error("profile.unknown_name", {}, "profiles: there is no parameter \"" + name + "\"",
               DidYouMean(name, names));
  }
}

struct Asked {
  std::string path;
  std::optional<std::string> folder;
  int threads = 0;
  OutcomeOptions how;
};

/// Runs the whole fit on a separate thread. Returns null if `said` has errors.
std::shared_ptr<Fitted> Search(const Asked& asked, const Overrides& overrides,
                               const std::atomic<bool>& stop, Diagnostics& said) {
  const std::string file = InputPath(asked.path, {"fit"}, said);
  if (!said.ok()) return nullptr;
  const auto spec = LoadFit(file, overrides, said);
  if (!spec) return nullptr;
  std::unique_ptr<FolderLock> lock;
  IdentifyOptions options;
  options.threads = asked.threads;
  options.stop = &stop;
  if (asked.folder) {
    lock = FolderLock::Take(*asked.folder, said);
    if (!lock) return nullptr;
    options.memory_file = (std::filesystem::path(*asked.folder) / "fit.sqlite").string();
  }
  auto fitted = std::make_shared<Fitted>();
  fitted->fit = Identification::Make(*spec, options, said);
  if (!fitted->fit) return nullptr;
  const auto unreadable = [&] {
    const std::string why = fitted->fit->input_error();
    if (!why.empty()) said.Error("fit.failed", {}, why);
    return !why.empty();
  };
  CheckProfiles(*fitted->fit, asked.how.profiles, said);
  const bool depends = CheckDependence(*fitted->fit, said);
  if (unreadable() || !depends || !said.ok()) return nullptr;
  fitted->outcome = RunFit(*fitted->fit, asked.how);
  if (unreadable()) return nullptr;
  if (const std::string why = fitted->fit->memory_error(); !why.empty()) {
    said.Error("fit.memory_not_writable", {options.memory_file}, "cannot write: " + why);
  }
  if (!fitted->outcome.interrupted && !fitted->outcome.why.empty()) {
    said.Error("fit.failed", {asked.path}, "the fit failed: " + fitted->outcome.why);
  }
  return fitted;
}

std::shared_ptr<Fitted> Fit(const std::string& path, const std::optional<std::string>& folder,
                            int threads, const std::vector<std::string>& profiles,
                            const py::object& design, const py::object& progress,
                            const py::kwargs& set) {
  Threads(threads);
  CallableOrNone(progress, "progress");
  const Overrides overrides = OverridesOf(set);
  std::mutex mutex;
  IdentifyProgress now;
  std::int64_t told = -1;
  Asked asked{path, folder, threads, {}};
  asked.how.profiles = profiles;
  asked.how.design = Flag(design, "design");
  asked.how.progress = [&](const IdentifyProgress& p) {
    const std::lock_guard lock(mutex);
    now = p;
  };
  Diagnostics said;
  std::shared_ptr<Fitted> fitted;
  Interruptible(
      [&](const std::atomic<bool>& stop) {
        asked.how.stop = &stop;
        fitted = Search(asked, overrides, stop, said);
      },
      [&] {
        IdentifyProgress p;
        {
          const std::lock_guard lock(mutex);
          p = now;
        }
        if (progress.is_none() || p.computed == told || p.iterations == 0) return;
        told = p.computed;
        CallPython(progress, p.what, p.iterations, p.chi2);
      });
  Tell(said);
  return fitted;
}

/// Returns an n x n matrix from numbers stored row by row; empty if there are none.
py::array Square(const std::vector<double>& numbers, std::size_t n) {
  const auto side = static_cast<py::ssize_t>(numbers.size() == n * n ? n : 0);
  return Rows<double>({side, side}, numbers.data());
}

}  // namespace

void AddFits(py::module_& module) {
  py::class_<Fitted, std::shared_ptr<Fitted>>(
      module, "Fitted",
      "Result of `taut.fit`: estimated parameters with their uncertainty, and the verdict.")
      .def_property_readonly(
          "values",
          [](const Fitted& f) {
            py::dict values;
            const auto& parameters = f.fit->train().parameters;
            for (std::size_t i = 0; i < parameters.size(); ++i) {
              values[py::str(parameters[i].name)] = f.outcome.fit.values[i];
            }
            return values;
          },
          "Dict of the estimates, each in the unit of its parameter.")
      .def_property_readonly(
          "standard_errors",
          [](const Fitted& f) {
            py::dict errors;
            const auto& parameters = f.fit->train().parameters;
            for (std::size_t i = 0; i < parameters.size(); ++i) {
              errors[py::str(parameters[i].name)] =
                  f.outcome.verdict.identifiability.parameters[i].error();
            }
            return errors;
          },
          "Dict of the standard errors by parameter: the larger of the error from derivatives and "
          "the error from omitted groups; inf if the data do not determine the parameter.")
      .def_property_readonly(
          "covariance",
          [](const Fitted& f) {
            return Square(f.outcome.verdict.identifiability.covariance,
                          f.fit->train().parameters.size());
          },
          "(parameters, parameters) float64: covariance matrix in the parameters' units, in the "
          "order of `values`; inf for parameters that the data do not determine.")
      .def_property_readonly(
          "correlation",
          [](const Fitted& f) {
            return Square(f.outcome.verdict.identifiability.correlation,
                          f.fit->train().parameters.size());
          },
          "(parameters, parameters) float64: correlation matrix; 0 for parameters without a finite "
          "error.")
      .def_property_readonly(
          "good",
          [](const Fitted& f) { return f.outcome.verdict.judgement == FitJudgement::kGood; },
          "Whether the fit is accepted, as in the exit status of `taut fit`.")
      .def_property_readonly(
          "sentences", [](const Fitted& f) { return f.outcome.verdict.sentences; },
          "Verdict in sentences: the judgement first, then the reasons.")
      .def_property_readonly(
          "json", [](const Fitted& f) { return OutcomeJson(*f.fit, f.outcome); },
          "All results as JSON text, as in the summary.json of `taut fit`.")
      .def_property_readonly(
          "text", [](const Fitted& f) { return OutcomeText(*f.fit, f.outcome); },
          "The tables printed by `taut fit`.")
      .def("experiment", &ExperimentOf, py::arg("number") = 0,
           "Returns an experiment of the fit with the estimated parameters, for `taut.run`.")
      .def("__repr__", [](const Fitted& f) {
        return "<taut.Fitted \"" + f.fit->spec().name + "\": " +
               (f.outcome.verdict.sentences.empty() ? "" : f.outcome.verdict.sentences[0]) + ">";
      });

  module.def("fit", &Fit, py::arg("fit"), py::arg("folder") = py::none(), py::arg("threads") = 0,
             py::arg("profiles") = std::vector<std::string>{}, py::arg("design") = false,
             py::arg("progress") = py::none(),
             "Estimates parameters of models and experiments from measurements, bit-identically to "
             "`taut fit`. `folder`: stores intermediate results, so that the same call resumes "
             "after Ctrl-C; None: stores nothing. `profiles`: names of parameters for profile "
             "likelihoods, or \"*\" for all. Keyword arguments set named parameters. `threads`: "
             "number of threads; 0: one per core. `progress(what, iterations, chi2)` is called a "
             "few times per second. Returns a `taut.Fitted`, also for a rejected fit: see `good`.");
}

}  // namespace taut::python
