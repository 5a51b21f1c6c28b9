// User-defined observations, rewards and terminations, as callbacks on whole batches
#include <limits>

#include "env/env_fixture.h"
#include "tests/constants.h"

namespace taut::test {
namespace {

/// Calls and rows that the callbacks of five worlds have recorded
struct Callbacks {
  int observed = 0, judged = 0;
  std::vector<std::uint8_t> observed_rows, judged_rows;
};

EnvOptions With(Callbacks& calls, Autoreset autoreset) {
  EnvOptions options{.worlds = 5, .threads = 2, .autoreset = autoreset};
  options.randomise = false;
  options.own_observations = 2;
  options.observe = [&calls](const EnvView& view) {
    ++calls.observed;
    calls.observed_rows.assign(view.rows.begin(), view.rows.end());
    const std::size_t width = view.env.observation_channels().size();
    for (std::size_t w = 0; w < view.rows.size(); ++w) {
      if (view.rows[w] == 0) continue;
      double* const row = view.observations_f64.data() + w * width;
      row[width - 2] = 10 * row[0] + static_cast<double>(w);
      row[width - 1] = view.env.Time(static_cast<int>(w));
    }
  };
  options.judge = [&calls](const EnvView& view) {
    ++calls.judged;
    calls.judged_rows.assign(view.rows.begin(), view.rows.end());
    const std::size_t width = view.env.observation_channels().size();
    for (std::size_t w = 0; w < view.rows.size(); ++w) {
      view.rewards[w] += view.observations_f64[w * width + width - 1] + view.actions_f64[0];
      if (w == 3 && view.env.Episode(3).steps == 2) view.terminated[w] = 1;
      if (w == 4) view.rewards[w] = kNan;
    }
  };
  return options;
}

TEST(EnvCallback, SeesWhatIsThereAndHasTheLastWord) {
  Callbacks calls;
  const ExperimentSpec experiment = LoadFrom("learn_spine", 1);
  const auto env = MakeEnv(experiment, With(calls, Autoreset::kNextStep));
  Arrays<> arrays(*env);
  EXPECT_EQ(env->observation_channels()[arrays.width - 1].name, "own/1");
  EXPECT_TRUE(arrays.Reset(*env));
  EXPECT_EQ(calls.observed, 1);
  EXPECT_EQ(calls.judged, 0);
  EXPECT_EQ(arrays.Row(2)[arrays.width - 2], 10 * arrays.Row(2)[0] + 2);
  arrays.actions[0] = 0.25;
  arrays.Step(*env);
  EXPECT_EQ(calls.judged_rows, std::vector<std::uint8_t>(5, 1));
  EXPECT_EQ(arrays.Row(2)[arrays.width - 1], 0.01);
  const auto plain = MakeEnv(experiment, {.worlds = 5, .randomise = false});
  Arrays<> plains(*plain);
  plains.actions = arrays.actions;
  plains.Step(*plain);
  EXPECT_EQ(arrays.rewards[1], plains.rewards[1] + (0.01 + 0.25));
  EXPECT_EQ(env->Episode(1).reward, arrays.rewards[1]);
  // NaN reward: counts as 0 and terminates the episode
  EXPECT_EQ(arrays.rewards[4], 0);
  EXPECT_EQ(arrays.terminated, (std::vector<std::uint8_t>{0, 0, 0, 0, 1}));
  EXPECT_EQ(env->Episode(4).end, EpisodeEnd::kCalled);
  arrays.Step(*env);
  EXPECT_EQ(arrays.terminated, (std::vector<std::uint8_t>{0, 0, 0, 1, 0}));
  EXPECT_EQ(env->Episode(3).end, EpisodeEnd::kCalled);
  EXPECT_EQ(calls.judged_rows,
            (std::vector<std::uint8_t>{1, 1, 1, 1, 0}));  // world 4 started a new episode
  EXPECT_EQ(arrays.Row(4)[arrays.width - 1], 0);
  EXPECT_EQ(arrays.rewards[4], 0);
  arrays.Step(*env);
  EXPECT_EQ(env->Episode(3).steps, 0);
  EXPECT_EQ(env->Last(3).steps, 2);
}

TEST(EnvCallback, IsAskedOnceMoreForRowsThatBeginInTheSameStep) {
  Callbacks calls;
  const auto env = MakeEnv(LoadFrom("learn_spine", 1), With(calls, Autoreset::kSameStep));
  Arrays<> arrays(*env);
  arrays.Step(*env, true);
  EXPECT_EQ(calls.observed, 2);
  EXPECT_EQ(calls.observed_rows, (std::vector<std::uint8_t>{0, 0, 0, 0, 1}));
  EXPECT_EQ(arrays.Row(4)[arrays.width - 1], 0);
  EXPECT_EQ(arrays.Final(4)[arrays.width - 1], 0.01);
  EXPECT_EQ(arrays.Row(1)[arrays.width - 1], 0.01);
}

TEST(EnvCallback, WhatItSaysIsFinite) {
  EnvOptions options{.worlds = 3};
  options.own_observations = 1;
  options.observe = [](const EnvView& view) {
    for (float& x : view.observations_f32) x = std::numeric_limits<float>::infinity();
  };
  const auto env = MakeEnv(LoadFrom("learn_spine", 1), options);
  Arrays<float> arrays(*env);
  EXPECT_TRUE(arrays.Reset(*env));
  EXPECT_TRUE(arrays.AllFinite());
  arrays.Step(*env);
  EXPECT_TRUE(arrays.AllFinite());
}

}  // namespace
}  // namespace taut::test
