// Environments for reinforcement learning, beneath taut.gym.
#include <pybind11/functional.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "owner.h"
#include "taut/env.h"
#include "text.h"
#include "worlds.h"

namespace taut::python {
namespace {

using Bytes = py::array_t<std::uint8_t, py::array::c_style>;

const std::pair<const char*, Autoreset> kAutoresets[] = {{"next_step", Autoreset::kNextStep},
                                                         {"same_step", Autoreset::kSameStep},
                                                         {"disabled", Autoreset::kDisabled}};
const std::pair<const char*, EpisodeEnd> kEnds[] = {
    {"none", EpisodeEnd::kNone},          {"time", EpisodeEnd::kTime},
    {"fell", EpisodeEnd::kFell},          {"not_finite", EpisodeEnd::kNotFinite},
    {"too_fast", EpisodeEnd::kTooFast},   {"fell_off", EpisodeEnd::kFellOff},
    {"too_tense", EpisodeEnd::kTooTense}, {"wrong_action", EpisodeEnd::kWrongAction},
    {"called", EpisodeEnd::kCalled}};

template <class T>
std::span<T> Span(Rows<T>& a) {
  return {a.mutable_data(), static_cast<std::size_t>(a.size())};
}
template <class T>
std::span<const T> ConstSpan(const Rows<T>& a) {
  return {a.data(), static_cast<std::size_t>(a.size())};
}

class Environments : public OwnedWorlds<Env> {
 public:
  Environments(const ExperimentSpec& experiment, int worlds, int threads,
               const std::optional<std::string>& simd, const std::string& autoreset,
               const py::object& randomise, const py::object& seed, int own_observations,
               const py::object& observe, const py::object& judge)
      : observe_(CallableOrNone(observe, "observe")), judge_(CallableOrNone(judge, "judge")) {
    CheckWorlds(worlds);
    if (own_observations < 0)
      throw py::value_error(
          fmt::format("own_observations: {}; expected 0 or more", own_observations));
    EnvOptions options;
    options.worlds = worlds;
    options.threads = Threads(threads);
    options.simd = SimdOf(simd);
    options.randomise = Flag(randomise, "randomise");
    if (!seed.is_none()) options.seed = Seed(seed);
    options.own_observations = own_observations;
    bool known = false;
    for (const auto& [name, mode] : kAutoresets) {
      if (autoreset == name) options.autoreset = mode, known = true;
    }
    if (!known)
      throw py::value_error("autoreset: \"" + autoreset +
                            "\"; expected next_step, same_step or disabled");
    same_step_ = options.autoreset == Autoreset::kSameStep;
    if (!observe.is_none())
      options.observe = [this](const EnvView& v) { Call(observe_, v, false); };
    options.keep_going = [this] { return KeepGoing(); };
    if (!judge.is_none()) options.judge = [this](const EnvView& v) { Call(judge_, v, true); };
    Diagnostics said;
    std::unique_ptr<Env> env;
    {
      const Released others;
      env = Env::Create(experiment, options, said);
    }
    Rethrow();
    if (!env) Refuse(said);
    Tell(said);
    owned_ = std::make_unique<Owner<Env>>(std::move(env), "these environments were");
  }

  py::ssize_t actions() const { return static_cast<py::ssize_t>(peek().action_channels().size()); }
  py::ssize_t observations() const {
    return static_cast<py::ssize_t>(peek().observation_channels().size());
  }

  template <class T>
  void Reset(const py::object& seeds, const py::object& mask, const py::object& out) {
    Rows<T> observations_out = Exactly<T>(out, {worlds(), observations()}, "observations", true);
    Rows<std::uint64_t> seed_of;
    Bytes chosen;
    if (!seeds.is_none()) seed_of = Exactly<std::uint64_t>(seeds, {worlds()}, "seeds", false);
    if (!mask.is_none()) chosen = Exactly<std::uint8_t>(mask, {worlds()}, "mask", false);
    Diagnostics said;
    const auto seed_span = seeds.is_none() ? std::span<const std::uint64_t>() : ConstSpan(seed_of);
    const auto mask_span = mask.is_none() ? std::span<const std::uint8_t>() : ConstSpan(chosen);
    const auto rows = Span(observations_out);
    const bool good = With([&](Env& env) { return env.Reset(seed_span, mask_span, rows, said); });
    Rethrow();
    if (!good) Refuse(said);
    stopped_ = false;
    Tell(said);
  }

