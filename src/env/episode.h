/// An episode: what its seed makes of the experiment.
#pragma once

#include <cstdint>

#include "env/plan.h"

namespace taut::env {

struct Episode {
  std::uint64_t raw_seed = 0;  ///< From which the next one's follows.
  std::uint64_t seed = 0;      ///< As it counts.
  RolloutWorld world;
  Vec3 gravity_m_per_s2;                        ///< In W.
  int action_delay = 0, observation_delay = 0;  ///< In periods.
};

Episode DrawEpisode(const Plan& plan, std::uint64_t raw_seed);

/// That of a world's next episode, if nobody gives one.
std::uint64_t FollowingSeed(std::uint64_t raw_seed) noexcept;

/// Makes an experiment the one that runs the episode alone; it is the plan's, or another episode's.
void SetEpisode(const Episode& episode, ExperimentSpec& experiment);

}  // namespace taut::env
