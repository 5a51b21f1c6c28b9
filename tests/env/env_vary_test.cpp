// Domain randomization of episodes: factors, slope, delays
#include <algorithm>
#include <set>

#include "env/env_fixture.h"
#include "math/vec.h"

namespace taut::test {
namespace {

TEST(EnvVary, FactorsAndStartsStayWithinTheirSharesAndFillThem) {
  ExperimentSpec experiment = LoadFrom("learn_spine", 1);
  EnvironmentVariation& varied = experiment.environment->randomise = {};
  varied.friction = 0.3;
  varied.mass = 0.1;
  varied.stiffness = 0.2;
  varied.damping = 0.05;
  const auto env = MakeEnv(experiment, {.worlds = 200});
  const double shares[] = {0.3, 0.1, 0.2, 0.05};
  double least[4] = {1, 1, 1, 1}, most[4] = {1, 1, 1, 1};
  for (int w = 0; w < env->worlds(); ++w) {
    const ExperimentSpec own = env->Experiment(w);
    ASSERT_EQ(own.scales.size(), 4u);
    for (const ScaleSpec& scale : own.scales) {
      const auto k = static_cast<std::size_t>(scale.quantity);
      EXPECT_LE(std::fabs(scale.factor - 1), shares[k]);
      least[k] = std::min(least[k], scale.factor);
      most[k] = std::max(most[k], scale.factor);
    }
  }
  for (std::size_t k = 0; k < 4; ++k) {  // 200 uniform draws miss 0.9 of the range once in 1e9
    EXPECT_LT(least[k], 1 - 0.9 * shares[k]);
    EXPECT_GT(most[k], 1 + 0.9 * shares[k]);
  }
}

TEST(EnvVary, OnASlopeAFreeRobotFallsAslant) {
  ExperimentSpec experiment = LoadFrom("drop_six_strut", 0.2);
  experiment.robot.def.planes[0].point_m.z = -100;
  EnvironmentSpec& spec = experiment.environment.emplace();
  spec.period_s = 0.2;
  spec.observations = {"system/com_*"};
  spec.randomise.slope_rad = 0.3;
  const auto env = MakeEnv(experiment, {.worlds = 60, .autoreset = Autoreset::kDisabled});
  Arrays<> arrays(*env);
  EXPECT_TRUE(arrays.Reset(*env));
  const std::vector<double> before = arrays.observations;
  arrays.Step(*env);
  double steepest = 0;
  int quadrants[4] = {};
  for (std::size_t w = 0; w < arrays.worlds; ++w) {
    const Vec3 g = env->Experiment(static_cast<int>(w)).robot.def.gravity_m_per_s2;
    EXPECT_NEAR(Dot(g, g), 9.81 * 9.81, 1e-12);
    const double tilt = std::acos(-g.z / 9.81);
    EXPECT_LE(tilt, 0.3 + 1e-12);
    steepest = std::max(steepest, tilt);
    ++quadrants[(g.x > 0 ? 1 : 0) + (g.y > 0 ? 2 : 0)];
    const double fall[] = {g.x, g.y, g.z};
    for (std::size_t k = 0; k < 3; ++k) {
      // The integrator is exact for a parabola: only the rounding of 200 steps on numbers of size 1
      // remains.
      EXPECT_NEAR(arrays.Row(w)[k] - before[3 * w + k], 0.5 * 0.2 * 0.2 * fall[k], 1e-13);
    }
  }
  EXPECT_GT(steepest, 0.27);
  for (const int count : quadrants) EXPECT_GT(count, 4);
}

/// Returns the rows of world 0 under an action that changes from step to step and begins after
/// `late` steps.
std::vector<std::vector<double>> Rows(Env& env, int late, int steps) {
  Arrays<> arrays(env);
  EXPECT_TRUE(arrays.Reset(env, std::vector<std::uint64_t>(arrays.worlds, 3)));
  std::vector<std::vector<double>> rows{arrays.Row(0)};
  for (int step = 0; step < steps; ++step) {
    std::fill(arrays.actions.begin(), arrays.actions.end(), 0.0);
    if (step >= late) Wiggle(arrays, step - late);
    arrays.Step(env);
    rows.push_back(arrays.Row(0));
  }
  return rows;
}

/// An environment whose episodes differ by their delays only
ExperimentSpec Delayed(double action_delay_s, double observation_delay_s) {
  ExperimentSpec experiment = LoadFrom("learn_spine", 1);
  experiment.environment->randomise = {};
  experiment.environment->randomise.action_delay_s = action_delay_s;
  experiment.environment->randomise.observation_delay_s = observation_delay_s;
  return experiment;
}

constexpr int kVarySteps = 8;

/// Returns the rows of a world with this seed.
std::vector<std::vector<double>> RowsOf(const ExperimentSpec& experiment, std::uint64_t seed) {
  const auto env = MakeEnv(experiment, {.worlds = 1});
  Arrays<> arrays(*env);
  EXPECT_TRUE(arrays.Reset(*env, std::vector<std::uint64_t>{seed}));
  std::vector<std::vector<double>> rows{arrays.Row(0)};
  for (int step = 0; step < kVarySteps; ++step) {
    Wiggle(arrays, step);
    arrays.Step(*env);
    rows.push_back(arrays.Row(0));
  }
  return rows;
}

TEST(EnvVary, DelayedActionsActWholePeriodsLater) {
  const auto prompt = MakeEnv(Delayed(0, 0), {.worlds = 1});
  std::vector<std::vector<std::vector<double>>> expected;
  for (int late = 0; late <= 3; ++late) expected.push_back(Rows(*prompt, late, kVarySteps));
  std::set<std::ptrdiff_t> met;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const auto found = std::find(expected.begin(), expected.end(), RowsOf(Delayed(0.03, 0), seed));
    ASSERT_NE(found, expected.end()) << seed;
    met.insert(found - expected.begin());
  }
  EXPECT_EQ(met.size(), 4u);
}

TEST(EnvVary, DelayedObservationsAreThoseOfBefore) {
  const auto prompt = MakeEnv(Delayed(0, 0), {.worlds = 1});
  const auto rows = Rows(*prompt, 0, kVarySteps);
  std::set<int> met;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const auto late = RowsOf(Delayed(0, 0.02), seed);
    int fits = -1;
    for (int delay = 0; delay <= 2; ++delay) {
      bool same = true;
      for (int k = 0; k <= kVarySteps; ++k) {
        same = same && late[static_cast<std::size_t>(k)] ==
                           rows[static_cast<std::size_t>(std::max(k - delay, 0))];
      }
      if (same) fits = delay;
    }
    ASSERT_GE(fits, 0) << seed;
    met.insert(fits);
  }
  EXPECT_EQ(met.size(), 3u);
}

}  // namespace
}  // namespace taut::test