  template <class T>
  void Step(const py::object& actions_in, const py::object& observations_out,
            const py::object& rewards_out, const py::object& terminated_out,
            const py::object& truncated_out, const py::object& final_out) {
    const Rows<T> act = Exactly<T>(actions_in, {worlds(), actions()}, "actions", false);
    Rows<T> seen = Exactly<T>(observations_out, {worlds(), observations()}, "observations", true);
    Rows<double> rewards = Exactly<double>(rewards_out, {worlds()}, "rewards", true);
    Bytes over = Exactly<std::uint8_t>(terminated_out, {worlds()}, "terminated", true);
    Bytes cut = Exactly<std::uint8_t>(truncated_out, {worlds()}, "truncated", true);
    EnvStep<T> step{Span(seen), Span(rewards), Span(over), Span(cut), {}};
    Rows<T> last;
    if (same_step_) {
      last = Exactly<T>(final_out, {worlds(), observations()}, "final_observations", true);
      step.final_observations = Span(last);
    }
    const auto act_span = ConstSpan(act);
    const bool done = With([&](Env& env) { return env.Step(act_span, step); });
    Rethrow();
    if (!done) StepStopped();
  }

  std::vector<std::uint8_t> Save(int world) {
    if (stopped_) StepStopped();
    return With([&](Env& env) { return env.Save(world); });
  }

  /// Returns seeds, steps, rewards and ends of the present or of the last episodes.
  py::tuple Episodes(bool last) {
    const py::ssize_t n = worlds();
    py::array_t<std::uint64_t> seeds(n);
    py::array_t<std::int64_t> steps(n);
    py::array_t<double> rewards(n);
    py::array_t<std::uint8_t> ends(n);
    auto* seed = seeds.mutable_data();
    auto* count = steps.mutable_data();
    auto* reward = rewards.mutable_data();
    auto* end = ends.mutable_data();
    Look([&](const Env& env) {
      for (int w = 0; w < static_cast<int>(n); ++w) {
        const EpisodeState e = last ? env.Last(w) : env.Episode(w);
        seed[w] = e.seed, count[w] = e.steps, reward[w] = e.reward;
        end[w] = static_cast<std::uint8_t>(e.end);
      }
    });
    return py::make_tuple(seeds, steps, rewards, ends);
  }

 private:
  /// Calls f(rows, observations), or `judge` with five arguments, with copies of the arrays, which
  /// callbacks may keep. Copies writable arrays back. Exceptions of f are raised by the call that
  /// led to it.
  void Call(const py::object& f, const EnvView& view, bool judges) {
    const Acquired mine;
    if (raised_) return;
    try {
      if (!view.observations_f32.empty()) {
        Call(f, view, view.observations_f32, view.actions_f32, judges);
      } else {
        Call(f, view, view.observations_f64, view.actions_f64, judges);
      }
    } catch (const abi::__forced_unwind&) {  // end of the thread, not an exception of f
      EndOfProgram::Sleep();
    } catch (...) {
      raised_ = std::current_exception();
    }
    // A child of fork() within f lacks the threads that the step needs.
    if (owned_->Forked()) {
      Rethrow();
      owned_->CheckProcess();
    }
  }
  template <class T>
  static void Call(const py::object& f, const EnvView& view, std::span<T> observations,
                   std::span<const T> actions, bool judges) {
    const auto worlds = static_cast<std::size_t>(view.env.worlds());
    const py::array_t<std::uint8_t> rows = CopyOf(view.rows);
    const py::array_t<T> seen = CopyOf<T>(observations, worlds);
    if (!judges) {
      CallPython(f, rows, seen);
      return TakeBack(seen, observations, "observations");
    }
    const py::array_t<double> rewards = CopyOf<double>(view.rewards);
    const py::array_t<std::uint8_t> over = CopyOf<std::uint8_t>(view.terminated);
    CallPython(f, rows, seen, CopyOf(actions, worlds), rewards, over);
    TakeBack(seen, observations, "observations");
    TakeBack(rewards, view.rewards, "rewards");
    TakeBack(over, view.terminated, "terminated");
  }
  template <class T>
  static py::array_t<T> CopyOf(std::span<const T> from) {  // (worlds,)
    return py::array_t<T>(static_cast<py::ssize_t>(from.size()), from.data());
  }
  template <class T>
  static py::array_t<T> CopyOf(std::span<const T> from, std::size_t worlds) {  // (worlds, n)
    const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(worlds),
                                         static_cast<py::ssize_t>(from.size() / worlds)};
    return py::array_t<T>(shape, from.data());
  }
  /// Checks the array, because numpy lets a callback change its size or data type.
  template <class T>
  static void TakeBack(const py::array_t<T>& from, std::span<T> to, const char* what) {
    if (!py::isinstance<Rows<T>>(from) || static_cast<std::size_t>(from.size()) != to.size()) {
      throw py::value_error(
          fmt::format("{}: the callback has changed the shape or data type of its array", what));
    }
    std::copy_n(from.data(), to.size(), to.data());
  }
  /// Returns false if a signal handler raised an exception (Ctrl-C), which `Rethrow` raises.
  bool KeepGoing() {
    const Acquired mine;
    if (SignalRaised()) raised_ = std::make_exception_ptr(py::error_already_set());
    stopped_ = stopped_ || raised_;
    return !raised_;
  }
  [[noreturn]] static void StepStopped() {
    throw std::runtime_error("the last step was interrupted; reset all worlds");
  }
  void Rethrow() {
    if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
  }

