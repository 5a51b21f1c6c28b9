// Vectorized reinforcement-learning environment on groups of SIMD lanes and threads.
#include "taut/env.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>

#include "base/hash.h"
#include "base/thread_pool.h"
#include "env/world_group.h"
#include "plant/recorder.h"
#include "plant/sealed.h"
#include "sim/batch/check_index.h"
#include "taut/study.h"

namespace taut {
namespace {

using env::Group;
using env::GroupRows;
using env::Plan;

ChannelInfo ActionChannel(const EnvironmentAction& action, const Plan& plan) {
  if (action.by) {
    std::vector<ControllerSpec> controllers = plan.experiment.controllers;
    std::vector<ScaleSpec> none;
    for (const Tunable& number : FindTunables(controllers, none, plan.experiment.robot)) {
      if (number.name != action.numbers[0]) continue;
      return {action.name.empty() ? number.name : action.name, number.unit};
    }
  }
  const ModelDef& def = plan.experiment.robot.def;
  const std::string of = "cable/" + def.cables[static_cast<std::size_t>(action.cable)].name + "/";
  if (action.rest_length_m) return {of + "rest_length_m", "m"};
  if (action.rest_length_rate_m_per_s) return {of + "rest_length_rate_m_per_s", "m/s"};
  return {of + "velocity_input_m_per_s", "m/s"};
}

double ScaleOf(const EnvironmentAction& action) {
  if (action.by) return *action.by;
  if (action.rest_length_m) return *action.rest_length_m;
  if (action.rest_length_rate_m_per_s) return *action.rest_length_rate_m_per_s;
  return *action.velocity_input_m_per_s;
}

class LaneEnv final : public Env {
 public:
  LaneEnv(std::unique_ptr<const Plan> plan, int threads)
      : plan_(std::move(plan)),
        observed_(env::Observed(plan_->experiment)),
        starts_(*plan_),
        pool_(threads),
        places_(static_cast<std::size_t>(pool_.threads())) {
    observation_channels_ = ObservedChannels(plan_->experiment);
    const std::vector<ChannelInfo> of_channels = observation_channels_;
    for (int i = 0; i < plan_->options.own_observations; ++i) {
      observation_channels_.push_back({"own/" + std::to_string(i), "1"});
    }
    for (const EnvironmentAction& action : plan_->spec.actions) {
      action_channels_.push_back(ActionChannel(action, *plan_));
      action_scales_.push_back(ScaleOf(action));
    }
    const int worlds = plan_->options.worlds, lanes = plan_->lanes;
    groups_.resize(static_cast<std::size_t>((worlds + lanes - 1) / lanes));
    auto make = [&](int, std::size_t g) {  // allocates memory on the thread that uses it
      const int count = std::min(lanes, worlds - static_cast<int>(g) * lanes);
      groups_[g] = std::make_unique<Group>(*plan_, observed_, of_channels, count);
    };
    pool_.ForEach(groups_.size(), make);
    for (env::Place& place : places_) place.scratch = env::ScratchFor(groups_[0]->batch());
    for (std::vector<std::uint8_t>* flags : {&stepped_, &begun_, &all_}) {
      flags->assign(static_cast<std::size_t>(worlds), 1);
    }
    paused_.assign(groups_.size(), 0);
  }

  int worlds() const noexcept override { return plan_->options.worlds; }
  int lanes() const noexcept override { return plan_->lanes; }
  const std::vector<ChannelInfo>& action_channels() const noexcept override {
    return action_channels_;
  }
  const std::vector<double>& action_scales() const noexcept override { return action_scales_; }
  const std::vector<ChannelInfo>& observation_channels() const noexcept override {
    return observation_channels_;
  }
  double period_s() const noexcept override { return plan_->spec.period_s; }
  std::int64_t episode_steps() const noexcept override { return plan_->episode_steps; }

