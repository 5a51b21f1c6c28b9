/// What all worlds of an environment have in common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "taut/env.h"

namespace taut::env {

struct Plan {
  ExperimentSpec experiment;
  EnvironmentSpec spec;         ///< Of the experiment.
  EnvironmentVariation varied;  ///< Nothing, if the caller wants no randomisation.
  EnvOptions options;
  std::shared_ptr<const Model> model;
  Simd simd = Simd::kScalar;
  int lanes = 1;
  std::int64_t steps_per_period = 1, episode_steps = 1;
  int most_action_delay = 0, most_observation_delay = 0;  ///< In periods.
  bool start_varies = false;  ///< Whether starts of two seeds may differ.

  std::size_t action_count() const noexcept { return spec.actions.size(); }
  std::size_t cable_count() const noexcept { return experiment.robot.def.cables.size(); }
  std::size_t body_count() const noexcept { return experiment.robot.def.bodies.size(); }
};

/// How many times `part_s` goes into `whole_s`: a whole number, to rounding.
std::int64_t Times(double whole_s, double part_s) noexcept;

}  // namespace taut::env
