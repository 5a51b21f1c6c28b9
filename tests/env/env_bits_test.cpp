// Reproducibility of environments: a world's states depend, bit for bit, on its seed and actions
// only, and equal the experiment's run if there are no actions.
#include <array>

#include "env/env_fixture.h"
#include "taut/run.h"
#include "tests/instruction_sets.h"

namespace taut::test {
namespace {

/// An experiment with a gait, a sensor, pushes and impedance control, whose actions add to V0
ExperimentSpec Controlled(double duration_s) {
  ExperimentSpec experiment = LoadFrom("push_20n", duration_s);
  experiment.pushes.clear();
  experiment.pushes.push_back({"tap", 0, {0, 1, 0}, 1, {{0.05, 0}, {0.08, 8}, {0.12, 0}}});
  experiment.sensors = SensorSpec{};
  experiment.sensors->load_cell = LoadCellSpec{.noise_n = 0.5, .bias_n = 0.2, .delay_s = 0.003};
  EnvironmentSpec& spec = experiment.environment.emplace();
  spec.period_s = 0.02;
  for (const ImpedanceGains& gains : experiment.controllers[0].impedance->cables) {
    EnvironmentAction& action = spec.actions.emplace_back();
    action.cable = gains.cable;
    action.velocity_input_m_per_s = 0.05;
  }
  spec.observations = {"body/*", "sensor/*", "cable/*/setpoint_n", "push/*", "system/*", "node/*"};
  spec.reward.measure = Measure::kDistance;
  spec.reward.tension_limit = TensionLimit{20, 0.01};
  spec.reward.work_penalty_per_j = 0.1;
  return experiment;
}

EnvironmentVariation Everything() {
  EnvironmentVariation varied;
  varied.friction = 0.3;
  varied.mass = varied.stiffness = varied.damping = 0.1;
  varied.slope_rad = 0.1;
  varied.start.position_m = 0.003;
  varied.start.heading_rad = 0.2;
  varied.action_delay_s = varied.observation_delay_s = 0.04;
  return varied;
}

std::uint64_t HashOfRun(const ExperimentSpec& experiment) {
  Diagnostics out;
  const auto run = RunExperiment(experiment, {}, out);
  EXPECT_TRUE(run) << out.Format();
  return run ? run->state_hash : 0;
}

/// Steps all worlds to the end of their episodes, without actions.
void RunOut(Env& env) {
  Arrays<> arrays(env);
  for (std::int64_t i = 0; i < env.episode_steps(); ++i) arrays.Step(env);
}

TEST(EnvBits, WithoutActionsAWorldIsTheRun) {
  for (const char* const name : {"learn_spine", "learn_roll"}) {
    const ExperimentSpec experiment = LoadFrom(name, 0.4);
    const auto env = MakeEnv(experiment, {.worlds = 3, .randomise = false});
    RunOut(*env);
    EXPECT_EQ(env->Hash(0), HashOfRun(experiment)) << name;
    EXPECT_EQ(env->Hash(2), env->Hash(0)) << name;  // independent of the seed
  }
}

TEST(EnvBits, SoItIsWithControllersSensorsAndPushes) {
  ExperimentSpec experiment = Controlled(0.4);
  for (const bool measured : {true, false}) {  // after every step, or several steps at once
    if (!measured) experiment.environment->reward = {};
    for (const bool controlled : {true, false}) {
      ExperimentSpec own = experiment;
      if (!controlled) {
        own.controllers.clear();
        own.sensors.reset();
        own.environment->actions.clear();
        own.environment->observations = {"push/*"};
      } else if (!measured) {  // only control ticks between steps
        own.pushes.clear();
        own.environment->observations = {"sensor/*"};
      }
      const auto env = MakeEnv(own, {.worlds = 3, .seed = own.seed});
      RunOut(*env);
      EXPECT_EQ(env->Hash(0), HashOfRun(own)) << measured << controlled;
    }
  }
}

TEST(EnvBits, AnEpisodeKnowsNothingOfTheOneBefore) {
  ExperimentSpec experiment = Controlled(0.4);
  experiment.environment->randomise = Everything();
  const std::vector<std::uint64_t> seeds{5, 6, 7, 8, 9};
  const auto env = MakeEnv(experiment, {.worlds = 5}), fresh = MakeEnv(experiment, {.worlds = 5});
  Arrays<> arrays(*env), others(*fresh);
  for (int step = 0; step < 7; ++step) {
    Wiggle(arrays, 3 * step);
    arrays.Step(*env);
  }
  EXPECT_TRUE(arrays.Reset(*env, seeds));
  EXPECT_TRUE(others.Reset(*fresh, seeds));
  for (std::size_t i = 0; i < arrays.observations.size(); ++i) {
    ASSERT_EQ(arrays.observations[i], others.observations[i])
        << env->observation_channels()[i % arrays.width].name;
  }
  for (int step = 0; step < 8; ++step) {
    Wiggle(arrays, step);
    others.actions = arrays.actions;
    arrays.Step(*env);
    others.Step(*fresh);
    ASSERT_EQ(arrays.observations, others.observations) << step;
    ASSERT_EQ(arrays.rewards, others.rewards) << step;
  }
}

TEST(EnvBits, TheFirstObservationIsOfSensorsThatHaveSampled) {
  ExperimentSpec experiment = Controlled(0.4);
  experiment.sensors->load_cell.reset();
  experiment.environment->observations = {"cable/*/tension_n", "sensor/*/tension_n"};
  const auto env = MakeEnv(experiment, {.worlds = 2});
  Arrays<> arrays(*env);
  EXPECT_TRUE(arrays.Reset(*env));
  for (std::size_t i = 0; i < arrays.width / 2; ++i) {
    EXPECT_EQ(arrays.Row(1)[i], arrays.Row(1)[i + arrays.width / 2]);
  }
  EXPECT_GT(arrays.Row(1)[0], 0);
}

TEST(EnvBits, EveryEpisodeIsTheRunOfItsExperiment) {
  ExperimentSpec experiment = Controlled(0.3);
  experiment.environment->randomise = Everything();
  const auto env =
      MakeEnv(experiment, {.worlds = 5, .autoreset = Autoreset::kDisabled, .seed = 40});
  Arrays<> arrays(*env);
  for (int episode = 0; episode < 2; ++episode) {
    RunOut(*env);
    for (int w = 0; w < env->worlds(); ++w) {
      EXPECT_EQ(env->Hash(w), HashOfRun(env->Experiment(w))) << w;
    }
    EXPECT_NE(env->Hash(0), env->Hash(1));
    EXPECT_TRUE(arrays.Reset(*env));
  }
}

/// Returns hashes of all outputs of the worlds over some steps in which episodes end at different
/// times.
template <class T>
std::vector<std::uint64_t> Trail(const ExperimentSpec& experiment, EnvOptions options, int steps,
                                 std::vector<std::vector<T>>* rows = nullptr) {
  const auto env = MakeEnv(experiment, options);
  Arrays<T> arrays(*env);
  std::vector<std::uint64_t> trail;
  for (std::int64_t step = 0; step < steps; ++step) {
    if (step == 3) {  // from here on the worlds are at different times of their episodes
      std::vector<std::uint8_t> mask(arrays.worlds);
      for (std::size_t w = 0; w < mask.size(); w += 3) mask[w] = 1;
      EXPECT_TRUE(arrays.Reset(*env, {}, mask));
    }
    Wiggle(arrays, step);
    arrays.Step(*env);
    for (int w = 0; w < env->worlds(); ++w) {
      trail.push_back(env->Hash(w));
      if (rows) rows->push_back(arrays.Row(static_cast<std::size_t>(w)));
    }
  }
  return trail;
}

TEST(EnvBits, NeitherThreadsNorLanesNorKindsOfNumbersChangeThem) {
  ExperimentSpec experiment = Controlled(0.2);
  experiment.environment->randomise = Everything();
  constexpr int kSteps = 16;  // an episode has ten
  const EnvOptions alone{.worlds = 11, .threads = 1, .simd = Simd::kScalar};
  std::vector<std::vector<double>> rows;
  const auto expected = Trail<double>(experiment, alone, kSteps, &rows);
  for (const auto& [name, simd] : kInstructionSets) {
    for (const int threads : {1, 3}) {
      EnvOptions options = alone;
      options.simd = simd;
      options.threads = threads;
      std::vector<std::vector<double>> same;
      EXPECT_EQ(Trail<double>(experiment, options, kSteps, &same), expected) << name;
      EXPECT_EQ(same, rows) << name << ", " << threads << " threads";
    }
  }
  std::vector<std::vector<float>> in_float;
  EXPECT_EQ(Trail<float>(experiment, {.worlds = 11}, kSteps, &in_float), expected);
  ASSERT_EQ(in_float.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < rows[i].size(); ++k) {
      ASSERT_EQ(in_float[i][k], static_cast<float>(rows[i][k]));
    }
  }
}

TEST(EnvBits, AWorldAmongManyIsAsItIsAlone) {
  ExperimentSpec experiment = Controlled(0.2);
  experiment.environment->randomise = Everything();
  const auto many = MakeEnv(experiment, {.worlds = 13, .threads = 2, .seed = 100});
  const auto one = MakeEnv(experiment, {.worlds = 1, .seed = 109});
  Arrays<> of_many(*many), of_one(*one);
  for (int step = 0; step < 25; ++step) {
    Wiggle(of_many, step);
    Wiggle(of_one, step, 9);
    of_many.Step(*many);
    of_one.Step(*one);
    ASSERT_EQ(of_one.Row(0), of_many.Row(9)) << step;
    ASSERT_EQ(of_one.rewards[0], of_many.rewards[9]);
    ASSERT_EQ(one->Hash(0), many->Hash(9));
    ASSERT_EQ(one->Episode(0).seed, many->Episode(9).seed);
  }
}

TEST(EnvBits, WhatIsObservedIsOfNow) {
  for (const bool measured : {true, false}) {
    ExperimentSpec experiment = LoadFrom("learn_spine", 1);
    EnvironmentSpec& spec = *experiment.environment;
    spec.observations = {"cable/*/length_m", "cable/*/tension_n", "body/*"};
    if (!measured) {
      spec.reward.work_penalty_per_j = 0;
      spec.max_tension_n.reset();
    }
    spec.randomise.observation_delay_s = 0;
    const auto env = MakeEnv(experiment, {.worlds = 11});
    Arrays<> arrays(*env);
    const auto look = [&] {
      for (int w = 0; w < env->worlds(); ++w) {
        const std::vector<double> row = arrays.Row(static_cast<std::size_t>(w));
        std::size_t i = 0;
        for (int c = 0; c < 12; ++c) {
          const CableState cable = env->Cable(w, c);
          ASSERT_EQ(row[i++], cable.tension_n) << measured << c;
          ASSERT_EQ(row[i++], cable.length_m) << measured << c;
        }
        for (int b = 0; b < 3; ++b) {
          const BodyState body = env->Body(w, b);
          const Vec3 &p = body.position_m, &v = body.velocity_m_per_s,
                     &turn = body.angular_velocity_rad_per_s;
          const Quat& q = body.orientation;
          for (const double x :
               {p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, turn.x, turn.y, turn.z}) {
            ASSERT_EQ(row[i++], x) << measured << b;
          }
        }
        ASSERT_EQ(i, row.size());
      }
    };
    EXPECT_TRUE(arrays.Reset(*env));
    look();
    for (int step = 0; step < 4; ++step) {
      Wiggle(arrays, step);
      arrays.Step(*env);
      look();
    }
  }
}

TEST(EnvBits, ActionsDoSomething) {
  const ExperimentSpec experiment = Controlled(0.2);
  const auto env = MakeEnv(experiment, {.worlds = 2, .randomise = false});
  Arrays<> arrays(*env);
  std::fill_n(arrays.actions.begin(), arrays.action_width, 0.5);
  arrays.Step(*env);
  EXPECT_NE(env->Hash(0), env->Hash(1));
}

}  // namespace
}  // namespace taut::test
