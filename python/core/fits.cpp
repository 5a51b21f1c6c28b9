// Numbers of models and experiments out of measurements, and what they are worth.
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

/// A fit that is done. `fit` computes no more: what could stop it is gone.
struct Fitted {
  std::unique_ptr<Identification> fit;
  FitOutcome outcome;
};

/// The experiment `number` with what was found; as the file that `taut fit` writes.
std::shared_ptr<ExperimentSpec> ExperimentOf(const Fitted& f, py::ssize_t number) {
  const auto& all = f.fit->spec().experiments;
  const auto e =
      static_cast<std::size_t>(Index(number, static_cast<int>(all.size()), "experiment"));
  Overrides set = all[e].set;  // of two of a name the later one counts
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

/// Complaints about names that no parameter has.
void CheckProfiles(const Identification& fit, const std::vector<std::string>& profiles,
                   Diagnostics& said) {
  const std::vector<std::string> names = NamesOf(fit.train().parameters);
  for (const std::string& name : profiles) {
    if (name.find('*') != name.npos || std::find(names.begin(), names.end(), name) != names.end()) {
      continue;
    }
    said.Error({}, "profiles: nothing is called \"" + name + "\"", DidYouMean(name, names));
  }
}

struct Asked {
  std::string path;
  std::optional<std::string> folder;
  int threads = 0;
  OutcomeOptions how;
};

/// All of it, on a thread of its own. Nothing where `said` has errors.
std::shared_ptr<Fitted> Search(const Asked& asked, const Overrides& overrides,
                               const std::atomic<bool>& stop, Diagnostics& said) {
  const auto spec = LoadFit(InputPath(asked.path), overrides, said);
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
    if (!why.empty()) said.Error({}, why);
    return !why.empty();
  };
  CheckProfiles(*fitted->fit, asked.how.profiles, said);
  const bool depends = CheckDependence(*fitted->fit, said);
  if (unreadable() || !depends || !said.ok()) return nullptr;
  fitted->outcome = RunFit(*fitted->fit, asked.how);
  if (unreadable()) return nullptr;
  if (const std::string why = fitted->fit->memory_error(); !why.empty()) {
    said.Error({options.memory_file}, "cannot be written: " + why);
  }
  if (!fitted->outcome.interrupted && !fitted->outcome.why.empty()) {
    said.Error({asked.path}, "no fit: " + fitted->outcome.why);
  }
  return fitted;
}

std::shared_ptr<Fitted> Fit(const std::string& path, const std::optional<std::string>& folder,
                            int threads, const std::vector<std::string>& profiles, bool design,
                            const py::object& progress, const py::kwargs& set) {
  Threads(threads);
  const Overrides overrides = OverridesOf(set);
  std::mutex mutex;
  IdentifyProgress now;
  std::int64_t told = -1;
  Asked asked{path, folder, threads, {}};
  asked.how.profiles = profiles;
  asked.how.design = design;
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

/// An n x n matrix that is kept row by row; empty if there is none.
py::array Square(const std::vector<double>& numbers, std::size_t n) {
  const auto side = static_cast<py::ssize_t>(numbers.size() == n * n ? n : 0);
  return Rows<double>({side, side}, numbers.data());
}

}  // namespace

void AddFits(py::module_& module) {
  py::class_<Fitted, std::shared_ptr<Fitted>>(
      module, "Fitted", "What `taut.fit` gives: what was found, and what it is worth.")
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
          "By parameter, in its unit.")
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
          "By parameter: the larger of that by the derivatives and that by groups left out; inf "
          "where data say nothing.")
      .def_property_readonly(
          "covariance",
          [](const Fitted& f) {
            return Square(f.outcome.verdict.identifiability.covariance,
                          f.fit->train().parameters.size());
          },
          "(parameters, parameters) float64, in their units, in the order of `values`; inf where "
          "data say nothing.")
      .def_property_readonly(
          "correlation",
          [](const Fitted& f) {
            return Square(f.outcome.verdict.identifiability.correlation,
                          f.fit->train().parameters.size());
          },
          "(parameters, parameters) float64; 0 with what has no finite error.")
      .def_property_readonly(
          "good",
          [](const Fitted& f) { return f.outcome.verdict.judgement == FitJudgement::kGood; },
          "Whether there is nothing against it: what `taut fit` says by its exit status.")
      .def_property_readonly(
          "sentences", [](const Fitted& f) { return f.outcome.verdict.sentences; },
          "For a reader: the judgement first, then why.")
      .def_property_readonly(
          "json", [](const Fitted& f) { return OutcomeJson(*f.fit, f.outcome); },
          "All there is to say, as `taut fit` writes it into summary.json.")
      .def_property_readonly(
          "text", [](const Fitted& f) { return OutcomeText(*f.fit, f.outcome); },
          "The tables that `taut fit` prints.")
      .def("experiment", &ExperimentOf, py::arg("number") = 0,
           "An experiment of the fit with the parameters that were found, for `taut.run`.")
      .def("__repr__", [](const Fitted& f) {
        return "<taut.Fitted \"" + f.fit->spec().name + "\": " +
               (f.outcome.verdict.sentences.empty() ? "" : f.outcome.verdict.sentences[0]) + ">";
      });

  module.def("fit", &Fit, py::arg("fit"), py::arg("folder") = py::none(), py::arg("threads") = 0,
             py::arg("profiles") = std::vector<std::string>{}, py::arg("design") = false,
             py::arg("progress") = py::none(),
             "Finds numbers of models and experiments from measurements as `taut fit` does, to the "
             "same bits. `folder` keeps what was computed, so that after Ctrl-C the same call goes "
             "on; None keeps nothing. `profiles`: names of parameters, or \"*\". Keyword arguments "
             "set named parameters. `progress(what, iterations, chi2)` is called a few times a "
             "second.");
}

}  // namespace taut::python
