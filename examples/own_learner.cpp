// Example of a simple learner (random search) with user-defined rewards.
//
//   own_learner share/experiments/learn_spine.yaml
//
// Each of 64 worlds of a robot tries a different linear policy from observations to actions. The
// reward is the experiment's, plus a bonus for a low position. The best return of a round does not
// depend on the number of threads; the example asserts this, and that every number is finite.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <vector>

#include "taut/env.h"

namespace {

/// Returns the best return of 64 policies drawn from a seed; NaN if there is no environment.
double BestOf(const taut::ExperimentSpec& experiment, int threads, unsigned seed) {
  constexpr std::size_t kWorlds = 64;
  taut::EnvOptions options;
  options.worlds = kWorlds;
  options.threads = threads;
  options.autoreset = taut::Autoreset::kDisabled;  // one episode each is enough
  options.judge = [](const taut::EnvView& view) {
    for (std::size_t w = 0; w < kWorlds; ++w) {
      const double height_m = view.env.Body(static_cast<int>(w), 0).position_m.z;
      if (view.rows[w] != 0) view.rewards[w] += 0.001 * std::max(0.2 - height_m, 0.0);
    }
  };
  taut::Diagnostics out;
  const auto env = taut::Env::Create(experiment, options, out);
  if (!env) {
    std::fputs(out.Format().c_str(), stderr);
    return NAN;
  }
  const std::size_t seen = env->observation_channels().size();
  const std::size_t done = env->action_channels().size();
  std::mt19937 random(seed);
  std::vector<float> laws(kWorlds * done * seen), observations(kWorlds * seen),
      actions(kWorlds * done);
  for (float& x : laws) x = 1e-4f * (static_cast<float>(random() >> 8) / 8388608.0f - 1);
  std::vector<double> rewards(kWorlds);
  std::vector<std::uint8_t> terminated(kWorlds), truncated(kWorlds);
  env->Reset({}, {}, std::span<float>(observations), out);
  for (std::int64_t step = 0; step < env->episode_steps(); ++step) {
    for (std::size_t w = 0; w < kWorlds; ++w) {
      for (std::size_t i = 0; i < done; ++i) {
        float sum = 0;
        for (std::size_t k = 0; k < seen; ++k) {
          sum += laws[(w * done + i) * seen + k] * observations[w * seen + k];
        }
        actions[w * done + i] = sum;
      }
    }
    env->Step(std::span<const float>(actions), {observations, rewards, terminated, truncated});
  }
  double best = -INFINITY;
  for (std::size_t w = 0; w < kWorlds; ++w) {
    best = std::max(best, env->Episode(static_cast<int>(w)).reward);
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  taut::Diagnostics out;
  auto experiment = argc > 1 ? taut::LoadExperiment(argv[1], {}, out) : std::nullopt;
  if (!experiment) {
    std::fprintf(stderr, "usage: own_learner EXPERIMENT\n%s", out.Format().c_str());
    return 2;
  }
  experiment->duration_s = 0.5;
  const double best = BestOf(*experiment, 1, 1);
  std::printf("the best of 64 random laws earned %.4f in %g s\n", best, experiment->duration_s);
  return std::isfinite(best) && best == BestOf(*experiment, 2, 1) ? 0 : 1;
}
