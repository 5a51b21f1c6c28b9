#include "env/episode.h"

#include "math/elementary.h"
#include "math/random.h"
#include "math/vec.h"
#include "plant/random_streams.h"
#include "rollout/vary.h"

namespace taut::env {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;

/// Returns gravity rotated about a random horizontal axis by an angle of at most `slope_rad`, which
/// is equivalent to sloped terrain.
Vec3 Sloped(const Vec3& gravity, double slope_rad, std::uint64_t seed) {
  if (!(slope_rad > 0)) return gravity;
  math::Random random(seed, plant::kEpisodeSlope, 0);
  const double direction_rad = kTwoPi * random.Uniform();
  const double half_rad = 0.5 * random.Uniform(0.0, slope_rad);
  const double s = math::Sin(half_rad);
  const Quat turn{math::Cos(half_rad), s * math::Cos(direction_rad), s * math::Sin(direction_rad),
                  0.0};
  return Rotate(turn, gravity);
}

/// Returns a uniformly distributed integer from 0 to `most`.
int Drawn(int most, math::Random& random) {
  return static_cast<int>(random.Uniform() * (most + 1));
}

}  // namespace

Episode DrawEpisode(const Plan& plan, std::uint64_t raw_seed) {
  const auto starts = static_cast<std::uint64_t>(plan.varied.starts);
  Episode episode;
  episode.raw_seed = raw_seed;
  episode.seed = starts > 0 ? raw_seed % starts : raw_seed;
  episode.world = WorldOf(plan.experiment);
  episode.world.seed = episode.seed;
  rollout::Vary(plan.varied, math::Random(episode.seed, plant::kEpisodeScales, 0), episode.world);
  episode.gravity_m_per_s2 =
      Sloped(plan.experiment.robot.def.gravity_m_per_s2, plan.varied.slope_rad, episode.seed);
  math::Random delays(episode.seed, plant::kEpisodeDelays, 0);
  episode.action_delay = Drawn(plan.most_action_delay, delays);
  episode.observation_delay = Drawn(plan.most_observation_delay, delays);
  return episode;
}

std::uint64_t FollowingSeed(std::uint64_t raw_seed) noexcept {
  return math::Random(raw_seed, plant::kFollowingSeed, 0).Bits() >> 1;
}

void SetEpisode(const Episode& episode, ExperimentSpec& experiment) {
  experiment.scales = episode.world.scales;
  experiment.start_noise = episode.world.start_noise;
  experiment.seed = episode.world.seed;
  experiment.robot.def.gravity_m_per_s2 = episode.gravity_m_per_s2;
}

}  // namespace taut::env
