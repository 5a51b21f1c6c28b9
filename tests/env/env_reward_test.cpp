// Rewards of environment steps, which sum to a study's score, and early terminations
#include <limits>

#include "env/env_fixture.h"
#include "taut/rollout.h"
#include "tests/constants.h"

namespace taut::test {
namespace {

/// Returns the result of a study's rollout with this objective.
RolloutResult StudyResult(const ExperimentSpec& experiment, const ObjectiveSpec& objective) {
  Diagnostics out;
  const auto rollouts = Rollouts::Create(experiment, objective, {}, out);
  const std::vector<RolloutWorld> world{WorldOf(experiment)};
  return rollouts->Run(world)[0];
}

/// Returns the rewards of an episode without actions.
std::vector<double> Rewards(const ExperimentSpec& experiment) {
  const auto env = MakeEnv(experiment, {.worlds = 2, .randomise = false});
  Arrays<> arrays(*env);
  std::vector<double> rewards;
  for (std::int64_t i = 0; i < env->episode_steps(); ++i) {
    arrays.Step(*env);
    rewards.push_back(arrays.rewards[1]);
  }
  return rewards;
}

double Sum(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double x : numbers) sum += x;
  return sum;
}

/// A robot that moves without actions: the experiment contains its gait.
ExperimentSpec Moving(double duration_s) {
  ExperimentSpec experiment = LoadFrom("sine_hand_tuned", duration_s);
  EnvironmentSpec& spec = experiment.environment.emplace();
  spec.period_s = 0.1;
  spec.observations = {"system/com_*"};
  return experiment;
}

TEST(EnvReward, RewardsOfAnEpisodeAddUpToTheScoreOfAStudy) {
  ExperimentSpec experiment = Moving(2);
  experiment.goal = GoalSpec{{3, 1, 0}, 1, {1, 0, 0}, GoalFrame::kOfWorld, 0.01};
  EnvironmentReward& reward = experiment.environment->reward;
  for (const Measure measure : {Measure::kDistance, Measure::kHeading, Measure::kNearer}) {
    for (const double from_s : {0.0, 0.5}) {
      reward.measure = measure;
      reward.direction = {0.6, 0.8, 0};
      reward.from_s = from_s;
      reward.tension_limit = TensionLimit{15, 0.01};
      const RolloutResult study = StudyResult(experiment, reward);
      ASSERT_EQ(study.failed, "");
      ASSERT_GT(study.max_tension_n, 15);
      const std::vector<double> rewards = Rewards(experiment);
      // rounding of sums of 20 differences of numbers below 5
      EXPECT_NEAR(Sum(rewards), study.score, 20 * 5 * 2.3e-16);
      EXPECT_NE(rewards[10], rewards[15]);
    }
  }
}

TEST(EnvReward, WorkAndTimeArePaidForAsTheyPass) {
  ExperimentSpec experiment = Moving(2);
  const RolloutResult study = StudyResult(experiment, {});
  ASSERT_GT(study.energy_j, 0.01);
  experiment.environment->reward.work_penalty_per_j = 0.5;
  EXPECT_NEAR(Sum(Rewards(experiment)), -0.5 * study.energy_j, 1e-13 * study.energy_j);
  experiment.environment->reward.work_penalty_per_j = 0;
  experiment.environment->reward.alive_per_s = 3;
  EXPECT_EQ(Rewards(experiment), std::vector<double>(20, 3 * 0.1));
}

/// The six-strut robot in free fall, its ground far below
ExperimentSpec Falling(double duration_s) {
  ExperimentSpec experiment = LoadFrom("drop_six_strut", duration_s);
  experiment.robot.def.planes[0].point_m.z = -100;
  EnvironmentSpec& spec = experiment.environment.emplace();
  spec.period_s = 0.01;
  spec.observations = {"system/com_*", "body/*", "cable/*"};
  spec.reward.alive_per_s = 1;
  return experiment;
}

struct Ended {
  EpisodeState state;
  std::vector<double> rewards;
};
Ended RunToTheEnd(const ExperimentSpec& experiment, EnvOptions options = {}) {
  options.worlds = 3;
  options.randomise = false;
  options.autoreset = Autoreset::kDisabled;
  const auto env = MakeEnv(experiment, options);
  Arrays<> arrays(*env);
  Ended ended;
  for (std::int64_t i = 0; i < env->episode_steps(); ++i) {
    arrays.Step(*env);
    EXPECT_TRUE(arrays.AllFinite());
    ended.rewards.push_back(arrays.rewards[2]);
    const bool over = env->Episode(2).end > EpisodeEnd::kTime;
    EXPECT_EQ(arrays.terminated[2], over ? 1 : 0);
    if (over) break;
  }
  ended.state = env->Episode(2);
  return ended;
}

/// Returns the first period that ends after a fall from rest has lasted longer than `fall_s`.
std::int64_t PeriodAfter(double fall_s) {
  return static_cast<std::int64_t>(std::floor(fall_s / 0.01)) + 1;
}

TEST(EnvReward, AContactThatIsNotThereIsSeenAsZeros) {
  ExperimentSpec experiment = Falling(0.1);
  experiment.record.contacts = 2;
  experiment.environment->observations = {"contact/*"};
  const auto env = MakeEnv(experiment, {.worlds = 2});
  Arrays<> arrays(*env);
  arrays.Step(*env);
  EXPECT_EQ(arrays.observations, std::vector<double>(2 * 2 * 9, 0.0));
}

TEST(EnvReward, AFallEndsAnEpisodeWhenTheClosedFormSaysSo) {
  ExperimentSpec experiment = Falling(1);
  EnvironmentReward& reward = experiment.environment->reward;
  const auto env = MakeEnv(experiment, {});
  Arrays<> arrays(*env);
  EXPECT_TRUE(arrays.Reset(*env));
  const double height_m = arrays.observations[arrays.width - 1];
  reward.fall.emplace().min_height_m = height_m - 0.3;
  reward.fall->penalty = 2;
  const Ended ended = RunToTheEnd(experiment);
  EXPECT_EQ(ended.state.end, EpisodeEnd::kFell);
  EXPECT_EQ(ended.state.steps, PeriodAfter(std::sqrt(2 * 0.3 / kG)));
  EXPECT_DOUBLE_EQ(ended.rewards.back(), 0.01 - 2);
  EXPECT_DOUBLE_EQ(ended.state.reward, Sum(ended.rewards));
}

TEST(EnvReward, ABlownUpWorldFails) {
  ExperimentSpec experiment = Falling(1);
  experiment.robot.def.cables.clear();  // struts that fall separately, without rotation
  experiment.robot.cable_tags.clear();
  experiment.robot.cable_sources.clear();
  for (BodyDef& body : experiment.robot.def.bodies) {
    body.velocity_m_per_s = body.angular_velocity_rad_per_s = {};
  }
  experiment.environment->observations = {"system/com_*", "body/*"};
  experiment.environment->reward.max_speed_m_per_s = 2.5;
  experiment.environment->reward.failure_penalty = 4;
  const Ended ended = RunToTheEnd(experiment);
  EXPECT_EQ(ended.state.end, EpisodeEnd::kTooFast);
  EXPECT_EQ(ended.state.steps, PeriodAfter(2.5 / kG));
  EXPECT_EQ(ended.rewards.back(), -4);
}

TEST(EnvReward, ACableThatPullsTooHardFails) {
  ExperimentSpec experiment = Moving(2);
  const RolloutResult study = StudyResult(experiment, {});
  experiment.environment->reward.failure_penalty = 1;
  experiment.environment->max_tension_n = study.max_tension_n * (1 + 1e-12);
  EXPECT_EQ(RunToTheEnd(experiment).state.end, EpisodeEnd::kTime);
  experiment.environment->max_tension_n = study.max_tension_n * (1 - 1e-12);
  EXPECT_EQ(RunToTheEnd(experiment).state.end, EpisodeEnd::kTooTense);
}

TEST(EnvReward, AWorldThatIsNotFiniteEndsWithFiniteNumbersAndTheOthersGoOn) {
  ExperimentSpec experiment = LoadFrom("learn_spine", 1);
  EnvironmentSpec& spec = *experiment.environment;
  spec.randomise = {};
  spec.observations = {"*"};
  spec.reward.measure = Measure::kDistance;
  spec.reward.failure_penalty = 3;
  spec.reward.tension_limit = TensionLimit{1, 1};
  spec.reward.work_penalty_per_j = 1;
  // A motor of unlimited speed that pays out without end; files do not allow it.
  CableDef& cable = experiment.robot.def.cables[0];
  cable.actuator = {};
  cable.actuator.kind = ActuatorDef::Kind::kIdeal;
  spec.actions[0].rest_length_m.reset();
  spec.actions[0].rest_length_rate_m_per_s = std::numeric_limits<double>::infinity();
  for (const Autoreset autoreset : {Autoreset::kNextStep, Autoreset::kSameStep}) {
    const auto env = MakeEnv(experiment, {.worlds = 3, .autoreset = autoreset});
    const auto calm = MakeEnv(experiment, {.worlds = 3, .autoreset = autoreset});
    Arrays<float> arrays(*env), calms(*calm);
    arrays.actions[arrays.action_width] = 1;
    bool ended = false;
    for (int step = 0; step < 10; ++step) {
      arrays.Step(*env, autoreset == Autoreset::kSameStep);
      calms.Step(*calm, autoreset == Autoreset::kSameStep);
      ASSERT_TRUE(arrays.AllFinite());
      for (const float x : arrays.finals) ASSERT_TRUE(std::isfinite(x));
      if (arrays.terminated[1] != 0 && !ended) {
        EXPECT_EQ(arrays.rewards[1], -3);
        const EpisodeState over =
            autoreset == Autoreset::kSameStep ? env->Last(1) : env->Episode(1);
        EXPECT_EQ(over.end, EpisodeEnd::kNotFinite);
        ended = true;
        arrays.actions[arrays.action_width] = 0;
      }
      ASSERT_EQ(arrays.Row(0), calms.Row(0));
      ASSERT_EQ(arrays.Row(2), calms.Row(2));
      EXPECT_EQ(arrays.terminated[0], 0);
    }
    EXPECT_TRUE(ended);
    EXPECT_EQ(env->Status(1).bits & kStatusNonFinite, 0u);  // the next episode is finite
    EXPECT_EQ(env->Episode(1).end, EpisodeEnd::kNone);
  }
}

TEST(EnvReward, AnActionThatIsNoNumberFails) {
  const ExperimentSpec experiment = LoadFrom("learn_spine", 1);
  const auto env = MakeEnv(experiment, {.worlds = 2, .randomise = false});
  const auto calm = MakeEnv(experiment, {.worlds = 2, .randomise = false});
  Arrays<float> arrays(*env), calms(*calm);
  arrays.actions[3] = std::numeric_limits<float>::quiet_NaN();
  arrays.Step(*env);
  calms.Step(*calm);
  EXPECT_EQ(env->Episode(0).end, EpisodeEnd::kWrongAction);
  EXPECT_EQ(arrays.terminated[0], 1);
  EXPECT_EQ(arrays.rewards[0], -1);
  EXPECT_EQ(env->Hash(0), calm->Hash(0));  // NaN counted as 0
  EXPECT_EQ(env->Episode(1).end, EpisodeEnd::kNone);
}

TEST(EnvReward, WhatIsBeyondTheEndsCountsAsTheEnd) {
  const ExperimentSpec experiment = LoadFrom("learn_spine", 1);
  const auto env = MakeEnv(experiment, {.worlds = 3, .randomise = false});
  Arrays<> arrays(*env);
  std::fill_n(arrays.actions.begin(), arrays.action_width, 1.0);
  std::fill_n(arrays.actions.begin() + static_cast<std::ptrdiff_t>(arrays.action_width),
              arrays.action_width, 50.0);
  arrays.Step(*env);
  EXPECT_EQ(env->Hash(0), env->Hash(1));
  EXPECT_NE(env->Hash(0), env->Hash(2));
}

TEST(EnvReward, AnActionOfOneIsWhatTheFileSays) {
  ExperimentSpec experiment = LoadFrom("learn_spine", 1);
  experiment.environment->observations = {"cable/*/target_rest_length_m"};
  const auto env = MakeEnv(experiment, {.worlds = 2, .randomise = false});
  Arrays<> arrays(*env);
  for (std::size_t i = 0; i < arrays.action_width; ++i) arrays.actions[i] = 0.5;
  for (int step = 0; step < 3; ++step) arrays.Step(*env);
  for (std::size_t i = 0; i < arrays.action_width; ++i) {
    // rounding of lengths below 0.5 m
    EXPECT_NEAR(arrays.Row(0)[i] - arrays.Row(1)[i], 0.5 * 0.03, 1.2e-16);
  }
  EXPECT_EQ(env->action_channels()[0].unit, "m");
  EXPECT_EQ(env->action_scales()[0], 0.03);
  for (EnvironmentAction& action : experiment.environment->actions) {
    action.rest_length_m.reset();
    action.rest_length_rate_m_per_s = 0.4;
  }
  const auto rate = MakeEnv(experiment, {.worlds = 2, .randomise = false});
  for (int step = 0; step < 3; ++step) arrays.Step(*rate);
  for (std::size_t i = 0; i < arrays.action_width; ++i) {
    // three periods of 10 ms at half the rate
    EXPECT_NEAR(arrays.Row(0)[i] - arrays.Row(1)[i], 3 * 0.01 * 0.5 * 0.4, 1e-15);
  }
}

}  // namespace
}  // namespace taut::test
