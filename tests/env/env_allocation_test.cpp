// A step of an environment allocates nothing.
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

long OfSteps(const ExperimentSpec& experiment, int threads, int steps) {
  const auto env = MakeEnv(experiment, {.worlds = 37, .threads = threads});
  Arrays<float> arrays(*env);
  for (int i = 0; i < 2; ++i) arrays.Step(*env);  // controllers have had their first ticks
  const long before = allocations;
  for (int i = 0; i < steps; ++i) {
    Wiggle(arrays, i);
    arrays.Step(*env);
  }
  return allocations - before;
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
    EXPECT_EQ(OfSteps(spine, threads, 50), 0);
    EXPECT_EQ(OfSteps(held, threads, 50), 0);
  }
}

TEST_F(EnvAllocation, IsCounted) {
  ExperimentSpec spine = LoadFrom("learn_spine", 1);
  spine.environment->observations = {"system/contact_count"};
  EXPECT_GT(OfSteps(spine, 1, 5), 0);
}

}  // namespace
}  // namespace taut::test
