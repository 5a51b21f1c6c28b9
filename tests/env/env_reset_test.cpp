// Start and end of episodes in Gymnasium's three autoreset modes
#include "env/env_fixture.h"

namespace taut::test {
namespace {

/// Returns an experiment with episodes of five steps that differ by their seeds.
ExperimentSpec Short() {
  ExperimentSpec experiment = LoadFrom("learn_spine", 0.05);
  experiment.environment->randomise.action_delay_s = 0;
  return experiment;
}

EnvOptions With(Autoreset autoreset, int worlds = 5) {
  return {.worlds = worlds, .autoreset = autoreset, .seed = 7};
}

/// The rows of a new environment after a reset with these seeds and then some steps
struct Fresh {
  Fresh(const ExperimentSpec& experiment, const std::vector<std::uint64_t>& seeds)
      : env(MakeEnv(experiment, With(Autoreset::kDisabled, static_cast<int>(seeds.size())))),
        arrays(*env) {
    EXPECT_TRUE(arrays.Reset(*env, seeds));
  }
  std::unique_ptr<Env> env;
  Arrays<> arrays;
};

TEST(EnvReset, NextStepBeginsInTheStepAfterAndIgnoresItsAction) {
  const ExperimentSpec experiment = Short();
  const auto env = MakeEnv(experiment, With(Autoreset::kNextStep));
  ASSERT_EQ(env->episode_steps(), 5);
  Arrays<> arrays(*env);
  for (int step = 1; step <= 5; ++step) {
    Wiggle(arrays, step);
    arrays.Step(*env);
    EXPECT_EQ(arrays.truncated[2], step == 5 ? 1 : 0);
    EXPECT_EQ(arrays.terminated[2], 0);
    EXPECT_EQ(env->Episode(2).steps, step);
  }
  const std::uint64_t old_seed = env->Episode(2).seed;
  const double earned = env->Episode(2).reward;
  EXPECT_EQ(env->Episode(2).end, EpisodeEnd::kTime);
  std::fill(arrays.actions.begin(), arrays.actions.end(), 1.0);
  arrays.Step(*env);
  EXPECT_EQ(arrays.truncated[2], 0);
  EXPECT_EQ(arrays.rewards[2], 0);
  EXPECT_EQ(env->Episode(2).steps, 0);
  EXPECT_EQ(env->Time(2), 0);
  EXPECT_NE(env->Episode(2).seed, old_seed);
  EXPECT_EQ(env->Last(2).seed, old_seed);
  EXPECT_EQ(env->Last(2).steps, 5);
  EXPECT_EQ(env->Last(2).reward, earned);
  Fresh fresh(experiment, {env->Episode(2).seed});
  EXPECT_EQ(arrays.Row(2), fresh.arrays.Row(0));
  // subsequent steps equal the steps after a reset
  for (int step = 0; step < 3; ++step) {
    Wiggle(arrays, step);
    Wiggle(fresh.arrays, step, 2);
    arrays.Step(*env);
    fresh.arrays.Step(*fresh.env);
    EXPECT_EQ(arrays.Row(2), fresh.arrays.Row(0));
    EXPECT_EQ(arrays.rewards[2], fresh.arrays.rewards[0]);
    EXPECT_EQ(env->Hash(2), fresh.env->Hash(0));
  }
}

TEST(EnvReset, SameStepReturnsTheNextEpisodesFirstObservationAndTheLast) {
  const ExperimentSpec experiment = Short();
  const auto env = MakeEnv(experiment, With(Autoreset::kSameStep));
  const auto other = MakeEnv(experiment, With(Autoreset::kDisabled));
  Arrays<> arrays(*env), others(*other);
  for (int step = 0; step < 5; ++step) {
    Wiggle(arrays, step);
    others.actions = arrays.actions;
    arrays.Step(*env, true);
    others.Step(*other);
  }
  EXPECT_EQ(arrays.truncated, std::vector<std::uint8_t>(5, 1));
  EXPECT_EQ(arrays.rewards, others.rewards);
  for (std::size_t w = 0; w < 5; ++w) {
    EXPECT_EQ(arrays.Final(w), others.Row(w));
    const Fresh fresh(experiment, {env->Episode(static_cast<int>(w)).seed});
    EXPECT_EQ(arrays.Row(w), fresh.arrays.Row(0));
  }
  // rows of final observations of worlds whose episode continues are not written
  std::fill(arrays.finals.begin(), arrays.finals.end(), -7.0);
  arrays.Step(*env, true);
  EXPECT_EQ(arrays.finals, std::vector<double>(arrays.finals.size(), -7.0));
  EXPECT_EQ(env->Episode(0).steps, 1);
}

TEST(EnvReset, DisabledWaitsForSomebodyToAsk) {
  const ExperimentSpec experiment = Short();
  const auto env = MakeEnv(experiment, With(Autoreset::kDisabled));
  Arrays<> arrays(*env);
  for (int step = 0; step < 5; ++step) arrays.Step(*env);
  for (int step = 0; step < 3; ++step) {
    arrays.Step(*env);
    EXPECT_EQ(arrays.truncated, std::vector<std::uint8_t>(5, 1));
    EXPECT_EQ(arrays.rewards, std::vector<double>(5, 0.0));
  }
  EXPECT_EQ(env->Episode(1).steps, 5);
  const std::uint64_t seed_of_0 = env->Episode(0).seed;
  const std::vector<double> row_of_0 = arrays.Row(0);
  const std::vector<std::uint64_t> seeds{1, 2, 3, 4, 5};
  const std::vector<std::uint8_t> mask{0, 1, 0, 1, 0};
  EXPECT_TRUE(arrays.Reset(*env, seeds, mask));
  EXPECT_EQ(arrays.Row(0), row_of_0);  // not written
  EXPECT_EQ(env->Episode(0).seed, seed_of_0);
  EXPECT_EQ(env->Episode(1).seed, 2u);
  EXPECT_EQ(env->Episode(3).seed, 4u);
  const Fresh fresh(experiment, {2, 4});
  EXPECT_EQ(arrays.Row(1), fresh.arrays.Row(0));
  EXPECT_EQ(arrays.Row(3), fresh.arrays.Row(1));
  arrays.Step(*env);
  EXPECT_EQ(arrays.truncated, (std::vector<std::uint8_t>{1, 0, 1, 0, 1}));
}

TEST(EnvReset, AMaskedResetLeavesTheOthersAloneToTheBit) {
  const ExperimentSpec experiment = Short();
  const auto env = MakeEnv(experiment, With(Autoreset::kNextStep, 9)),
             calm = MakeEnv(experiment, With(Autoreset::kNextStep, 9));
  Arrays<> arrays(*env), calms(*calm);
  std::vector<std::uint8_t> mask(9);
  mask[4] = 1;
  for (int step = 0; step < 12; ++step) {
    if (step == 2 || step == 9) {
      EXPECT_TRUE(arrays.Reset(*env, {}, mask));
    }
    Wiggle(arrays, step);
    calms.actions = arrays.actions;
    arrays.Step(*env);
    calms.Step(*calm);
    for (int w = 0; w < 9; ++w) {
      if (w == 4) continue;
      ASSERT_EQ(env->Hash(w), calm->Hash(w)) << w << ", " << step;
      ASSERT_EQ(arrays.Row(static_cast<std::size_t>(w)), calms.Row(static_cast<std::size_t>(w)));
    }
  }
}

TEST(EnvReset, SeedsCountModuloTheNumberOfStarts) {
  ExperimentSpec experiment = Short();
  experiment.environment->randomise.starts = 3;
  const auto env = MakeEnv(experiment, With(Autoreset::kNextStep, 7));
  Arrays<> arrays(*env);
  EXPECT_TRUE(arrays.Reset(*env, std::vector<std::uint64_t>{0, 1, 2, 3, 4, 300, 301}));
  EXPECT_EQ(arrays.Row(0), arrays.Row(3));
  EXPECT_EQ(arrays.Row(1), arrays.Row(4));
  EXPECT_EQ(arrays.Row(0), arrays.Row(5));
  EXPECT_NE(arrays.Row(0), arrays.Row(1));
  EXPECT_NE(arrays.Row(1), arrays.Row(2));
  EXPECT_EQ(env->Episode(6).seed, 1u);
  std::vector<int> met(3);
  for (int step = 0; step < 180; ++step) {  // thirty episodes, whose seeds do not cycle
    arrays.Step(*env);
    if (env->Episode(0).steps == 0) ++met[env->Episode(0).seed];
  }
  for (const int times : met) EXPECT_GT(times, 2);
}

TEST(EnvReset, AStartThatIsNoneIsSaidAndTheWorldGoesOn) {
  ExperimentSpec experiment = Short();
  experiment.environment->randomise = {};
  experiment.environment->randomise.start.any_pose = true;  // some poses penetrate the ground
  experiment.robot.def.planes[0].point_m.z = -0.15;
  Diagnostics out;
  std::unique_ptr<Env> env;
  std::uint64_t seed = 0;
  for (; !env && seed < 200; ++seed) {  // the first seed with a valid start
    env = Env::Create(experiment, {.worlds = 1, .seed = seed}, out = {});
  }
  ASSERT_TRUE(env);
  Arrays<> arrays(*env);
  const std::uint64_t hash = env->Hash(0);
  int refused = 0;
  for (std::uint64_t other = 0; other < 50 && refused == 0; ++other) {
    const std::vector<std::uint64_t> seeds{other};
    if (env->Reset(seeds, {}, std::span<double>(arrays.observations), out = {})) continue;
    ++refused;
    EXPECT_NE(out.Format().find("world 0 has no start with the seed " + std::to_string(other)),
              std::string::npos)
        << out.Format();
    EXPECT_NE(env->Hash(0), 0u);
  }
  EXPECT_EQ(refused, 1) << hash;
  for (int step = 0; step < 40; ++step) arrays.Step(*env);  // no episode ends
  EXPECT_TRUE(arrays.AllFinite());
}

}  // namespace
}  // namespace taut::test
