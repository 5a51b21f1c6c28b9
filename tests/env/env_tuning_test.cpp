// Actions on set points of impedance control and on parameters of gaits: a constant action equals,
// to the bit, a run of the experiment with the changed number; a changing action preserves the
// phase.
#include <algorithm>
#include <cmath>

#include "env/env_fixture.h"
#include "taut/run.h"
#include "taut/study.h"
#include "tests/instruction_sets.h"

namespace taut::test {
namespace {

EnvironmentAction TunedMoves(std::vector<std::string> numbers, double by, std::string name = {}) {
  EnvironmentAction action;
  action.cable = kWorld;
  action.numbers = std::move(numbers);
  action.by = by;
  action.name = std::move(name);
  return action;
}

ExperimentSpec With(const std::string& name, double duration_s,
                    std::vector<EnvironmentAction> actions) {
  ExperimentSpec experiment = LoadFrom(name, duration_s);
  EnvironmentSpec& spec = experiment.environment.emplace();
  spec.period_s = 0.02;
  spec.actions = std::move(actions);
  spec.observations = {"cable/*/target_rest_length_m"};
  experiment.record.channels = {"system/kinetic_j"};
  return experiment;
}

double& NumberOf(ExperimentSpec& experiment, const std::string& name) {
  std::vector<ScaleSpec> none;
  for (const Tunable& tunable : FindTunables(experiment.controllers, none, experiment.robot)) {
    if (tunable.name == name) return *tunable.value;
  }
  throw std::runtime_error("no number " + name);
}

std::uint64_t HashOfTunedRun(const ExperimentSpec& experiment) {
  Diagnostics out;
  const auto run = RunExperiment(experiment, {}, out);
  EXPECT_TRUE(run) << out.Format();
  return run ? run->state_hash : 0;
}

/// Returns the hash of an episode under one constant action, in a world among others with other
/// actions.
std::uint64_t HashUnder(const ExperimentSpec& experiment, double x) {
  const auto env = MakeEnv(experiment, {.worlds = 3, .seed = experiment.seed});
  Arrays<> arrays(*env);
  for (std::int64_t i = 0; i < env->episode_steps(); ++i) {
    Wiggle(arrays, i);
    std::fill_n(arrays.actions.begin(), arrays.action_width, x);
    arrays.Step(*env);
  }
  return env->Hash(0);
}

struct Case {
  const char *experiment, *number;
  double by;
};
constexpr Case kCases[] = {
    {"push_20n", "impedance.inner_top_1.tension_offset_n", 8},
    {"push_20n", "impedance.outer_left_2.length_offset_m", 0.01},
    {"push_20n", "impedance.outer_left_2.velocity_offset_m_per_s", 0.05},
    {"push_20n", "impedance.inner_top_2.position_gain_n_per_m", 100},
    {"push_20n", "impedance.inner_top_2.velocity_gain_n_s_per_m", 20},
    {"sine_hand_tuned", "impedance.sine.frequency_hz", 0.25},
    {"sine_hand_tuned", "impedance.sine.seg1_inner_top.amplitude_m_per_s", 0.03},
    {"sine_hand_tuned", "impedance.sine.seg1_inner_top.offset_m_per_s", 0.02},
    {"sine_hand_tuned", "impedance.sine.seg1_inner_top.phase_rad", 0.5},
    {"rest_length_sine", "motion.sine.left.phase_per_segment_rad", 0.5},
    {"cpg_learned", "impedance.cpg.frequency_hz", 1},
    {"cpg_learned", "impedance.cpg.amplitude_m_per_s", 0.1},
    {"cpg_learned", "impedance.cpg.convergence_per_s", 5},
    {"cpg_learned", "impedance.cpg.rp0.0.0.weight_per_m", 20},
    {"cpg_learned", "impedance.cpg.rp0.0.1.phase_rad", 0.7},
    {"rest_length_sine", "motion.sine.left.amplitude_m", 0.01},
    {"goal_flat", "motion.feedback_cpg.phase_gain_rad_per_s", 2},
    {"roll_to_goal", "motion.toward_goal.up_m", 0.2},
    {"roll_to_goal", "motion.toward_goal.beat_hz", 0.1},
};

TEST(EnvTuning, AnActionThatStaysIsAnotherNumber) {
  for (const Case& of : kCases) {
    ExperimentSpec experiment = With(of.experiment, 0.3, {});
    NumberOf(experiment, of.number);
    experiment.environment->actions = {TunedMoves({of.number}, of.by)};
    const std::uint64_t as_it_is = HashOfTunedRun(experiment);
    EXPECT_EQ(HashUnder(experiment, 0), as_it_is) << of.number;
    ExperimentSpec other = experiment;
    NumberOf(other, of.number) += 0.5 * of.by;
    const std::uint64_t expected = HashOfTunedRun(other);
    EXPECT_EQ(HashUnder(experiment, 0.5), expected) << of.number;
    EXPECT_NE(expected, as_it_is) << of.number;
  }
}

TEST(EnvTuning, OneActionMovesAllThatBelongTogether) {
  const std::vector<std::string> all{"impedance.inner_top_1.tension_offset_n",
                                     "impedance.inner_left_1.tension_offset_n"};
  ExperimentSpec experiment = With("push_20n", 0.2, {TunedMoves(all, 6, "front")});
  const auto env = MakeEnv(experiment, {.worlds = 1});
  ASSERT_EQ(env->action_channels().size(), 1u);
  EXPECT_EQ(env->action_channels()[0].name, "front");
  EXPECT_EQ(env->action_channels()[0].unit, "N");
  EXPECT_EQ(env->action_scales(), std::vector<double>{6});
  ExperimentSpec other = experiment;
  for (const std::string& name : all) NumberOf(other, name) -= 3;
  EXPECT_EQ(HashUnder(experiment, -0.5), HashOfTunedRun(other));
}

TEST(EnvTuning, NumbersStayWhereTheyMakeSense) {
  ExperimentSpec experiment =
      With("push_20n", 0.2, {TunedMoves({"impedance.inner_top_1.tension_offset_n"}, 100)});
  ExperimentSpec other = experiment;
  NumberOf(other, "impedance.inner_top_1.tension_offset_n") = 0;
  EXPECT_EQ(HashUnder(experiment, -1), HashOfTunedRun(other));
}

/// V0 of the first cable with a wave is offset + amplitude cos(phase) at each tick. The phase is
/// the integral of the frequency and continuous across periods.
TEST(EnvTuning, AFrequencyChangesWithoutAJumpOfThePhase) {
  ExperimentSpec experiment =
      With("sine_hand_tuned", 1, {TunedMoves({"impedance.sine.frequency_hz"}, 0.4)});
  const auto& controller = experiment.controllers[0];
  const SineGait& sine = *controller.velocity_input->gait.sine;
  const SineWave& wave = sine.waves[0];
  Diagnostics out;
  const auto cable = ResolveGait(controller.velocity_input->gait, experiment.robot, out);
  ASSERT_TRUE(cable);
  std::size_t first = 0;
  while (cable->waves[first].wave != 0) ++first;
  const auto index = static_cast<std::size_t>(cable->cables[first]);
  experiment.environment->observations = {"cable/" + experiment.robot.def.cables[index].name +
                                          "/velocity_input_m_per_s"};
  experiment.environment->period_s = controller.velocity_input->clock.period_s;
  const auto env = MakeEnv(experiment, {.worlds = 2});
  Arrays<> arrays(*env);
  double phase = wave.phase_rad + cable->waves[first].segments_ahead * wave.phase_per_segment_rad;
  double steepest = 0;
  for (int step = 0; step < 60; ++step) {
    const double x = std::sin(0.3 * step);
    std::fill(arrays.actions.begin(), arrays.actions.end(), x);
    arrays.Step(*env);
    const double expected = wave.offset + wave.amplitude * std::cos(phase);
    ASSERT_NEAR(arrays.Row(1)[0], expected, 1e-12) << step;  // rounding of 60 sums
    const double turned = 2 * M_PI * (sine.frequency_hz + 0.4 * x) * env->period_s();
    phase += turned;
    steepest = std::max(steepest, turned);
  }
  EXPECT_GT(steepest, 0.01);
}

/// All kinds of actions at once, for comparisons of bits
ExperimentSpec Mixed(const std::string& name, const std::string& gait) {
  ExperimentSpec experiment = With(name, 0.2,
                                   {TunedMoves({"impedance.inner_top_1.tension_offset_n"}, 8),
                                    TunedMoves({"impedance." + gait + ".frequency_hz"}, 0.5)});
  experiment.environment->observations = {"cable/*/velocity_input_m_per_s", "body/*",
                                          "cable/*/setpoint_n"};
  experiment.environment->reward.measure = Measure::kDistance;
  experiment.environment->randomise.action_delay_s = 0.04;
  experiment.environment->randomise.start.position_m = 0.002;
  return experiment;
}

TEST(EnvTuning, NeitherThreadsNorLanesNorCompanyMatter) {
  for (const auto& [name, gait] : {std::pair{"sine_hand_tuned", "sine"}, {"cpg_learned", "cpg"}}) {
    const ExperimentSpec experiment = Mixed(name, gait);
    const auto trail = [&](EnvOptions options) {
      options.worlds = 7;
      const auto env = MakeEnv(experiment, options);
      Arrays<> arrays(*env);
      std::vector<std::vector<double>> rows;
      for (int step = 0; step < 14; ++step) {
        if (step == 3) {
          std::vector<std::uint8_t> mask{1, 0, 0, 1, 0, 0, 1};
          EXPECT_TRUE(arrays.Reset(*env, {}, mask));
        }
        Wiggle(arrays, step);
        arrays.Step(*env);
        rows.push_back(arrays.observations);
        rows.push_back(arrays.rewards);
      }
      return rows;
    };
    const auto expected = trail({.simd = Simd::kScalar});
    for (const auto& [set, simd] : kInstructionSets) {
      EXPECT_EQ(trail({.threads = 2, .simd = simd}), expected) << set << ", " << name;
    }
  }
}

TEST(EnvTuning, ANewEpisodeKnowsNothingOfWhatTheLastOneWasToldOrSaid) {
  for (const auto& [name, number] : {std::pair{"sine_hand_tuned", "impedance.sine.frequency_hz"},
                                     {"cpg_learned", "impedance.cpg.frequency_hz"},
                                     {"roll_to_goal", "motion.toward_goal.beat_hz"}}) {
    const ExperimentSpec experiment = With(name, 1, {TunedMoves({number}, 0.1)});
    const auto env = MakeEnv(experiment, {.worlds = 3}), fresh = MakeEnv(experiment, {.worlds = 3});
    Arrays<> arrays(*env), others(*fresh);
    for (int step = 0; step < 7; ++step) {
      Wiggle(arrays, 3 * step);
      arrays.Step(*env);
    }
    const std::vector<std::uint64_t> seeds{5, 6, 7};
    EXPECT_TRUE(arrays.Reset(*env, seeds));
    EXPECT_TRUE(others.Reset(*fresh, seeds));
    for (int step = 0; step < 6; ++step) {
      Wiggle(arrays, step);
      others.actions = arrays.actions;
      arrays.Step(*env);
      others.Step(*fresh);
      ASSERT_EQ(arrays.observations, others.observations) << name << step;
    }
  }
}

/// Phases, amplitudes and received signals persist: a tiny change of a number causes a tiny change
/// of the motion.
TEST(EnvTuning, WhatAGaitRemembersStays) {
  for (const auto& [name, number] : {std::pair{"sine_hand_tuned", "impedance.sine.frequency_hz"},
                                     {"cpg_learned", "impedance.cpg.amplitude_m_per_s"},
                                     {"goal_flat", "motion.feedback_cpg.phase_gain_rad_per_s"},
                                     {"roll_to_goal", "motion.toward_goal.beat_hz"}}) {
    const ExperimentSpec experiment = With(name, 1, {TunedMoves({number}, 1e-9)});
    const auto env = MakeEnv(experiment, {.worlds = 2});
    Arrays<> arrays(*env);
    EXPECT_TRUE(arrays.Reset(*env, std::vector<std::uint64_t>{5, 5}));
    for (int step = 0; step < 16; ++step) {
      arrays.actions = {0.0, step < 10 ? 0.0 : 1.0};
      arrays.Step(*env);
    }
    double most = 0, apart = 0;
    for (std::size_t i = 0; i < arrays.width; ++i) {
      apart = std::max(apart, std::fabs(arrays.Row(0)[i] - arrays.Row(1)[i]));
      most = std::max(most, std::fabs(arrays.Row(0)[i]));
    }
    EXPECT_LT(apart, 1e-5) << name;  // contacts amplify the difference by 1e4
    EXPECT_GT(most, 0.01) << name;
  }
}

TEST(EnvTuning, WhatNoActionCanMoveIsSaid) {
  for (const char* const number :
       {"motion.nothing", "model.friction",
        "motion.feedback_cpg.frequency_hz"}) {  // this name refers to the start value only
    Diagnostics out;
    EXPECT_FALSE(CheckEnvironment(With("goal_flat", 0.2, {TunedMoves({number}, 1)}), out));
    EXPECT_NE(out.Format().find("there is no parameter \"" + std::string(number)),
              std::string::npos)
        << out.Format();
  }
  Diagnostics out;
  EXPECT_FALSE(CheckEnvironment(With("goal_flat", 0.2, {TunedMoves({}, 1)}), out));
}

}  // namespace
}  // namespace taut::test
