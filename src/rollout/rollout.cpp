// Rollouts: simulates many variants of an experiment in parallel, one per SIMD lane, on several
// threads.
#include "taut/rollout.h"

#include <algorithm>
#include <limits>
#include <mutex>

#include "base/thread_pool.h"
#include "plant/loop.h"
#include "plant/start_finder.h"
#include "rollout/scorer.h"

namespace taut {
namespace {

class LaneRollouts final : public Rollouts {
 public:
  LaneRollouts(const ExperimentSpec& experiment, const ObjectiveSpec& objective,
               const RolloutOptions& options, std::shared_ptr<const Model> model)
      : experiment_(experiment),
        objective_(objective),
        options_(options),
        model_(std::move(model)),
        pool_(options.threads),
        simd_(SimdOf({.simd = options.simd.value_or(BestSimd())})),
        lanes_(static_cast<int>(simd_)) {
    places_.resize(static_cast<std::size_t>(pool_.threads()));
  }

  int lanes() const noexcept override { return lanes_; }
  int parallel_worlds() const noexcept override { return lanes_ * pool_.threads(); }

  std::vector<RolloutResult> Run(std::span<const RolloutWorld> worlds, const Done& done) override {
    std::vector<RolloutResult> results(worlds.size());
    std::atomic<std::size_t> next{0};
    std::atomic<bool> given_up{false};
    std::mutex one_at_a_time;
    const auto lanes = static_cast<std::size_t>(lanes_);
    auto work = [&](int thread) {
      std::unique_ptr<Workplace>& place = places_[static_cast<std::size_t>(thread)];
      if (!place) place = std::make_unique<Workplace>(model_, simd_, lanes_);
      for (;;) {
        const std::size_t first = next.fetch_add(lanes);
        if (first >= worlds.size() || given_up || Stopped()) return;
        const std::size_t count = std::min(lanes, worlds.size() - first);
        RunGroup(worlds.subspan(first, count), *place, results.data() + first);
        if (!done) continue;
        const std::lock_guard lock(one_at_a_time);
        for (std::size_t i = first; i < first + count; ++i) {
          if (results[i].done && !done(i, results[i])) given_up = true;
        }
      }
    };
    pool_.Run(work);
    return results;
  }

 private:
  bool Stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  /// Batches of a thread, used for one group after the other. Creating a batch takes as long as
  /// seconds of simulation.
  struct Workplace {
    Workplace(const std::shared_ptr<const Model>& model, Simd simd, int lanes)
        : starts(model), group(model, {.worlds = lanes, .simd = simd}) {}
    plant::StartFinder starts;
    WorldBatch group;
  };

  /// Restores a lane to its start. Returns false and sets `failed` if the start cannot be found.
  bool Prepare(const RolloutWorld& world, Workplace& place, int lane, std::string& failed) const {
    Diagnostics found;
    const auto start = place.starts.Find(ExperimentOf(experiment_, world), found);
    if (!start) {
      failed = plant::ReasonOf(found);
      return false;
    }
    return place.group.Restore(lane, *start);
  }

  void RunGroup(std::span<const RolloutWorld> worlds, Workplace& place,
                RolloutResult* results) const {
    WorldBatch& batch = place.group;
    const int count = static_cast<int>(worlds.size());
    std::vector<std::string> no_start(worlds.size());
    std::vector<const RolloutWorld*> lanes;  // unused lanes repeat the first world
    for (int j = 0; j < lanes_; ++j) {
      const int world = j < count ? j : 0;
      lanes.push_back(&worlds[static_cast<std::size_t>(world)]);
      std::string failed;
      if (!Prepare(*lanes.back(), place, j, failed) && j < count) {
        no_start[static_cast<std::size_t>(j)] = failed;
      }
    }
    const auto plant = PlantOf(batch);
    plant::Loop loop(experiment_, lanes, *plant, options_.extensions);
    rollout::Scorer scorer({experiment_, lanes}, objective_, loop,
                           options_.score ? options_.score({experiment_, lanes}) : nullptr);
    for (std::int64_t steps = 0; loop.time_s() < experiment_.duration_s; ++steps) {
      if ((steps & 1023) == 1023 && (Stopped() || !scorer.AnyAlive(count))) {
        if (Stopped()) return;
        break;
      }
      loop.Step();
      scorer.Take();
    }
    for (int j = 0; j < count; ++j) {
      std::string failed = no_start[static_cast<std::size_t>(j)];
      if (failed.empty()) failed = loop.refused(j);
      if (failed.empty()) {
        results[j] = scorer.Result(j);
      } else {
        results[j].done = true;
        results[j].failed = failed;
        results[j].score = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }

  const ExperimentSpec experiment_;
  const ObjectiveSpec objective_;
  const RolloutOptions options_;
  std::shared_ptr<const Model> model_;
  base::ThreadPool pool_;
  std::vector<std::unique_ptr<Workplace>> places_;  ///< Workplace of each thread.
  Simd simd_ = Simd::kScalar;
  int lanes_ = 1;
};

}  // namespace

std::unique_ptr<Rollouts> Rollouts::Create(const ExperimentSpec& experiment,
                                           const ObjectiveSpec& objective,
                                           const RolloutOptions& options, Diagnostics& out) {
  auto model = Model::CompileForExperiment(experiment.robot.def, out);
  if (!model) return nullptr;
  return std::make_unique<LaneRollouts>(experiment, objective, options, std::move(model));
}

}  // namespace taut
