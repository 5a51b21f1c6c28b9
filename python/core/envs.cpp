// Environments for learners, under taut.gym.
#include <pybind11/functional.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "owner.h"
#include "taut/env.h"
#include "text.h"

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

class Environments {
 public:
  Environments(const ExperimentSpec& experiment, int worlds, int threads,
               const std::optional<std::string>& simd, const std::string& autoreset, bool randomise,
               std::optional<std::uint64_t> seed, int own_observations, const py::object& observe,
               const py::object& judge)
      : observe_(observe), judge_(judge) {
    if (worlds < 1) throw py::value_error("worlds: at least 1");
    if (threads < 0) throw py::value_error("threads: 0 is one a core");
    if (own_observations < 0) throw py::value_error("own_observations: 0 or more");
    EnvOptions options;
    options.worlds = worlds;
    options.threads = threads;
    options.simd = SimdOf(simd);
    options.randomise = randomise;
    options.seed = seed;
    options.own_observations = own_observations;
    bool known = false;
    for (const auto& [name, mode] : kAutoresets) {
      if (autoreset == name) options.autoreset = mode, known = true;
    }
    if (!known) throw py::value_error("autoreset: next_step, same_step or disabled");
    same_step_ = options.autoreset == Autoreset::kSameStep;
    if (!observe.is_none())
      options.observe = [this](const EnvView& v) { Call(observe_, v, false); };
    if (!judge.is_none()) options.judge = [this](const EnvView& v) { Call(judge_, v, true); };
    Diagnostics said;
    std::unique_ptr<Env> env;
    {
      const py::gil_scoped_release others;
      env = Env::Create(experiment, options, said);
    }
    Rethrow();
    if (!env) Refuse(said);
    Tell(said);
    owned_ = std::make_unique<Owner<Env>>(std::move(env), "these environments were");
  }

  Owner<Env>& owner() { return *owned_; }
  const Env& env() const { return owned_->peek(); }
  py::ssize_t worlds() const { return env().worlds(); }
  int World(py::ssize_t world) const { return Index(world, env().worlds(), "world"); }
  py::ssize_t actions() const { return static_cast<py::ssize_t>(env().action_channels().size()); }
  py::ssize_t observations() const {
    return static_cast<py::ssize_t>(env().observation_channels().size());
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
    const bool good =
        owner().With([&](Env& env) { return env.Reset(seed_span, mask_span, rows, said); });
    Rethrow();
    if (!good) Refuse(said);
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
    owner().With([&](Env& env) { env.Step(act_span, step); });
    Rethrow();
  }

  /// Of the present episodes, or of those before: seeds, steps, rewards, ends.
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
    owner().With([&](const Env& env) {
      for (int w = 0; w < static_cast<int>(n); ++w) {
        const EpisodeState e = last ? env.Last(w) : env.Episode(w);
        seed[w] = e.seed, count[w] = e.steps, reward[w] = e.reward;
        end[w] = static_cast<std::uint8_t>(e.end);
      }
    });
    return py::make_tuple(seeds, steps, rewards, ends);
  }

 private:
  /// f(arrays...) for what a caller brought. What it raises comes out of the call that led to it.
  void Call(const py::object& f, const EnvView& view, bool judges) {
    const py::gil_scoped_acquire mine;
    if (raised_) return;
    const py::ssize_t n = view.env.worlds();
    const auto columns = static_cast<py::ssize_t>(view.env.observation_channels().size());
    const auto numbers = static_cast<py::ssize_t>(view.env.action_channels().size());
    const py::capsule alive(&kNobody, [](void*) {});  // views, for the time of the call
    const auto array = [&](auto span, std::vector<py::ssize_t> shape) {
      using T = std::remove_const_t<typename decltype(span)::element_type>;
      return py::array_t<T>(std::move(shape), span.data(), alive);
    };
    const bool single = !view.observations_f32.empty();
    py::object seen = single ? py::object(array(view.observations_f32, {n, columns}))
                             : py::object(array(view.observations_f64, {n, columns}));
    const py::object rows = array(view.rows, {n});
    try {
      if (!judges) {
        f(rows, seen);
        return;
      }
      py::object acted = !view.actions_f32.empty()
                             ? py::object(array(view.actions_f32, {n, numbers}))
                             : py::object(array(view.actions_f64, {n, numbers}));
      f(rows, seen, acted, array(view.rewards, {n}), array(view.terminated, {n}));
    } catch (py::error_already_set& error) {
      raised_ = std::make_unique<py::error_already_set>(std::move(error));
    }
  }
  void Rethrow() {
    if (!raised_) return;
    const std::unique_ptr<py::error_already_set> raised = std::move(raised_);
    throw py::error_already_set(*raised);
  }

  static inline char kNobody = 0;
  const py::object observe_, judge_;
  std::unique_ptr<py::error_already_set> raised_;
  std::unique_ptr<Owner<Env>> owned_;
  bool same_step_ = false;
};

}  // namespace