  bool Reset(std::span<const std::uint64_t> seeds, std::span<const std::uint8_t> mask,
             std::span<float> observations, Diagnostics& out) override {
    return ResetAll(seeds, mask, observations, out);
  }
  bool Reset(std::span<const std::uint64_t> seeds, std::span<const std::uint8_t> mask,
             std::span<double> observations, Diagnostics& out) override {
    return ResetAll(seeds, mask, observations, out);
  }
  bool Step(std::span<const float> actions, const EnvStep<float>& out) override {
    return StepAll(actions, out);
  }
  bool Step(std::span<const double> actions, const EnvStep<double>& out) override {
    return StepAll(actions, out);
  }

  std::vector<std::uint8_t> Save(int world) override {
    return Seal().Seal(GroupOf(__func__, world).Save(LaneOf(world)));
  }
  bool Restore(int world, std::span<const std::uint8_t> snapshot, Diagnostics& out) override {
    Group& group = GroupOf(__func__, world);
    const auto saved = Seal().Open(snapshot, out);
    if (!saved) return false;
    if (group.Restore(LaneOf(world), *saved)) return true;
    out.Error("snapshot.other_model", {},
              "the state in the snapshot does not belong to this model");
    return false;
  }

  EpisodeState Episode(int world) const override {
    return GroupOf(__func__, world).state(LaneOf(world));
  }
  EpisodeState Last(int world) const override {
    return GroupOf(__func__, world).last(LaneOf(world));
  }
  ExperimentSpec Experiment(int world) const override {
    ExperimentSpec experiment = plan_->experiment;
    env::SetEpisode(GroupOf(__func__, world).episode(LaneOf(world)), experiment);
    return experiment;
  }
  double Time(int world) const override { return GroupOf(__func__, world).time_s(LaneOf(world)); }
  BodyState Body(int world, int body) const override {
    return GroupOf(__func__, world).batch().Body(LaneOf(world), body);
  }
  CableState Cable(int world, int cable) const override {
    return GroupOf(__func__, world).batch().Cable(LaneOf(world), cable);
  }
  WorldStatus Status(int world) const override {
    return GroupOf(__func__, world).batch().Status(LaneOf(world));
  }
  std::uint64_t Hash(int world) const override {
    return GroupOf(__func__, world).batch().Hash(LaneOf(world));
  }

  /// Resets all worlds to their first episodes.
  bool Begin(Diagnostics& out) {
    std::vector<std::uint64_t> seeds(static_cast<std::size_t>(worlds()));
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      seeds[i] = plan_->options.seed.value_or(plan_->experiment.seed) + i;
    }
    return BeginAll(seeds, {}, out);
  }

 private:
  Group& GroupOf(const char* function, int world) const {
    sim::CheckIndex(function, "world", world, worlds());
    return *groups_[static_cast<std::size_t>(world / plan_->lanes)];
  }
  /// Returns the seal of snapshots. Snapshots are compatible if the properties below are equal.
  plant::Sealing Seal() {
    if (kind_ == 0) {
      base::Fnv1a kind;
      kind.AddText(ResolvedYaml(plan_->experiment));
      kind.AddText(plan_->options.randomise ? "randomised" : "as described");
      kind.AddText(std::to_string(static_cast<int>(plan_->options.autoreset)));
      kind_ = kind.value();
    }
    return {"environment", kind_, "experiment, randomization and autoreset must be the same"};
  }
  int LaneOf(int world) const noexcept { return world % plan_->lanes; }
  std::size_t width() const noexcept { return observation_channels_.size(); }

  bool BeginAll(std::span<const std::uint64_t> seeds, std::span<const std::uint8_t> mask,
                Diagnostics& out) {
    std::mutex one_at_a_time;
    std::vector<std::pair<std::size_t, std::string>> failures;
    auto work = [&](int thread, std::size_t g) {
      const std::size_t first = g * static_cast<std::size_t>(plan_->lanes);
      bool any = false;
      for (int j = 0; j < groups_[g]->count(); ++j) {
        const std::size_t world = first + static_cast<std::size_t>(j);
        begun_[world] = mask.empty() || mask[world] != 0 ? 1 : 0;
        if (begun_[world] == 0) continue;
        const std::uint64_t seed =
            seeds.empty() ? env::FollowingSeed(groups_[g]->episode(j).raw_seed) : seeds[world];
        std::string failed;
        any = true;
        if (groups_[g]->Begin(j, seed, starts_, places_[static_cast<std::size_t>(thread)],
                              failed)) {
          continue;
        }
        begun_[world] = 0;
        const std::lock_guard lock(one_at_a_time);
        failures.emplace_back(world,
                              "no start with the seed " + std::to_string(seed) + ": " + failed);
      }
      if (any) groups_[g]->Settle();
    };
    pool_.ForEach(groups_.size(), work);
    std::sort(failures.begin(), failures.end());
    for (const auto& [world, what] : failures) {
      out.Error("snapshot.bad_world", {}, "world " + std::to_string(world) + " has " + what);
    }
    return failures.empty();
  }

