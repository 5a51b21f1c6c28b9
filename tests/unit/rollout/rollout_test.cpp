// Variants of an experiment side by side: each equals a separate run bit for bit.
#include "taut/rollout.h"

#include <gtest/gtest.h>

#include <cmath>

#include "taut/run.h"
#include "tests/instruction_sets.h"

namespace taut {
namespace {

const std::string kExperiments = std::string(TAUT_SOURCE_DIR) + "/share/experiments/";

ExperimentSpec LoadVariants(const std::string& name, double duration_s) {
  Diagnostics out;
  auto experiment = LoadExperiment(kExperiments + name + ".yaml", {}, out);
  if (!experiment) throw std::runtime_error(out.Format());
  experiment->duration_s = duration_s;
  return *experiment;
}

/// Worlds with different gains, masses, friction, starts
std::vector<RolloutWorld> Varied(const ExperimentSpec& experiment, int count) {
  std::vector<RolloutWorld> worlds;
  for (int i = 0; i < count; ++i) {
    RolloutWorld world = WorldOf(experiment);
    world.seed = static_cast<std::uint64_t>(100 + i);
    for (ImpedanceGains& gains : world.controllers[0].impedance->cables) {
      gains.tension_offset_n *= 1 + 0.02 * i;
    }
    if (auto& input = world.controllers[0].velocity_input) {
      for (const GaitValue& value : GaitValues(input->gait)) *value.value *= 1 + 0.001 * i;
    }
    if (i > 0) {
      world.scales.push_back({ScaleSpec::Quantity::kMass, {}, 1 + 0.01 * i});
      world.scales.push_back({ScaleSpec::Quantity::kFriction, {}, 1 - 0.01 * i});
      world.scales.push_back({ScaleSpec::Quantity::kStiffness, {i % 12}, 1.1});
      world.scales.push_back({ScaleSpec::Quantity::kDamping, {}, 0.9});
      world.start_noise.position_m = 0.001, world.start_noise.heading_rad = 0.1;
    }
    worlds.push_back(world);
  }
  return worlds;
}

std::vector<RolloutResult> RunAll(const ExperimentSpec& experiment,
                                  const std::vector<RolloutWorld>& worlds, int threads, Simd simd) {
  Diagnostics out;
  RolloutOptions options;
  options.threads = threads;
  options.simd = simd;
  return Rollouts::Create(experiment, {}, options, out)->Run(worlds);
}

void EveryWorldEqualsItsRun(const ExperimentSpec& experiment) {
  const auto worlds = Varied(experiment, 11);
  std::vector<RunSummary> alone;
  for (const RolloutWorld& world : worlds) {
    Diagnostics out;
    alone.push_back(*RunExperiment(ExperimentOf(experiment, world), {}, out));
  }
  for (const auto& [name, simd] : test::kInstructionSets) {
    for (const int threads : {1, 3}) {
      const auto results = RunAll(experiment, worlds, threads, simd);
      for (std::size_t i = 0; i < worlds.size(); ++i) {
        ASSERT_EQ(results[i].failed, "");
        EXPECT_EQ(results[i].state_hash, alone[i].state_hash) << i << ", " << name;
        double energy_j = 0;
        for (const CableSummary& cable : alone[i].cables) energy_j += cable.energy_j;
        // the sums over cables and steps have another order
        EXPECT_NEAR(results[i].energy_j, energy_j, 1e-9 * energy_j);
        EXPECT_NE(results[i].state_hash, results[(i + 1) % worlds.size()].state_hash);
      }
    }
  }
}

TEST(Rollout, EveryWorldGoesThroughTheBitsOfARunOfItsOwn) {
  EveryWorldEqualsItsRun(LoadVariants("push_20n", 0.7));
}

TEST(Rollout, SoItDoesWithPushesStepsOffTheTicksAndAPid) {
  ExperimentSpec experiment = LoadVariants("push_20n", 0.35);
  experiment.step_s = 0.0007;
  experiment.controllers[0].clock = {0.002, 0.0005};
  ImpedanceSpec& impedance = *experiment.controllers[0].impedance;
  impedance.conversion = TensionConversion::kPid;
  impedance.pid = {0.01, 0.02, 0.0001};
  impedance.differenced_rate = impedance.start_from_rest_length = true;
  for (PushSpec& push : experiment.pushes) push.force_n = {{0.1, 0}, {0.15, 20}, {0.2111, 0}};
  experiment.drags.push_back({"drag", 0, {0.1, 0, 0}, 100, 10, 0.05, 0.3});
  EveryWorldEqualsItsRun(experiment);
}

TEST(Rollout, SoItDoesWithSensors) {
  ExperimentSpec experiment = LoadVariants("push_20n", 0.35);
  experiment.sensors = SensorSpec{};
  experiment.sensors->load_cell = LoadCellSpec{0.1, 0.2, 0.0, 50.0, 0.05, 0.003};
  experiment.sensors->encoder = EncoderSpec{1e-5, 0.001};
  experiment.sensors->length_from_tension = true;
  EveryWorldEqualsItsRun(experiment);
}

TEST(Rollout, SoItDoesWithASineGait) {
  EveryWorldEqualsItsRun(LoadVariants("sine_hand_tuned", 0.5));
}

TEST(Rollout, SoItDoesWithOscillatorsThatFeel) {
  ExperimentSpec experiment = LoadVariants("cpg_learned", 0.4);
  experiment.controllers[0].velocity_input->gait.cpg->feedback = CpgFeedback{0.1, 10.0};
  EveryWorldEqualsItsRun(experiment);
}

TEST(Rollout, SoItDoesFromASettledStart) {
  ExperimentSpec experiment = LoadVariants("push_20n", 0.02);
  experiment.start = StartKind::kSettledFloating;
  experiment.robot.def.planes[0].point_m.z = -0.02;  // its ends move down while it settles
  EveryWorldEqualsItsRun(experiment);
}

TEST(Rollout, AWorldThatCannotStartFailsAlone) {
  ExperimentSpec experiment = LoadVariants("push_20n", 0.1);
  experiment.start = StartKind::kSettled;
  // a body of almost no mass: its first step is not finite
  auto worlds = Varied(experiment, 3);
  worlds[1].scales.push_back({ScaleSpec::Quantity::kMass, {0}, 1e-310});
  const auto results = RunAll(experiment, worlds, 1, BestSimd());
  EXPECT_EQ(results[0].failed, "");
  EXPECT_NE(results[1].failed, "");
  EXPECT_TRUE(std::isnan(results[1].score));
  EXPECT_EQ(results[2].failed, "");
}

}  // namespace
}  // namespace taut
