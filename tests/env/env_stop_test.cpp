// Long steps of environments that their caller stops
#include "env/env_fixture.h"

namespace taut::test {
namespace {

/// An environment whose only step takes some tenths of a second
ExperimentSpec LongStep() {
  ExperimentSpec experiment = LoadFrom("learn_spine", 40);
  experiment.environment->period_s = 20;
  experiment.environment->randomise = {};
  experiment.environment->max_tension_n.reset();
  return experiment;
}

TEST(EnvStop, PollingChangesNoBits) {
  const auto plain = MakeEnv(LongStep(), {.worlds = 20, .threads = 2});
  int polls = 0;
  EnvOptions options{.worlds = 20, .threads = 2};
  options.keep_going = [&polls] { return ++polls > 0; };
  const auto polled = MakeEnv(LongStep(), options);
  Arrays<> of_plain(*plain), of_polled(*polled);
  for (int step = 0; step < 2; ++step) {
    of_plain.Step(*plain), of_polled.Step(*polled);
    for (int w = 0; w < 20; ++w) EXPECT_EQ(plain->Hash(w), polled->Hash(w)) << w;
    EXPECT_EQ(of_plain.observations, of_polled.observations);
    EXPECT_EQ(of_plain.rewards, of_polled.rewards);
  }
  EXPECT_GT(polls, 0);
}

TEST(EnvStop, AStoppedStepNeedsAResetOfAllWorlds) {
  bool goes = true;
  EnvOptions options{.worlds = 20, .threads = 2};
  options.keep_going = [&goes] { return goes; };
  const auto env = MakeEnv(LongStep(), options);
  Arrays<> arrays(*env);
  const std::vector<std::uint64_t> seeds(20, 5);
  ASSERT_TRUE(arrays.Reset(*env, seeds));
  const std::uint64_t start = env->Hash(3);
  const EnvStep<double> out{
      arrays.observations, arrays.rewards, arrays.terminated, arrays.truncated, {}};
  const std::span<const double> actions(arrays.actions);
  goes = false;
  EXPECT_FALSE(env->Step(actions, out));
  goes = true;
  EXPECT_FALSE(env->Step(actions, out));
  std::vector<std::uint8_t> some(20, 1);
  some[7] = 0;
  Diagnostics found;
  EXPECT_FALSE(env->Reset(seeds, some, std::span<double>(arrays.observations), found));
  EXPECT_EQ(found.Format(), "error: the last step was stopped before its end (reset all worlds)\n");
  ASSERT_TRUE(arrays.Reset(*env, seeds));
  EXPECT_EQ(env->Hash(3), start);
  ASSERT_TRUE(env->Step(actions, out));
  const auto fresh = MakeEnv(LongStep(), {.worlds = 20});
  Arrays<> others(*fresh);
  ASSERT_TRUE(others.Reset(*fresh, seeds));
  others.Step(*fresh);
  for (int w = 0; w < 20; ++w) EXPECT_EQ(env->Hash(w), fresh->Hash(w)) << w;
  EXPECT_EQ(arrays.observations, others.observations);
  EXPECT_EQ(arrays.rewards, others.rewards);
}

}  // namespace
}  // namespace taut::test
