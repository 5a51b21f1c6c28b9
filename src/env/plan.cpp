#include "env/plan.h"

#include <algorithm>
#include <utility>

namespace taut::env {
namespace {

bool Any(const StartNoise& noise) {
  return noise.place_m > 0 || noise.position_m > 0 || noise.heading_rad > 0 || noise.any_pose;
}

}  // namespace

std::unique_ptr<Plan> PlanOf(const ExperimentSpec& experiment, const EnvOptions& options,
                             std::shared_ptr<const Model> model) {
  auto plan = std::make_unique<Plan>();
  plan->experiment = experiment;
  plan->spec = *experiment.environment;
  if (options.randomise) plan->varied = plan->spec.randomise;
  plan->options = options;
  plan->options.worlds = std::max(options.worlds, 1);
  plan->model = std::move(model);
  plan->simd = SimdOf({.worlds = plan->options.worlds, .simd = options.simd});
  plan->lanes = static_cast<int>(plan->simd);
  plan->steps_per_period = Times(plan->spec.period_s, experiment.step_s);
  plan->episode_steps = Times(experiment.duration_s, plan->spec.period_s);
  const EnvironmentVariation& varied = plan->varied;
  const auto periods = [&](double delay_s) {
    return static_cast<int>(Times(delay_s, plan->spec.period_s));
  };
  plan->most_action_delay = periods(varied.action_delay_s);
  plan->most_observation_delay = periods(varied.observation_delay_s);
  plan->start_varies = Any(experiment.start_noise) || Any(varied.start) || varied.friction > 0 ||
                       varied.mass > 0 || varied.stiffness > 0 || varied.damping > 0 ||
                       varied.slope_rad > 0;
  return plan;
}

}  // namespace taut::env