  template <class T>
  bool ResetAll(std::span<const std::uint64_t> seeds, std::span<const std::uint8_t> mask,
                std::span<T> observations, Diagnostics& out) {
    const auto count = static_cast<std::size_t>(worlds());
    if (!seeds.empty()) sim::CheckCount("Reset", "seed for each world", seeds.size(), count);
    if (!mask.empty()) sim::CheckCount("Reset", "word for each world", mask.size(), count);
    CheckWidth("Reset", "observation for each world", observations.size(), width());
    if (stopped_ && std::find(mask.begin(), mask.end(), 0) != mask.end()) {
      out.Error("environment.step_stopped", {}, "the last step was stopped before its end",
                "reset all worlds");
      return false;
    }
    for (const auto& group : groups_) group->Abandon();
    const bool good = BeginAll(seeds, mask, out);
    stopped_ = stopped_ && !good;
    for (std::size_t w = 0; w < count; ++w) {
      if (begun_[w] != 0) EmitRow(w, observations.data());
    }
    ObserveBegun(observations);
    return good;
  }

  /// Simulates one period of all groups. Polls `keep_going` between rounds. Returns false if
  /// `keep_going` stopped the step.
  template <class Work>
  bool StepGroups(const Work& work) {
    const auto& keep_going = plan_->options.keep_going;
    std::fill(paused_.begin(), paused_.end(), 1);
    for (;;) {
      const env::Deadline deadline(static_cast<bool>(keep_going));
      std::atomic<bool> pauses{false};
      auto step = [&](int thread, std::size_t g) {
        if (paused_[g] == 0) return;
        if (!deadline.Reached() && work(thread, g, deadline)) {
          paused_[g] = 0;
        } else {
          pauses.store(true, std::memory_order_relaxed);
        }
      };
      pool_.ForEach(groups_.size(), step);
      if (!pauses) return true;
      if (!keep_going()) return false;
    }
  }

  template <class T>
  bool StepAll(std::span<const T> actions, const EnvStep<T>& out) {
    const auto count = static_cast<std::size_t>(worlds());
    CheckWidth("Step", "action for each world", actions.size(), action_channels_.size());
    CheckWidth("Step", "observation for each world", out.observations.size(), width());
    sim::CheckCount("Step", "reward for each world", out.rewards.size(), count);
    sim::CheckCount("Step", "terminated for each world", out.terminated.size(), count);
    sim::CheckCount("Step", "truncated for each world", out.truncated.size(), count);
    const bool same_step = plan_->options.autoreset == Autoreset::kSameStep;
    if (same_step) {
      CheckWidth("Step", "final observation for each world", out.final_observations.size(),
                 width());
    }
    const bool calls = plan_->options.observe || plan_->options.judge;
    std::atomic<bool> any_begun{false};
    auto finish = [&](int thread, std::size_t g) {
      const bool begun = groups_[g]->Finish(RowsOf(g, actions, out), starts_,
                                            places_[static_cast<std::size_t>(thread)]);
      if (begun) any_begun.store(true, std::memory_order_relaxed);
    };
    auto step = [&](int thread, std::size_t g, const env::Deadline& deadline) {
      if (!groups_[g]->Step(RowsOf(g, actions, out), starts_,
                            places_[static_cast<std::size_t>(thread)], deadline)) {
        return false;
      }
      if (!calls) finish(thread, g);
      return true;
    };
    if (stopped_ || !StepGroups(step)) {
      stopped_ = true;
      return false;
    }
    if (!calls) return true;
    CallObserve(all_, out.observations);
    if (plan_->options.judge) {
      EnvView view = ViewOf(stepped_, out.observations);
      if constexpr (std::is_same_v<T, float>) {
        view.actions_f32 = actions;
      } else {
        view.actions_f64 = actions;
      }
      view.rewards = out.rewards;
      view.terminated = out.terminated;
      plan_->options.judge(view);
    }
    pool_.ForEach(groups_.size(), finish);
    if (same_step && any_begun) ObserveBegun(out.observations);
    return true;
  }

