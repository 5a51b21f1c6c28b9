/// Random draw of an episode (domain randomization): seed, model variation, slope of gravity and
/// delays.
#pragma once

#include <cstdint>

#include "env/plan.h"

namespace taut::env {

struct Episode {
  std::uint64_t raw_seed = 0;  ///< The next episode's seed follows from it.
  std::uint64_t seed = 0;      ///< Effective seed.
  RolloutWorld world;
  Vec3 gravity_m_per_s2;                        ///< In W.
  int action_delay = 0, observation_delay = 0;  ///< In periods.
};

Episode DrawEpisode(const Plan& plan, std::uint64_t raw_seed);

/// Returns the default seed of a world's next episode.
std::uint64_t FollowingSeed(std::uint64_t raw_seed) noexcept;

/// Changes an experiment so that it runs the episode alone. `experiment`: the plan's, or one set
/// for another episode.
void SetEpisode(const Episode& episode, ExperimentSpec& experiment);

}  // namespace taut::env
