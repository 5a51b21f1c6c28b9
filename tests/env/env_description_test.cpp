// Environment section of experiment files: values, and errors, which are reported all at once with
// their places
#include "env/env_fixture.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

/// Environment section for the fixture's experiment, whose controller holds `left` and `right`;
/// begins at line 22
constexpr const char* kEnvironment = R"(environment:
  period_s: 0.02
  actions:
    - {cables: driven, velocity_input_m_per_s: 0.1}
  observations: [cable/*/tension_n, "body/a/*"]
  reward: {measure: heading, direction: [0, 3, 4], fall: {max_tilt_rad: 1, penalty: 2}}
  max_tension_n: 90
  randomise: {mass: 0.1, slope_rad: pi / 50, action_delay_s: 0.04, starts: 12}
)";

class EnvDescription : public ExperimentErrors {
 protected:
  /// Returns the errors of reading the file with one text replaced, or "good".
  std::string Wrong(const std::string& old_text, const std::string& new_text) {
    return Complained(old_text, new_text, false);
  }
  /// Returns the errors of `CheckEnvironment` for the file with one text replaced.
  std::string Unfit(const std::string& old_text, const std::string& new_text) {
    return Complained(old_text, new_text, true);
  }

 private:
  std::string Complained(const std::string& old_text, const std::string& new_text, bool fit) {
    std::string text = std::string(kExperiment) + kEnvironment;
    const std::size_t at = text.find(old_text);
    EXPECT_NE(at, std::string::npos) << old_text;
    Write("env.yaml", text.replace(at, old_text.size(), new_text));
    Diagnostics out;
    const auto experiment = LoadExperiment(Path("env.yaml"), {}, out);
    if (experiment && fit) CheckEnvironment(*experiment, out);
    if (out.ok()) return "good";
    return Without(Path("env.yaml") + ":", ErrorsOf(out));
  }
};

TEST_F(EnvDescription, IsWhatTheFileSays) {
  Write("env.yaml", std::string(kExperiment) + kEnvironment);
  ExperimentSpec experiment = Load("env.yaml");
  for (int pass = 0; pass < 2; ++pass) {  // as written, and as resolved
    ASSERT_TRUE(experiment.environment);
    const EnvironmentSpec& spec = *experiment.environment;
    EXPECT_EQ(spec.period_s, 0.02);
    ASSERT_EQ(spec.actions.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(spec.actions[i].cable, static_cast<int>(i));
      EXPECT_EQ(spec.actions[i].velocity_input_m_per_s, 0.1);
      EXPECT_FALSE(spec.actions[i].rest_length_m || spec.actions[i].rest_length_rate_m_per_s);
    }
    EXPECT_EQ(spec.observations, (std::vector<std::string>{"cable/*/tension_n", "body/a/*"}));
    EXPECT_EQ(spec.reward.measure, Measure::kHeading);
    EXPECT_EQ(spec.reward.direction.y, 0.6);
    EXPECT_EQ(spec.reward.fall->max_tilt_rad, 1);
    EXPECT_EQ(spec.reward.fall->penalty, 2);
    EXPECT_EQ(spec.max_tension_n, 90);
    EXPECT_EQ(spec.randomise.mass, 0.1);
    EXPECT_NEAR(spec.randomise.slope_rad, 0.0628318530717958, 1e-15);
    EXPECT_EQ(spec.randomise.action_delay_s, 0.04);
    EXPECT_EQ(spec.randomise.starts, 12);
    Diagnostics out;
    EXPECT_TRUE(CheckEnvironment(experiment, out)) << out.Format();
    Write("resolved.yaml", ResolvedYaml(experiment));
    experiment = Load("resolved.yaml");
  }
}

TEST_F(EnvDescription, ARunDoesNotLookAtIt) {
  EXPECT_FALSE(Load().environment);
  EXPECT_EQ(ResolvedYaml(Load()).find("environment"), std::string::npos);
}

TEST_F(EnvDescription, EveryMistakeIsNamedAtOnce) {
  EXPECT_EQ(
      Wrong(kEnvironment, R"(environment:
  period_s: -1
  acts: 3
  observations: []
  reward: {measure: nearest, from_s: 20, alive_per_s: -1}
  randomise: {friction: 1, starts: 1.5, observation_delay_s: 0.015}
)"),
      R"(23:3: error: environment needs the key "actions"
)"
      R"(23:13: error: environment.period_s must be positive, got -1
)"
      R"(24:3: error: unknown key "acts" in environment (one of: period_s, actions, observations, reward, max_tension_n, randomise)
)"
      R"(25:3: error: environment.observations is empty (add at least one entry)
)"
      R"(26:21: error: environment.reward.measure cannot be "nearest" (did you mean "nearer"?)
)"
      R"(26:30: error: environment.reward.from_s must be before the end of the experiment (the end is at 10 s)
)"
      R"(26:55: error: environment.reward.alive_per_s must not be negative, got -1
)"
      R"(27:25: error: environment.randomise.friction must be below 1, got 1 (0.2 means factors from 0.8 to 1.2)
)"
      R"(27:36: error: environment.randomise.starts must be a whole number within 0..100000, got 1.5
)");
}

TEST_F(EnvDescription, ActionsMoveWhatTheyCan) {
  EXPECT_EQ(
      Wrong("cables: driven, velocity_input", "cables: drivn, velocity_input"),
      R"(25:16: error: environment.actions.cables: no cable matches drivn (no cable is called or tagged "drivn"; did you mean "driven"?)
)");
  EXPECT_EQ(Wrong("cables: driven, velocity_input", "cables: passive, velocity_input"),
            R"(25:16: error: environment.actions: no action can change loose (it has no actuator)
)");
  EXPECT_EQ(
      Wrong("velocity_input_m_per_s: 0.1", "rest_length_m: 0.1"),
      R"(25:16: error: environment.actions: no action can change left, right (controller hold drives it)
)");
  EXPECT_EQ(
      Wrong("velocity_input_m_per_s: 0.1", "rest_length_m: 0.1, rest_length_rate_m_per_s: 1"),
      R"(25:44: error: environment.actions has both rest_length_m and rest_length_rate_m_per_s (give only one of them)
)");
  EXPECT_EQ(
      Wrong("velocity_input_m_per_s: 0.1}",
            "velocity_input_m_per_s: 0.1}\n    - {cables: left, velocity_input_m_per_s: 1}"),
      R"(26:16: error: environment.actions: no action can change left (it already has an action, in line 25)
)");
}

TEST_F(EnvDescription, ActionsOnNumbersAreWhatTheFileSays) {
  std::string text = std::string(kExperiment) + kEnvironment;
  const std::string old_text = "    - {cables: driven, velocity_input_m_per_s: 0.1}\n";
  text.replace(text.find(old_text), old_text.size(), R"(    - {each: hold.*.tension_offset_n, by: 5}
    - {all: [hold.left.length_offset_m, hold.right.length_offset_m], by: 2 / 100, name: reach}
    - {all: hold.right.velocity_*, by: 1}
    - {cables: right, velocity_input_m_per_s: 0.1}
)");
  Write("env.yaml", text);
  ExperimentSpec experiment = Load("env.yaml");
  for (int pass = 0; pass < 2; ++pass) {  // as written, and as resolved
    ASSERT_TRUE(experiment.environment);
    const std::vector<EnvironmentAction>& actions = experiment.environment->actions;
    ASSERT_EQ(actions.size(), 5u);
    EXPECT_EQ(actions[0].cable, 1);
    EXPECT_EQ(actions[0].velocity_input_m_per_s, 0.1);
    EXPECT_FALSE(actions[0].by);
    const std::vector<std::string> numbers[] = {
        {},
        {"hold.left.tension_offset_n"},
        {"hold.right.tension_offset_n"},
        {"hold.left.length_offset_m", "hold.right.length_offset_m"},
        {"hold.right.velocity_gain_n_s_per_m", "hold.right.velocity_offset_m_per_s"}};
    const double by[] = {0, 5, 5, 0.02, 1};
    const char* const names[] = {"", "", "", "reach", "hold.right.velocity_gain_n_s_per_m"};
    for (std::size_t i = 1; i < 5; ++i) {
      EXPECT_EQ(actions[i].cable, kWorld);
      EXPECT_EQ(actions[i].numbers, numbers[i]);
      EXPECT_EQ(actions[i].by, by[i]);
      EXPECT_EQ(actions[i].name, names[i]);
    }
    Diagnostics out;
    EXPECT_TRUE(CheckEnvironment(experiment, out)) << out.Format();
    Write("resolved.yaml", ResolvedYaml(experiment));
    experiment = Load("resolved.yaml");
  }
}

TEST_F(EnvDescription, ActionsOnNumbersMoveWhatTheyCan) {
  const std::string old_text = "{cables: driven, velocity_input_m_per_s: 0.1}";
  EXPECT_EQ(
      Wrong(old_text, "{each: hold.*.tension_n, by: 5}"),
      R"(25:14: error: environment.actions.each: there is no parameter "hold.*.tension_n" (`taut learn --parameters EXPERIMENT` lists them all)
)");
  EXPECT_EQ(
      Wrong(old_text, "{each: hold.left.tension_offset_n}"),
      R"(25:7: error: environment.actions needs one of rest_length_m, rest_length_rate_m_per_s, velocity_input_m_per_s, by
)");
  EXPECT_EQ(Wrong(old_text, "{each: hold.left.tension_offset_n, rest_length_m: 1, name: x}"),
            R"(25:42: error: environment.actions.rest_length_m is allowed with `cables` only
)"
            R"(25:60: error: environment.actions.name is allowed with `all` only
)");
  EXPECT_EQ(Wrong(old_text, "{cables: driven, by: 1, name: x}"),
            R"(25:24: error: environment.actions.by is allowed with `each` or `all` only
)"
            R"(25:31: error: environment.actions.name is allowed with `all` only
)");
  EXPECT_EQ(Wrong(old_text, "{all: hold.*.tension_offset_n, each: x, by: 1}"),
            R"(25:8: error: environment.actions has both each and all (give only one of them)
)");
  EXPECT_EQ(Wrong(old_text, "{by: 1}"),
            R"(25:7: error: environment.actions needs one of cables, each, all
)");
  EXPECT_EQ(Wrong(old_text, "{each: hold.left.tension_offset_n, by: 0}"),
            R"(25:46: error: environment.actions.by must be positive, got 0
)");
  EXPECT_EQ(
      Wrong(old_text, "{each: hold.*.tension_offset_n, by: 5}\n    - {all: hold.left.*, by: 1}"),
      R"(26:13: error: environment.actions: two actions change hold.left.tension_offset_n (the first is in line 25)
)");
  EXPECT_EQ(Wrong(old_text,
                  "{all: hold.left.t*, by: 5, name: a}\n"
                  "    - {all: hold.right.t*, by: 1, name: a}"),
            R"(26:35: error: environment.actions: two actions are called a
)");
}

TEST_F(EnvDescription, WhatBelongsTogetherIsThere) {
  EXPECT_EQ(
      Wrong(", direction: [0, 3, 4]", ""),
      R"(27:12: error: environment.reward: heading needs the key "direction" (such as [1, 0, 0])
)");
  EXPECT_EQ(
      Wrong("measure: heading, direction: [0, 3, 4]", "measure: nearer"),
      R"(27:12: error: environment.reward.measure: nearer needs a goal (add a `goal` to the experiment)
)");
  EXPECT_EQ(Wrong("{mass: 0.1", "{start: {goal_rad: 1}, mass: 0.1"),
            R"(29:15: error: environment.randomise.start.goal_rad: the experiment has no `goal`
)");
  EXPECT_EQ(
      Wrong("action_delay_s: 0.04", "action_delay_s: 21"),
      R"(29:46: error: environment.randomise.action_delay_s must not be longer than 1000 periods (the period is 0.02 s)
)");
}

TEST_F(EnvDescription, ChannelsAndClocksFit) {
  EXPECT_EQ(
      Unfit("cable/*/tension_n", "cable/*/tensions"),
      R"(26:18: error: environment.observations: no channel matches "cable/*/tensions" (did you mean "cable/*/tension_n"?)
)");
  EXPECT_EQ(
      Unfit("period_s: 0.02", "period_s: 0.0002"),
      R"(23:3: error: environment.period_s must be a whole multiple of the period of controller hold, 0.001 s (each action must span the same number of ticks)
)"
      R"(23:3: error: environment.period_s must be a whole multiple of the step, got 0.2 steps (step_s is 0.001)
)");
  EXPECT_EQ(
      Unfit("force_n: [[3, 0], [4, push_n]]", "force_n: [[3, 0], [4.00037, push_n]]"),
      R"(23:3: error: environment: a corner of push tap must be a whole number of steps, got 4.00037 s (step_s is 0.001; all worlds must step at the same times)
)");
  EXPECT_EQ(
      Unfit("- name: hold", "- name: hold\n    period_s: 0.003"),
      R"(24:3: error: environment.period_s must be a whole multiple of the period of controller hold, 0.003 s (each action must span the same number of ticks)
)");
  EXPECT_EQ(
      Unfit("duration_s: 10", "duration_s: 10.01"),
      R"(23:3: error: environment.period_s must divide duration_s into whole periods, got 500.5 (an episode lasts duration_s, 10.01 s)
)");
}

TEST_F(EnvDescription, AWrongChannelIsToldWithWhatElseIsWrong) {
  std::string text = std::string(kExperiment) + kEnvironment;
  const auto change = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  change("cable/*/tension_n", "cable/*/tensions");
  change("starts: 12", "starts: -1");
  change("rate_hz: 50", "rate_hz: 50, channels: [body/*/position]");
  Write("env.yaml", text);
  Diagnostics out;
  EXPECT_FALSE(LoadExperimentAndChannels(Path("env.yaml"), {}, out));
  EXPECT_EQ(
      Without(Path("env.yaml") + ":", ErrorsOf(out)),
      R"(21:34: error: record.channels: no channel matches "body/*/position" (did you mean "body/*/position_x_m"?)
)"
      R"(26:18: error: environment.observations: no channel matches "cable/*/tensions" (did you mean "cable/*/tension_n"?)
)"
      R"(29:76: error: environment.randomise.starts must be a whole number within 0..100000, got -1
)");
  change("starts: -1", "starts: 12");
  Write("env.yaml", text);
  EXPECT_TRUE(
      LoadExperimentAndChannels(Path("env.yaml"), {}, out = {}));  // `CheckEnvironment` reports
                                                                   // this error, not the reader
  EXPECT_TRUE(out.ok());
}

TEST(EnvSpec, ShippedOnesFit) {
  for (const char* const name : {"learn_spine", "learn_roll"}) {
    Diagnostics out;
    EXPECT_TRUE(CheckEnvironment(LoadFrom(name), out)) << out.Format();
  }
}

TEST(EnvSpec, AnExperimentWithoutOneIsNone) {
  Diagnostics out;
  EXPECT_FALSE(Env::Create(LoadFrom("stand_still"), {}, out));
  EXPECT_NE(out.Format().find("stand_still.yaml: error: the experiment has no `environment`"),
            std::string::npos)
      << out.Format();
}

}  // namespace
}  // namespace taut::test