  void CheckWidth(const char* function, const char* what, std::size_t given,
                  std::size_t width) const {
    sim::CheckCount(function, what, given, width * static_cast<std::size_t>(worlds()));
  }

  template <class T>
  GroupRows<T> RowsOf(std::size_t g, std::span<const T> actions, const EnvStep<T>& out) {
    const std::size_t first = g * static_cast<std::size_t>(plan_->lanes);
    const bool finals = plan_->options.autoreset == Autoreset::kSameStep;
    return {actions.data() + first * action_channels_.size(),
            out.observations.data() + first * width(),
            finals ? out.final_observations.data() + first * width() : nullptr,
            out.rewards.data() + first,
            out.terminated.data() + first,
            out.truncated.data() + first,
            stepped_.data() + first,
            begun_.data() + first};
  }

  template <class T>
  void EmitRow(std::size_t world, T* observations) const {
    const std::size_t lanes = static_cast<std::size_t>(plan_->lanes);
    groups_[world / lanes]->Emit(static_cast<int>(world % lanes), observations + world * width());
  }

  template <class T>
  EnvView ViewOf(std::span<const std::uint8_t> rows, std::span<T> observations) const {
    EnvView view{*this, rows, {}, {}, {}, {}, {}, {}};
    if constexpr (std::is_same_v<T, float>) {
      view.observations_f32 = observations;
    } else {
      view.observations_f64 = observations;
    }
    return view;
  }

  template <class T>
  void CallObserve(std::span<const std::uint8_t> rows, std::span<T> observations) const {
    if (plan_->options.observe) plan_->options.observe(ViewOf(rows, observations));
  }

  /// Calls the `observe` callback for episodes that have just begun. Replaces values that are not
  /// finite by 0.
  template <class T>
  void ObserveBegun(std::span<T> observations) const {
    if (!plan_->options.observe) return;
    CallObserve(begun_, observations);
    for (std::size_t w = 0; w < begun_.size(); ++w) {
      if (begun_[w] == 0) continue;
      for (T& x : observations.subspan(w * width(), width())) x = std::isfinite(x) ? x : 0;
    }
  }

  std::unique_ptr<const Plan> plan_;
  const ExperimentSpec observed_;
  std::vector<ChannelInfo> action_channels_, observation_channels_;
  std::vector<double> action_scales_;
  std::uint64_t kind_ = 0;  ///< Hash of the environment's properties; 0: not computed yet.
  env::Starts starts_;
  base::ThreadPool pool_;
  std::vector<env::Place> places_;  ///< Working memory of each thread.
  std::vector<std::unique_ptr<Group>> groups_;
  std::vector<std::uint8_t> stepped_, begun_, all_;  ///< Flags of the worlds.
  std::vector<std::uint8_t> paused_;                 ///< Per group: whether its period is
                                                     ///< incomplete.
  bool stopped_ = false;                             ///< Whether `keep_going` stopped the last
                                                     ///< step.
};

}  // namespace

std::vector<ChannelInfo> ObservedChannels(const ExperimentSpec& experiment) {
  if (experiment.environment->observations.empty()) return {};
  return RunChannels(env::Observed(experiment));
}

std::unique_ptr<Env> Env::Create(const ExperimentSpec& experiment, const EnvOptions& options,
                                 Diagnostics& out) {
  if (!CheckEnvironment(experiment, out)) return nullptr;
  auto model = Model::CompileForExperiment(experiment.robot.def, out);
  if (!model) return nullptr;
  const int threads = options.threads;
  auto made =
      std::make_unique<LaneEnv>(env::PlanOf(experiment, options, std::move(model)), threads);
  if (!made->Begin(out)) return nullptr;
  return made;
}

}  // namespace taut