  const py::object observe_, judge_;
  std::exception_ptr raised_;
  bool same_step_ = false;
  bool stopped_ = false;  ///< The last step was interrupted.
};

}  // namespace

void AddEnvironments(py::module_& module) {
  using E = Environments;
  py::class_<E, std::shared_ptr<E>> type(module, "Environments",
                                         "Array interface beneath the classes of taut.gym.");
  type.def(py::init<const ExperimentSpec&, int, int, const std::optional<std::string>&,
                    const std::string&, const py::object&, const py::object&, int,
                    const py::object&, const py::object&>(),
           py::arg("experiment"), py::arg("worlds") = 1, py::arg("threads") = 1,
           py::arg("simd") = py::none(), py::arg("autoreset") = "next_step",
           py::arg("randomise") = true, py::arg("seed") = py::none(),
           py::arg("own_observations") = 0, py::arg("observe") = py::none(),
           py::arg("judge") = py::none());
  type.def_property_readonly("worlds", [](const E& e) { return e.worlds(); });
  type.def_property_readonly("action_channels",
                             [](const E& e) { return NamesOf(e.peek().action_channels()); });
  type.def_property_readonly("action_scales", [](const E& e) { return e.peek().action_scales(); });
  type.def_property_readonly("observation_channels",
                             [](const E& e) { return NamesOf(e.peek().observation_channels()); });
  type.def_property_readonly("period_s", [](const E& e) { return e.peek().period_s(); });
  type.def_property_readonly("episode_steps", [](const E& e) { return e.peek().episode_steps(); });
  type.def("reset_f32", &E::Reset<float>);
  type.def("reset_f64", &E::Reset<double>);
  type.def("step_f32", &E::Step<float>);
  type.def("step_f64", &E::Step<double>);
  type.def("episodes", &E::Episodes, py::arg("last") = false);
  type.def("experiment", [](E& e, py::ssize_t world) {
    const int w = e.World(world);
    return std::make_shared<ExperimentSpec>(
        e.Look([&](const Env& env) { return env.Experiment(w); }));
  });
  type.def("hash", [](E& e, py::ssize_t world) {
    const int w = e.World(world);
    return e.Look([&](const Env& env) { return env.Hash(w); });
  });
  type.def(
      "save",
      [](E& e, py::ssize_t world) {
        const int w = e.World(world);
        return BytesFrom(e.Save(w));
      },
      py::arg("world") = 0);
  type.def(
      "restore",
      [](E& e, const py::bytes& snapshot, py::ssize_t world) {
        const int w = e.World(world);
        const auto bytes = BytesOf(snapshot);
        Diagnostics said;
        if (!e.With([&](Env& env) { return env.Restore(w, bytes, said); })) Refuse(said);
      },
      py::arg("snapshot"), py::arg("world") = 0);
  type.def("time_s", [](E& e, py::ssize_t world) {
    const int w = e.World(world);
    return e.Look([&](const Env& env) { return env.Time(w); });
  });
  py::list ends;
  for (const auto& [name, end] : kEnds) ends.append(py::make_tuple(name, static_cast<int>(end)));
  module.attr("episode_ends") = ends;
}

}  // namespace taut::python
