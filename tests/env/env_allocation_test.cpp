// Memory allocations of environment steps: none
#include "env/env_fixture.h"
#include "tests/determinism/count_allocations.h"

namespace taut::test {
namespace {

class EnvAllocation : public testing::Test {
 protected:
  void SetUp() override {
#ifdef TAUT_SANITIZED
    GTEST_SKIP() << "this build's sanitizers have allocation functions of their own";
#endif
  }
};

/// Returns the number of allocations of the steps, from the first step of an episode on, with
/// worlds that begin at different times.
long OfSteps(const ExperimentSpec& experiment, int threads, int steps) {
  const auto env = MakeEnv(experiment, {.worlds = 37, .threads = threads});
  Arrays<float> arrays(*env);
  long made = 0;
  for (int i = 0; i < steps; ++i) {
    if (i == 3) {
      std::vector<std::uint8_t> mask(arrays.worlds);
      for (std::size_t w = 0; w < mask.size(); w += 3) mask[w] = 1;
      EXPECT_TRUE(arrays.Reset(*env, {}, mask));
    }
    Wiggle(arrays, i);
    const long before = allocations;
    arrays.Step(*env);
    made += allocations - before;
  }
  return made;
}

TEST_F(EnvAllocation, AStepInWhichNoEpisodeBeginsMakesNone) {
  ExperimentSpec spine = LoadFrom("learn_spine", 1);
  spine.environment->observations.insert(spine.environment->observations.end(),
                                         {"node/*", "system/com_*", "system/kinetic_j", "cable/*"});
  spine.environment->reward.tension_limit = TensionLimit{10, 1};
  ExperimentSpec held = LoadFrom("push_20n", 1);
  held.sensors.emplace().load_cell = LoadCellSpec{.noise_n = 0.1, .delay_s = 0.002};
  held.environment = spine.environment;
  held.environment->actions.clear();
  held.environment->observations = {"sensor/*", "cable/*/setpoint_n"};
  held.environment->actions.push_back({.cable = 2, .velocity_input_m_per_s = 0.1});
  for (const int threads : {1, 2}) {
    EXPECT_EQ(OfSteps(spine, threads, 30), 0);
    EXPECT_EQ(OfSteps(held, threads, 30), 0);
  }
}

TEST_F(EnvAllocation, NorDoFirstTicksOfGaitsWhoseNumbersActionsMove) {
  for (const auto& [name, number] : {std::pair{"sine_hand_tuned", "impedance.sine.frequency_hz"},
                                     {"cpg_learned", "impedance.cpg.frequency_hz"},
                                     {"rest_length_sine", "motion.sine.left.amplitude_m"},
                                     {"goal_flat", "motion.feedback_cpg.phase_gain_rad_per_s"},
                                     {"roll_to_goal", "motion.toward_goal.up_m"}}) {
    ExperimentSpec experiment = LoadFrom(name, 1);
    EnvironmentSpec& spec = experiment.environment.emplace();
    spec.period_s = 0.01;
    spec.observations = {"body/*/position_*"};
    EnvironmentAction& action = spec.actions.emplace_back();
    action.cable = kWorld;
    action.numbers = {number};
    action.by = 0.1;
    EXPECT_EQ(OfSteps(experiment, 1, 8), 0) << name;
  }
}

TEST_F(EnvAllocation, IsCounted) {
  ExperimentSpec spine = LoadFrom("learn_spine", 1);
  spine.environment->observations = {"system/contact_count"};
  EXPECT_GT(OfSteps(spine, 1, 5), 0);
}

}  // namespace
}  // namespace taut::test
