// `taut.rollout` and `taut.tunables`: variants of an experiment, run in parallel and scored,
// without traces.
#include "taut/rollout.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "interruptible.h"
#include "taut/learn.h"
#include "taut/start.h"
#include "taut/study.h"
#include "text.h"
#include "variants.h"

namespace taut::python {
namespace {

/// Returns the rows of `taut.tunables`: name, unit, value, least, greatest.
py::list TunablesOf(const ExperimentSpec& experiment) {
  std::vector<ControllerSpec> controllers = experiment.controllers;
  std::vector<ScaleSpec> scales = TunableScales(experiment.robot);
  py::list all;
  for (const Tunable& t : FindTunables(controllers, scales, experiment.robot)) {
    all.append(py::make_tuple(t.name, t.unit, *t.value, t.min, t.max));
  }
  return all;
}

/// Returns the columns by name, from which taut/_results.py makes one structured array.
py::dict Columns(const std::vector<RolloutResult>& results) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto column = [&](auto of) {
    std::vector<double> numbers;
    for (const RolloutResult& r : results) numbers.push_back(of(r));
    return ArrayOf(numbers);
  };
  py::list failed, hashes;
  for (const RolloutResult& r : results) failed.append(r.failed), hashes.append(r.state_hash);
  py::dict all;
  all["score"] = column([](const RolloutResult& r) { return r.score; });
  all["failed"] = failed;
  all["distance_m"] = column([](const RolloutResult& r) { return r.distance_m; });
  all["along_m"] = column([](const RolloutResult& r) { return r.along_m; });
  all["energy_j"] = column([](const RolloutResult& r) { return r.energy_j; });
  all["max_tension_n"] = column([](const RolloutResult& r) { return r.max_tension_n; });
  all["tracking_n"] = column([](const RolloutResult& r) { return r.tracking_n; });
  all["fell_s"] = column([&](const RolloutResult& r) { return r.fell_s.value_or(kNone); });
  all["state_hash"] = hashes;
  return all;
}

py::dict Rollout(const ExperimentSpec& experiment, const std::string& objective_text,
                 const std::vector<GivenVariant>& given, int threads,
                 const std::optional<std::string>& simd, const py::object& progress) {
  Threads(threads);
  CallableOrNone(progress, "progress");
  RolloutOptions options;
  options.threads = threads;
  options.simd = SimdOf(simd);
  Diagnostics said, of_objective;
  const auto objective = ReadObjective(objective_text, "", experiment, of_objective);
  // Omits the position, which refers to a text generated from the dict.
  for (const Diagnostic& d : of_objective.items()) said.AddError({{}, d.what, d.hint, d.id});
  const std::vector<RolloutWorld> worlds = VariantsOf(experiment, given, "worlds", said);
  CheckStart(experiment.robot, experiment.start, said);
  Tell(said);
  std::vector<RolloutResult> results;
  std::atomic<std::size_t> done{0};
  std::size_t told = 0;
  Interruptible(
      [&](const std::atomic<bool>& stop) {
        options.stop = &stop;
        if (const auto rollouts = Rollouts::Create(experiment, *objective, options, said)) {
          results = rollouts->Run(worlds, [&](std::size_t, const RolloutResult&) {
            ++done;
            return true;
          });
        }
      },
      [&] {
        const std::size_t now = done;
        if (!progress.is_none() && now != told) CallPython(progress, told = now, worlds.size());
      });
  Tell(said);
  return Columns(results);
}

}  // namespace

std::vector<RolloutWorld> VariantsOf(const ExperimentSpec& experiment,
                                     const std::vector<GivenVariant>& given,
                                     const std::string& what, Diagnostics& said) {
  std::vector<ControllerSpec> controllers = experiment.controllers;
  std::vector<ScaleSpec> scales = TunableScales(experiment.robot);
  const std::vector<Tunable> tunables = FindTunables(controllers, scales, experiment.robot);
  const std::vector<std::string> names = NamesOf(tunables);
  StudySpec study;
  study.experiment = experiment;
  std::vector<RolloutWorld> worlds;
  for (std::size_t w = 0; w < given.size(); ++w) {
    const auto& [seed, numbers] = given[w];
    const std::string where = what + "[" + std::to_string(w) + "]: ";
    std::vector<double> values;
    study.parameters.clear();
    for (const auto& [name, value] : numbers) {
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) {
        const std::string_view close = ClosestMatch(name, names);
        said.Error("tunable.unknown_name", {}, where + "there is no parameter \"" + name + "\"",
                   close.empty() ? "taut.tunables(experiment) lists all names"
                                 : "did you mean \"" + std::string(close) + "\"?");
        continue;
      }
      const Tunable& tunable = tunables[static_cast<std::size_t>(found - names.begin())];
      if (!std::isfinite(value) || value < tunable.min || value > tunable.max) {
        said.Error("tunable.out_of_range", {},
                   fmt::format("{}{} must be a number within {}..{} {}, got {}", where, name,
                               tunable.min, tunable.max, tunable.unit, value));
        continue;
      }
      study.parameters.push_back({name, tunable.unit, {name}, tunable.min, tunable.max, false});
      values.push_back(value);
    }
    worlds.push_back(NominalWorld(study, values));
    if (seed) worlds.back().seed = *seed;
  }
  return worlds;
}

void AddRollouts(py::module_& module) {
  module.def("tunables", &TunablesOf, py::arg("experiment"));
  module.def("rollout", &Rollout, py::arg("experiment"), py::arg("objective"), py::arg("worlds"),
             py::arg("threads"), py::arg("simd"), py::arg("progress"));
}

}  // namespace taut::python
