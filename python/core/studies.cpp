// `taut.learn` and `taut.read_study`: searches, run, resumed or read.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "interruptible.h"
#include "taut/learn.h"
#include "taut/start.h"
#include "text.h"

namespace taut::python {
namespace {

using Found = std::shared_ptr<StudyResult>;

Found FoundIn(const std::string& folder, bool skip_damaged) {
  Diagnostics said;
  std::optional<StudyResult> result;
  {
    const Released others;
    result = ReadStudyFolder(folder, said, skip_damaged);
  }
  for (const std::string& skipped : result ? result->skipped : std::vector<std::string>{}) {
    said.Warning("study.skipped_rows", {folder}, skipped);
  }
  Tell(said);
  return std::make_shared<StudyResult>(std::move(*result));
}

/// Progress of the study, written by its threads and read by Python's.
class Progress {
 public:
  void Set(const LearnProgress& now) {
    const std::lock_guard lock(mutex_);
    now_ = now;
  }
  /// Calls the Python function if there is progress.
  void Tell(const py::object& progress) {
    LearnProgress now;
    {
      const std::lock_guard lock(mutex_);
      now = now_;
    }
    if (progress.is_none() || now.evaluations == told_) return;
    told_ = now.evaluations;
    CallPython(progress, now.evaluations, now.budget,
               now.best_score ? py::object(py::float_(*now.best_score)) : py::object(py::none()));
  }

 private:
  std::mutex mutex_;
  LearnProgress now_;
  std::int64_t told_ = 0;
};

Found Learn(const std::string& path, const std::optional<std::string>& folder, int threads,
            const py::object& progress, const py::object& skip_damaged_given,
            const py::kwargs& set) {
  Threads(threads);
  CallableOrNone(progress, "progress");
  const bool skip_damaged = Flag(skip_damaged_given, "skip_damaged");
  const Overrides overrides = OverridesOf(set);
  Diagnostics said;
  std::optional<StudySpec> study;
  {
    const Released others;
    const std::string file = InputPath(path, {"study"}, said);
    if (said.ok()) study = LoadStudy(file, overrides, said);
    if (study) CheckStart(study->experiment.robot, study->experiment.start, said);
  }
  Tell(said);
  LearnOptions options;
  options.folder = folder.value_or((std::filesystem::path("runs") / study->name).string());
  options.skip_damaged = skip_damaged;
  Progress state;
  options.progress = [&](const LearnProgress& now) { state.Set(now); };
  LearnSummary summary;
  Diagnostics later;
  Interruptible(
      [&](const std::atomic<bool>& stop) {
        options.stop = &stop;
        if (const auto evaluator = MakeEvaluator(*study, threads, &stop, later)) {
          summary = RunStudy(*study, *evaluator, options, later);
        }
      },
      [&] { state.Tell(progress); });
  Tell(later);
  return FoundIn(options.folder, skip_damaged);
}

/// Returns the evaluation of an index; the best for None.
const Evaluation& EvaluationOf(const StudyResult& r, std::optional<py::ssize_t> which) {
  if (which) {
    const int count = static_cast<int>(r.evaluations.size());
    return r.evaluations[static_cast<std::size_t>(Index(*which, count, "evaluation"))];
  }
  if (const Evaluation* best = r.best()) return *best;
  throw py::value_error("there is no best evaluation: all evaluations failed");
}

}  // namespace

void AddStudies(py::module_& module) {
  py::class_<StudyResult, Found>(module, "Study",
                                 "Results in a study's folder, from `taut.learn` or "
                                 "`taut.read_study`. Rows are evaluations, in their order.")
      .def_readonly("name", &StudyResult::name)
      .def_property_readonly(
          "parameters", [](const StudyResult& r) { return NamesOf(r.parameters); },
          "Names of the varied parameters.")
      .def_property_readonly(
          "units",
          [](const StudyResult& r) {
            py::dict units;
            for (const StudyParameter& p : r.parameters) units[py::str(p.name)] = p.unit;
            return units;
          },
          "Dict of the units by parameter.")
      .def_property_readonly(
          "values",
          [](const StudyResult& r) {
            const auto columns = static_cast<py::ssize_t>(r.parameters.size());
            Rows<double> a({static_cast<py::ssize_t>(r.evaluations.size()), columns});
            double* to = a.mutable_data();
            for (const Evaluation& e : r.evaluations) {
              to = std::copy(e.values.begin(), e.values.end(), to);
            }
            return a;
          },
          "(evaluations, parameters) float64: values in their units. A copy.")
      .def_property_readonly(
          "scores",
          [](const StudyResult& r) {
            std::vector<double> scores;
            for (const Evaluation& e : r.evaluations) scores.push_back(e.score);
            return ArrayOf(scores);
          },
          "(evaluations,) float64: scores, more is better; NaN: the evaluation failed.")
      .def_property_readonly(
          "failed",
          [](const StudyResult& r) {
            py::list failed;
            for (const Evaluation& e : r.evaluations) failed.append(e.failed);
            return failed;
          },
          "Reason of failure per evaluation; empty for a success.")
      .def_property_readonly(
          "best",
          [](const StudyResult& r) {
            py::dict best;
            const Evaluation& e = EvaluationOf(r, std::nullopt);
            for (std::size_t i = 0; i < r.parameters.size(); ++i) {
              best[py::str(r.parameters[i].name)] = e.values[i];
            }
            return best;
          },
          "Dict of the best parameters. Raises ValueError if every evaluation failed.")
      .def_property_readonly(
          "best_score", [](const StudyResult& r) { return EvaluationOf(r, std::nullopt).score; })
      .def(
          "experiment",
          [](const StudyResult& r, std::optional<py::ssize_t> evaluation) {
            return std::make_shared<ExperimentSpec>(
                r.ExperimentWith(EvaluationOf(r, evaluation).values));
          },
          py::arg("evaluation") = py::none(),
          "Returns the experiment with the parameters of an evaluation, given by index; "
          "None: the best evaluation. For `taut.run`.")
      .def("__len__", [](const StudyResult& r) { return r.evaluations.size(); });

  module.def(
      "learn", &Learn, py::arg("study"), py::arg("folder") = py::none(), py::arg("threads") = 0,
      py::arg("progress") = py::none(), py::arg("skip_damaged") = false,
      "Searches for the best parameters, bit-identically to `taut learn`, or resumes an "
      "interrupted search. Results are written to `folder` at once (None: runs/NAME). Keyword "
      "arguments set named parameters of the study, its experiment or model. `threads`: number of "
      "threads; 0: one per core. `progress(evaluations, budget, best_score)` is called a few times "
      "per second. Returns a `taut.Study`. After Ctrl-C the same call resumes.");
  module.def(
      "read_study",
      [](const std::string& folder, const py::object& skip_damaged) {
        return FoundIn(folder, Flag(skip_damaged, "skip_damaged"));
      },
      py::arg("folder"), py::arg("skip_damaged") = false,
      "Reads the results in a study's folder. Returns a `taut.Study`.");
}

}  // namespace taut::python
