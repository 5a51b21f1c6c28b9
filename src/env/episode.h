/// Random variables of an episode (domain randomization): seed, model parameters, slope of gravity,
/// delays.
#pragma once

#include <cstdint>

#include "env/plan.h"

namespace taut::env {

struct Episode {
  std::uint64_t raw_seed = 0;  ///< Determines the seed of the next episode.
  std::uint64_t seed = 0;      ///< Seed of this episode.
  RolloutWorld world;
  Vec3 gravity_m_per_s2;                        ///< Gravity, in W.
  int action_delay = 0, observation_delay = 0;  ///< Delays in periods.
};

Episode DrawEpisode(const Plan& plan, std::uint64_t raw_seed);

/// Returns the default seed of a world's next episode.
std::uint64_t FollowingSeed(std::uint64_t raw_seed) noexcept;

/// Converts an experiment to the episode's experiment. `experiment`: the experiment of the plan, or
/// the result of an earlier call.
void SetEpisode(const Episode& episode, ExperimentSpec& experiment);

}  // namespace taut::env
