// `taut.Simulation`: experiments with controllers and events, stepped from Python.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "shared_simulation.h"
#include "taut/minimal_experiment.h"
#include "taut/time_limits.h"

namespace taut::python {
namespace {

using S = SharedSimulation;

/// Runs to a time in pieces that take a fraction of a second.
void RunUntil(S& shared, double time_s) {
  if (!std::isfinite(time_s) || time_s > kLongestTime_s) {
    throw py::value_error(
        fmt::format("time_s: {}; expected a finite number up to {:g} [s]", time_s, kLongestTime_s));
  }
  double piece_s = 16 * shared.peek().experiment().step_s;
  const bool viewed = shared.is_viewed();
  const std::chrono::milliseconds shortest{viewed ? 4 : 25}, longest{viewed ? 16 : 100};
  shared.Run([&](Simulation& s) {
    double now_s = time_s;
    for (int w = 0; w < s.worlds(); ++w) now_s = std::min(now_s, s.Time(w));
    if (now_s >= time_s - 1e-9) return false;
    const auto start = std::chrono::steady_clock::now();
    s.RunUntil(std::min(time_s, now_s + piece_s), [&] { return !shared.callbacks()->failed(); });
    const auto took = std::chrono::steady_clock::now() - start;
    if (took < shortest) piece_s *= 2;
    if (took > longest) piece_s /= 2;
    return true;
  });
}

void AddStates(SimulationType& type) {
  type.def(
      "reset",
      [](S& shared, std::optional<py::ssize_t> world) {
        const auto [first, last] = shared.Range(world);
        shared.With([&, from = first, to = last](Simulation& s) {
          for (int w = from; w < to; ++w) s.Reset(w);
        });
        shared.callbacks()->Rethrow();
      },
      py::arg("world") = py::none(),
      "Brings one `world`, or all worlds, back to the start, and removes external forces.");
  type.def(
      "save",
      [](S& shared, py::ssize_t world) {
        const int w = shared.World(world);
        const auto saved = shared.With([&](Simulation& s) { return s.Save(w); });
        shared.callbacks()->Rethrow();
        return BytesFrom(saved);
      },
      py::arg("world") = 0,
      "Returns a world with its clocks, controllers and sensors as bytes. Controllers in Python "
      "need `save(world)` and `restore(world, bytes)`, or `stateless = True`.");
  type.def(
      "restore",
      [](S& shared, const py::bytes& snapshot, std::optional<py::ssize_t> world) {
        const auto [first, last] = shared.Range(world);
        Diagnostics said;
        shared.With([&, from = first, to = last](Simulation& s) {
          for (int w = from; w < to && said.ok() && !shared.callbacks()->failed(); ++w) {
            s.Restore(BytesOf(snapshot), said, w);
          }
        });
        shared.callbacks()->Rethrow();
        Tell(said);
      },
      py::arg("snapshot"), py::arg("world") = py::none(),
      "Restores the result of `save` into one `world`, or into all, bit-identically. Raises "
      "`taut.InputError` for a damaged snapshot or another experiment.");
  type.def(
      "row",
      [](S& shared, py::ssize_t world) {
        const int w = shared.World(world);
        return ArrayOf(shared.Look([&](Simulation& s) { return s.Row(w); }));
      },
      py::arg("world") = 0,
      "(channels,) float64: present values of the `channels` in one `world`.");
  type.def_property_readonly(
      "channels", [](const S& shared) { return NamesOf(shared.peek().channels()); },
      "Names of the channels that the experiment's `record` selects.");
}

}  // namespace

SharedSimulation::SharedSimulation(const ExperimentSpec& experiment, int worlds,
                                   const std::optional<std::vector<GivenVariant>>& given,
                                   int threads, const std::optional<std::string>& simd,
                                   const py::object& controllers)
    : callbacks_(std::make_shared<Callbacks>()) {
  CheckWorlds(worlds);
  Diagnostics said;
  std::vector<RolloutWorld> variants;
  if (given) variants = VariantsOf(experiment, *given, "variants", said);
  Tell(said);
  SimulationOptions options;
  options.worlds = worlds;
  options.variants = variants;
  options.threads = Threads(threads);
  options.simd = SimdOf(simd);
  options.extensions = ExtensionsOf(controllers, experiment.robot, callbacks_);
  if (callbacks_->is_used && threads != 1) {
    throw py::value_error(fmt::format(
        "threads: {}; controllers in Python run on one thread: use threads=1", threads));
  }
  bool stopped = false;
  Signals signals;
  options.keep_going = [&] { return !(stopped = stopped || signals.Raised()); };
  std::unique_ptr<Simulation> simulation;
  {
    const Released others;
    simulation = Simulation::Create(experiment, options, said);
  }
  if (stopped) throw py::error_already_set();
  callbacks_->Rethrow();
  if (!simulation) Refuse(said);
  Tell(said);
  owned_ = std::make_unique<Owner<Simulation>>(std::move(simulation), "this simulation was");
}

void AddSimulation(py::module_& module) {
  SimulationType type(module, "Simulation");
  type.def(py::init([](const ExperimentSpec& experiment, int worlds,
                       const std::optional<std::vector<GivenVariant>>& variants, int threads,
                       const std::optional<std::string>& simd, const py::object& controllers) {
             return std::make_shared<S>(experiment, worlds, variants, threads, simd, controllers);
           }),
           py::arg("experiment"), py::arg("worlds"), py::arg("variants"), py::arg("threads"),
           py::arg("simd"), py::arg("controllers"));
  type.def(py::init([](const RobotSpec& robot, int worlds,
                       const std::optional<std::vector<GivenVariant>>& variants, int threads,
                       const std::optional<std::string>& simd, const py::object& controllers) {
             return std::make_shared<S>(MinimalExperiment(robot, StartKind::kAsDescribed), worlds,
                                        variants, threads, simd, controllers);
           }),
           py::arg("robot"), py::arg("worlds"), py::arg("variants"), py::arg("threads"),
           py::arg("simd"), py::arg("controllers"));
  type.def_property_readonly("worlds", [](const S& of) { return of.worlds(); });
  type.def_property_readonly("bodies", [](const S& s) { return NamesOf(s.def().bodies); });
  type.def_property_readonly("nodes", [](const S& s) { return NamesOf(s.def().nodes); });
  type.def_property_readonly("cables", [](const S& s) { return NamesOf(s.def().cables); });
  type.def_property_readonly("joints", [](const S& s) { return NamesOf(s.def().joints); });
  type.def_property_readonly(
      "experiment",
      [](const S& s) { return std::make_shared<ExperimentSpec>(s.peek().experiment()); },
      "Copy of the experiment.");
  type.def(
      "step",
      [](S& shared, int count) {
        if (count < 0) throw py::value_error(fmt::format("count: {}; expected 0 or more", count));
        shared.Run([&](Simulation& s) {
          if (count-- <= 0) return false;
          s.Step();
          return true;
        });
      },
      py::arg("count") = 1,
      "Advances every world by `count` steps, which end at the ticks of controllers and sensors. "
      "Other Python threads run meanwhile; Ctrl-C ends the call between two steps.");
  type.def(
      "run_until", &RunUntil, py::arg("time_s"),
      "Advances each world until its time is at least `time_s`; it may stop up to one step later. "
      "Worlds that have reached this time do not advance. Other Python threads run meanwhile; "
      "Ctrl-C ends the call.");
  AddReadings(type);
  AddCommands(type);
  AddStates(type);
}

}  // namespace taut::python
