/// Settings that all worlds of an environment share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "taut/env.h"

namespace taut::env {

struct Plan {
  ExperimentSpec experiment;
  EnvironmentSpec spec;         ///< Environment of the experiment.
  EnvironmentVariation varied;  ///< Randomization; empty: none.
  EnvOptions options;
  std::shared_ptr<const Model> model;
  Simd simd = Simd::kScalar;
  int lanes = 1;
  std::int64_t steps_per_period = 1, episode_steps = 1;
  int most_action_delay = 0, most_observation_delay = 0;  ///< Largest delays, in periods.
  bool start_varies = false;                              ///< Whether starts depend on the seed.

  std::size_t action_count() const noexcept { return spec.actions.size(); }
  std::size_t cable_count() const noexcept { return experiment.robot.def.cables.size(); }
  std::size_t body_count() const noexcept { return experiment.robot.def.bodies.size(); }
};

std::unique_ptr<Plan> PlanOf(const ExperimentSpec& experiment, const EnvOptions& options,
                             std::shared_ptr<const Model> model);

/// Returns whole_s / part_s, rounded to the nearest integer.
std::int64_t Times(double whole_s, double part_s) noexcept;

}  // namespace taut::env