void AddEnvironments(py::module_& module) {
  using E = Environments;
  py::class_<E, std::shared_ptr<E>> type(module, "Environments",
                                         "What taut.gym stands on: arrays in, arrays out.");
  type.def(py::init<const ExperimentSpec&, int, int, const std::optional<std::string>&,
                    const std::string&, bool, std::optional<std::uint64_t>, int, const py::object&,
                    const py::object&>(),
           py::arg("experiment"), py::arg("worlds") = 1, py::arg("threads") = 1,
           py::arg("simd") = py::none(), py::arg("autoreset") = "next_step",
           py::arg("randomise") = true, py::arg("seed") = py::none(),
           py::arg("own_observations") = 0, py::arg("observe") = py::none(),
           py::arg("judge") = py::none());
  type.def_property_readonly("worlds", &E::worlds);
  type.def_property_readonly("action_channels",
                             [](const E& e) { return NamesOf(e.env().action_channels()); });
  type.def_property_readonly("action_scales", [](const E& e) { return e.env().action_scales(); });
  type.def_property_readonly("observation_channels",
                             [](const E& e) { return NamesOf(e.env().observation_channels()); });
  type.def_property_readonly("period_s", [](const E& e) { return e.env().period_s(); });
  type.def_property_readonly("episode_steps", [](const E& e) { return e.env().episode_steps(); });
  type.def("reset_f32", &E::Reset<float>);
  type.def("reset_f64", &E::Reset<double>);
  type.def("step_f32", &E::Step<float>);
  type.def("step_f64", &E::Step<double>);
  type.def("episodes", &E::Episodes, py::arg("last") = false);
  type.def("experiment", [](E& e, py::ssize_t world) {
    const int w = e.World(world);
    return std::make_shared<ExperimentSpec>(
        e.owner().With([&](const Env& env) { return env.Experiment(w); }));
  });
  type.def("hash", [](E& e, py::ssize_t world) {
    const int w = e.World(world);
    return e.owner().With([&](const Env& env) { return env.Hash(w); });
  });
  type.def(
      "save",
      [](E& e, py::ssize_t world) {
        const int w = e.World(world);
        const auto saved = e.owner().With([&](Env& env) { return env.Save(w); });
        return py::bytes(reinterpret_cast<const char*>(saved.data()), saved.size());
      },
      py::arg("world") = 0);
  type.def(
      "restore",
      [](E& e, const py::bytes& snapshot, py::ssize_t world) {
        const int w = e.World(world);
        const auto text = static_cast<std::string_view>(snapshot);
        const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
        Diagnostics said;
        if (!e.owner().With([&](Env& env) { return env.Restore(w, bytes, said); })) Refuse(said);
      },
      py::arg("snapshot"), py::arg("world") = 0);
  type.def("time_s", [](E& e, py::ssize_t world) {
    const int w = e.World(world);
    return e.owner().With([&](const Env& env) { return env.Time(w); });
  });
  py::list ends;
  for (const auto& [name, end] : kEnds) ends.append(py::make_tuple(name, static_cast<int>(end)));
  module.attr("episode_ends") = ends;
}

}  // namespace taut::python
