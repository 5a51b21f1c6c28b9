/// Environments of small experiments, and arrays for their outputs
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "taut/env.h"

namespace taut::test {

inline ExperimentSpec LoadFrom(const std::string& name, double duration_s = 0) {
  Diagnostics out;
  auto experiment = LoadExperiment(
      std::string(TAUT_SOURCE_DIR) + "/share/experiments/" + name + ".yaml", {}, out);
  if (!experiment) throw std::runtime_error(out.Format());
  if (duration_s > 0) experiment->duration_s = duration_s;
  return *experiment;
}

inline std::unique_ptr<Env> MakeEnv(const ExperimentSpec& experiment, const EnvOptions& options) {
  Diagnostics out;
  auto env = Env::Create(experiment, options, out);
  if (!env) throw std::runtime_error(out.Format());
  return env;
}

/// Arrays of the right size for an environment
template <class T = double>
struct Arrays {
  explicit Arrays(const Env& env)
      : worlds(static_cast<std::size_t>(env.worlds())),
        action_width(env.action_channels().size()),
        width(env.observation_channels().size()),
        actions(worlds * action_width),
        observations(worlds * width, T(-7)),
        finals(worlds * width, T(-7)),
        rewards(worlds),
        terminated(worlds),
        truncated(worlds) {}

  void Step(Env& env, bool with_finals = false) {
    const EnvStep<T> out{observations, rewards, terminated, truncated,
                         with_finals ? std::span<T>(finals) : std::span<T>{}};
    env.Step(std::span<const T>(actions), out);
  }
  bool Reset(Env& env, std::span<const std::uint64_t> seeds = {},
             std::span<const std::uint8_t> mask = {}) {
    Diagnostics out;
    return env.Reset(seeds, mask, std::span<T>(observations), out);
  }
  std::vector<T> Row(std::size_t world) const {
    const auto first = observations.begin() + static_cast<std::ptrdiff_t>(world * width);
    return {first, first + static_cast<std::ptrdiff_t>(width)};
  }
  std::vector<T> Final(std::size_t world) const {
    const auto first = finals.begin() + static_cast<std::ptrdiff_t>(world * width);
    return {first, first + static_cast<std::ptrdiff_t>(width)};
  }
  bool AllFinite() const {
    for (const T x : observations) {
      if (!std::isfinite(x)) return false;
    }
    for (const double x : rewards) {
      if (!std::isfinite(x)) return false;
    }
    return true;
  }

  std::size_t worlds, action_width, width;
  std::vector<T> actions, observations, finals;
  std::vector<double> rewards;
  std::vector<std::uint8_t> terminated, truncated;
};

/// Sets actions that differ from step to step and from world to world. They are multiples of 1/64,
/// so that float and double represent them exactly.
template <class T>
void Wiggle(Arrays<T>& arrays, std::int64_t step, std::size_t first_world = 0) {
  for (std::size_t w = 0; w < arrays.worlds; ++w) {
    for (std::size_t i = 0; i < arrays.action_width; ++i) {
      const auto k = static_cast<std::int64_t>(7 * (w + first_world) + 13 * i) + 5 * step;
      arrays.actions[w * arrays.action_width + i] = static_cast<T>(k % 33 - 16) / T(16);
    }
  }
}

}  // namespace taut::test
