/// Simulations of shipped experiments, and variants of them.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "taut/simulation.h"

namespace taut::test {

inline ExperimentSpec Load(const std::string& name, double duration_s) {
  Diagnostics out;
  auto experiment = LoadExperiment(
      std::string(TAUT_SOURCE_DIR) + "/share/experiments/" + name + ".yaml", {}, out);
  if (!experiment) throw std::runtime_error(out.Format());
  experiment->duration_s = duration_s;
  return *experiment;
}

inline std::unique_ptr<Simulation> Create(const ExperimentSpec& experiment,
                                          const SimulationOptions& options = {}) {
  Diagnostics out;
  auto simulation = Simulation::Create(experiment, options, out);
  EXPECT_TRUE(simulation) << out.Format();
  return simulation;
}

/// Variants with different gains, stiffness, start and sensors' seeds
inline std::vector<RolloutWorld> Variants(const ExperimentSpec& experiment, int count) {
  std::vector<RolloutWorld> variants;
  for (int i = 0; i < count; ++i) {
    RolloutWorld variant = WorldOf(experiment);
    variant.seed = static_cast<std::uint64_t>(7 + i);
    variant.scales.push_back({ScaleSpec::Quantity::kStiffness, {}, 1 + 0.02 * i});
    if (i > 0) variant.start_noise.position_m = 0.001;
    for (ControllerSpec& controller : variant.controllers) {
      if (!controller.impedance) continue;
      controller.impedance->cables[0].tension_offset_n *= 1 + 0.1 * i;
    }
    variants.push_back(std::move(variant));
  }
  return variants;
}

}  // namespace taut::test
