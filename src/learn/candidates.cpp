// Evaluation of a study's candidates by rollouts in randomized worlds.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include "math/elementary.h"
#include "math/random.h"
#include "rollout/vary.h"
#include "taut/learn.h"

namespace taut {
namespace {

enum Stream : std::uint32_t { kWorldSeed = 1, kWorldScales = 2 };

/// Writes the values of the parameters to the numbers that they represent.
void SetValues(const std::vector<StudyParameter>& parameters, const std::vector<double>& values,
               const RobotSpec& robot, RolloutWorld& world) {
  std::vector<ScaleSpec> scales = TunableScales(robot);
  std::map<std::string, double*> places;
  for (const Tunable& tunable : FindTunables(world.controllers, scales, robot)) {
    places[tunable.name] = tunable.value;
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    for (const std::string& target : parameters[i].targets) {
      const auto place = places.find(target);
      if (place != places.end()) *place->second = values[i];
    }
  }
  for (ScaleSpec& scale : scales) {
    if (scale.factor != 1.0) world.scales.push_back(std::move(scale));
  }
}

/// Returns the random numbers of one world of an evaluation. Without `redraw`, all evaluations use
/// the same numbers.
math::Random RandomOf(const StudySpec& study, Stream stream, std::int64_t evaluation, int world) {
  const std::uint64_t of =
      study.perturbation.redraw ? static_cast<std::uint64_t>(evaluation) + 1 : 0;
  return {study.seed, stream, (of << 12) + static_cast<std::uint64_t>(world)};
}

class LocalEvaluator final : public Evaluator {
 public:
  LocalEvaluator(const StudySpec& study, std::unique_ptr<Rollouts> rollouts)
      : study_(study), rollouts_(std::move(rollouts)) {}

  bool Evaluate(std::span<const Candidate> candidates, const Done& done) override {
    std::vector<RolloutWorld> worlds;
    std::vector<std::pair<std::size_t, std::size_t>> owner;  // index of the candidate, index of its
                                                             // world
    std::vector<Trial> trials(candidates.size());
    std::vector<std::size_t> missing(candidates.size());
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      auto own = CandidateWorlds(study_, candidates[c].values, candidates[c].id);
      trials[c].worlds.resize(own.size());
      missing[c] = own.size();
      for (std::size_t w = 0; w < own.size(); ++w) {
        trials[c].seeds.push_back(own[w].seed);
        owner.emplace_back(c, w);
        worlds.push_back(std::move(own[w]));
      }
    }
    bool go_on = true, all = true;
    rollouts_->Run(worlds, [&](std::size_t i, const RolloutResult& result) {
      const auto [c, w] = owner[i];
      trials[c].worlds[w] = result;
      if (--missing[c] > 0) return true;
      Finish(trials[c]);
      go_on = done(c, trials[c]) && go_on;
      return go_on;
    });
    for (const Trial& trial : trials) all = all && trial.done;
    return all && go_on;
  }

 private:
  void Finish(Trial& trial) const {
    trial.done = true;
    double sum = 0, least = std::numeric_limits<double>::infinity();
    for (std::size_t w = 0; w < trial.worlds.size(); ++w) {
      const RolloutResult& world = trial.worlds[w];
      if (!world.failed.empty() && trial.failed.empty()) {
        trial.failed = "world " + std::to_string(w) + ": " + world.failed;
      }
      sum += world.score;
      least = std::fmin(least, world.score);
    }
    const double mean = sum / static_cast<double>(trial.worlds.size());
    trial.score = trial.failed.empty() ? (study_.perturbation.worst ? least : mean)
                                       : std::numeric_limits<double>::quiet_NaN();
  }

  const StudySpec study_;
  std::unique_ptr<Rollouts> rollouts_;
};

}  // namespace

double ParameterValue(const StudyParameter& p, double x) {
  // Exact at the ends: rounding of the logarithm must not exceed the bounds.
  if (x <= 0) return p.low;
  if (x >= 1) return p.high;
  if (!p.log) return p.low + x * (p.high - p.low);
  const double low = math::Log(p.low), high = math::Log(p.high);
  return std::min(p.high, std::max(p.low, math::Exp(low + x * (high - low))));
}

RolloutWorld NominalWorld(const StudySpec& study, const std::vector<double>& values) {
  RolloutWorld world = WorldOf(study.experiment);
  SetValues(study.parameters, values, study.experiment.robot, world);
  return world;
}

std::vector<RolloutWorld> CandidateWorlds(const StudySpec& study, const std::vector<double>& values,
                                          std::int64_t evaluation) {
  const PerturbationSpec& spec = study.perturbation;
  const RolloutWorld nominal = NominalWorld(study, values);
  std::vector<RolloutWorld> worlds;
  for (int w = 0; w < spec.worlds; ++w) {
    RolloutWorld& world = worlds.emplace_back(nominal);
    if (w == 0) continue;
    world.seed = RandomOf(study, kWorldSeed, evaluation, w).Bits() >> 1;
    rollout::Vary(spec, RandomOf(study, kWorldScales, evaluation, w), world);
  }
  return worlds;
}

std::unique_ptr<Evaluator> MakeEvaluator(const StudySpec& study, int threads,
                                         const std::atomic<bool>* stop, Diagnostics& out) {
  RolloutOptions options;
  options.threads = threads;
  options.stop = stop;
  auto rollouts = Rollouts::Create(study.experiment, study.objective, options, out);
  if (!rollouts) return nullptr;
  return std::make_unique<LocalEvaluator>(study, std::move(rollouts));
}

// --- reading of a study folder ---------------------------------------------------------------

ExperimentSpec StudyResult::ExperimentWith(const std::vector<double>& values) const {
  RolloutWorld world = WorldOf(experiment);
  SetValues(parameters, values, experiment.robot, world);
  return ExperimentOf(experiment, world);
}

const Evaluation* StudyResult::best() const {
  const auto first = top(1);
  return first.empty() ? nullptr : first[0];
}

std::vector<const Evaluation*> StudyResult::top(std::size_t count) const {
  std::vector<const Evaluation*> good;
  for (const Evaluation& evaluation : evaluations) {
    if (evaluation.failed.empty() && !std::isnan(evaluation.score)) good.push_back(&evaluation);
  }
  std::stable_sort(good.begin(), good.end(),
                   [](const Evaluation* a, const Evaluation* b) { return a->score > b->score; });
  good.resize(std::min(count, good.size()));
  return good;
}

}  // namespace taut
