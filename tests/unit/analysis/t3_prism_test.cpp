// Prism of Feron et al. (2023) with elastic struts: forces as calculated in the paper, in statics
// and in simulation
#include <gtest/gtest.h>

#include "taut/analysis.h"
#include "taut/spec.h"
#include "taut/world_batch.h"

namespace taut {
namespace {

ExperimentSpec Load() {
  Diagnostics out;
  const auto experiment =
      LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/t3_press.yaml", {}, out);
  EXPECT_TRUE(experiment) << out.Format();
  return experiment.value_or(ExperimentSpec{});
}

TEST(T3Prism, ItsStrutsBearWhatThePaperCalculated) {
  const ExperimentSpec experiment = Load();
  const Equilibrium alone = FindEquilibrium(experiment.robot.def);  // under prestress and weight
  ASSERT_TRUE(alone.found) << alone.why;
  const Equilibrium pressed = FindEquilibrium(experiment.robot.def, experiment.load_cases.at(1));
  ASSERT_TRUE(pressed.found) << pressed.why;
  for (std::size_t strut = 0; strut < 3; ++strut) {
    EXPECT_NEAR(pressed.bar_force_n[strut], -10815.4, 0.05);  // another program: 10.8154 kN
    EXPECT_NEAR(pressed.bar_force_n[strut], -10814, 5);       // digitized from the paper's curve
    EXPECT_NEAR(alone.bar_force_n[strut], -1500, 15);         // start of the paper's test
  }
}

TEST(T3Prism, SteppedItStaysInThatEquilibrium) {
  const ExperimentSpec experiment = Load();
  const LoadCaseSpec& loads = experiment.load_cases.at(1);
  const Equilibrium wanted = FindEquilibrium(experiment.robot.def, loads);
  ASSERT_TRUE(wanted.found) << wanted.why;
  Diagnostics out;
  WorldBatch world(Model::Compile(ModelAt(experiment.robot.def, wanted.pose), out), {});
  for (const auto& force : loads.forces) world.SetNodeForce(0, force.node, force.force_n);
  for (int n = 0; n < 1000; ++n) {
    world.Step(1e-3);
    for (int strut = 0; strut < 3; ++strut) {
      const JointDef& bar = experiment.robot.def.joints[static_cast<std::size_t>(strut)];
      const double force_n = bar.stiffness * (world.Joint(0, strut).coordinate - bar.rest);
      ASSERT_NEAR(force_n, wanted.bar_force_n[static_cast<std::size_t>(strut)], 0.01) << n;
    }
  }
}

}  // namespace
}  // namespace taut
