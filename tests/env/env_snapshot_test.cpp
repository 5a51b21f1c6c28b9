// Serialization of environment worlds: a restored world continues bit for bit, in the same lane, in
// another lane, and in another environment with other registers and threads.
#include <algorithm>

#include "env/env_fixture.h"

namespace taut::test {
namespace {

EnvironmentSpec Environment() {
  EnvironmentSpec spec;
  spec.period_s = 0.02;
  spec.observations = {"body/*", "cable/*/tension_n", "cable/*/target_rest_length_m"};
  spec.reward.measure = Measure::kDistance;
  spec.reward.from_s = 0.05;
  spec.reward.tension_limit = TensionLimit{12, 0.02};
  spec.reward.work_penalty_per_j = 0.1;
  spec.randomise.mass = spec.randomise.friction = 0.1;
  spec.randomise.slope_rad = 0.05;
  spec.randomise.start.position_m = 0.002;
  spec.randomise.action_delay_s = spec.randomise.observation_delay_s = 0.04;
  return spec;
}

EnvironmentAction Moves(std::string number, double by) {
  EnvironmentAction action;
  action.cable = kWorld;
  action.numbers = {std::move(number)};
  action.by = by;
  return action;
}

/// Returns an experiment with pushes, drags, sensors with memory, and actions on V0 and on a set
/// point.
ExperimentSpec Pushed() {
  ExperimentSpec experiment = LoadFrom("push_20n", 0.4);
  experiment.pushes.clear();
  experiment.pushes.push_back({"tap", 0, {0, 1, 0}, 1, {{0.05, 0}, {0.1, 8}, {0.3, 0}}});
  experiment.drags.push_back({"pull", 1, {0.05, 0, 0}, 40, 2, 0.06, 0.36});
  experiment.sensors = SensorSpec{};
  experiment.sensors->load_cell =
      LoadCellSpec{.noise_n = 0.5, .bias_n = 0.2, .delay_s = 0.003, .drift_n_per_s = 0.5};
  experiment.sensors->encoder = EncoderSpec{.quantum_m = 1e-4,
                                            .delay_s = 0.002,
                                            .zero_error_m = 0.003,
                                            .gain_error = 0.01,
                                            .index_m = 0.004};
  experiment.sensors->length_from_tension = true;
  experiment.controllers[0].impedance->differenced_rate = true;
  EnvironmentSpec& spec = experiment.environment.emplace(Environment());
  EnvironmentAction& action = spec.actions.emplace_back();
  action.cable = 2;
  action.velocity_input_m_per_s = 0.05;
  spec.actions.push_back(Moves("impedance.inner_top_1.tension_offset_n", 8));
  spec.observations.insert(spec.observations.end(), {"sensor/*", "push/*", "drag/*"});
  return experiment;
}

/// Returns an experiment with a PID controller and a sine whose frequency the actions change.
ExperimentSpec Waving() {
  ExperimentSpec experiment = LoadFrom("sine_hand_tuned", 0.4);
  ImpedanceSpec& impedance = *experiment.controllers[0].impedance;
  impedance.conversion = TensionConversion::kPid;
  impedance.pid = {0.002, 0.01, 1e-5};
  experiment.environment = Environment();
  experiment.environment->actions = {Moves("impedance.sine.frequency_hz", 0.5)};
  return experiment;
}

ExperimentSpec Of(const std::string& name, const std::string& number, double by) {
  ExperimentSpec experiment = LoadFrom(name, 0.4);
  experiment.environment = Environment();
  experiment.environment->actions = {Moves(number, by)};
  return experiment;
}

/// Actions are offsets of the rest lengths from their values at the start.
ExperimentSpec ByLength() {
  ExperimentSpec experiment = LoadFrom("learn_spine", 0.4);
  const std::vector<EnvironmentAction> actions = experiment.environment->actions;
  experiment.environment = Environment();
  experiment.environment->actions = actions;
  return experiment;
}

/// Actions are rates of the rest lengths.
ExperimentSpec ByRate() {
  ExperimentSpec experiment = ByLength();
  std::vector<EnvironmentAction> actions = experiment.environment->actions;
  for (EnvironmentAction& action : actions) {
    action.rest_length_m.reset();
    action.rest_length_rate_m_per_s = 0.05;
  }
  experiment.environment->actions = actions;
  return experiment;
}

struct Named {
  const char* name;
  ExperimentSpec experiment;
};
std::vector<Named> All() {
  ExperimentSpec changing = Of("gait_change", "impedance.cpg.amplitude_m_per_s", 0.1);
  changing.controllers[0].velocity_input->changes[0].at_s = 0.1;
  ExperimentSpec blended = Waving();
  GaitInputSpec& input = *blended.controllers[0].velocity_input;
  input.others = {input.gait};
  input.others[0].name = "other";
  input.changes = {{0.1, 1}};
  input.blend_s = 0.2;
  return {{"pushed", Pushed()},
          {"waving", Waving()},
          {"by rate", ByRate()},
          {"by length", ByLength()},
          {"cpg", Of("cpg_learned", "impedance.cpg.frequency_hz", 1)},
          {"change", changing},
          {"blend", blended},
          {"rest lengths", Of("rest_length_sine", "motion.sine.frequency_hz", 0.3)},
          {"feedback", Of("goal_flat", "motion.feedback_cpg.convergence_per_s", 2)},
          {"toward goal", Of("roll_to_goal", "motion.toward_goal.beat_hz", 0.1)}};
}

/// Outputs of a world over some steps under actions that depend on the step only
struct SnapshotTrail {
  std::vector<std::vector<double>> rows;
  std::vector<double> rewards;
  std::vector<std::uint64_t> hashes;
  std::vector<std::uint8_t> ends;
  bool operator==(const SnapshotTrail&) const = default;
};

SnapshotTrail Follow(Env& env, std::size_t world, int from, int steps) {
  Arrays<> arrays(env);
  SnapshotTrail trail;
  const int w = static_cast<int>(world);
  for (int step = from; step < from + steps; ++step) {
    Wiggle(arrays, step);
    for (std::size_t i = 0; i < arrays.action_width; ++i) {
      arrays.actions[world * arrays.action_width + i] =
          (7 * step + 3 * static_cast<int>(i)) % 8 / 4.0 - 0.75;
    }
    arrays.Step(env);
    trail.rows.push_back(arrays.Row(world));
    trail.rewards.push_back(arrays.rewards[world]);
    trail.hashes.push_back(env.Hash(w));
    trail.ends.push_back(static_cast<std::uint8_t>(env.Episode(w).end));
    trail.rewards.push_back(env.Episode(w).reward);
    trail.rewards.push_back(env.Last(w).reward);
    trail.hashes.push_back(env.Episode(w).seed);
  }
  return trail;
}

TEST(EnvSnapshot, WhatIsRestoredGoesOnAsItWouldHave) {
  for (const Named& of : All()) {
    for (const int before : {1, 7, 20}) {  // 20 steps: the end of the episode
      const auto env = MakeEnv(of.experiment, {.worlds = 5, .threads = 2, .seed = 3});
      Follow(*env, 2, 0, before);
      const std::vector<std::uint8_t> saved = env->Save(2);
      // through the end of the episode into the next one
      const SnapshotTrail expected = Follow(*env, 2, before, 25);
      const auto other = MakeEnv(of.experiment, {.worlds = 3, .simd = Simd::kScalar, .seed = 90});
      Follow(*other, 1, 40, 4);
      Diagnostics out;
      ASSERT_TRUE(other->Restore(1, saved, out)) << of.name << out.Format();
      EXPECT_EQ(other->Save(1), saved) << of.name;
      EXPECT_EQ(Follow(*other, 1, before, 25), expected) << of.name << ", other environment";
      ASSERT_TRUE(env->Restore(4, saved, out)) << of.name;
      EXPECT_EQ(Follow(*env, 4, before, 25), expected) << of.name << ", other lane";
      ASSERT_TRUE(env->Restore(4, saved, out)) << of.name;
      EXPECT_EQ(Follow(*env, 4, before, 25), expected) << of.name << ", once more";
    }
  }
}

TEST(EnvSnapshot, WithWhateverDelaysItHas) {
  const ExperimentSpec experiment = Waving();
  for (std::size_t world = 0; world < 8; ++world) {
    const auto env = MakeEnv(experiment, {.worlds = 8, .seed = 20});
    Follow(*env, world, 0, 5);
    const std::vector<std::uint8_t> saved = env->Save(static_cast<int>(world));
    const SnapshotTrail expected = Follow(*env, world, 5, 8);
    Diagnostics out;
    ASSERT_TRUE(env->Restore(static_cast<int>((world + 3) % 8), saved, out)) << out.Format();
    EXPECT_EQ(Follow(*env, (world + 3) % 8, 5, 8), expected) << world;
  }
}

TEST(EnvSnapshot, OthersDoNotNotice) {
  const ExperimentSpec experiment = Pushed();
  const auto env = MakeEnv(experiment, {.worlds = 5}), calm = MakeEnv(experiment, {.worlds = 5});
  Follow(*env, 0, 0, 4);
  Follow(*calm, 0, 0, 4);
  const std::vector<std::uint8_t> saved = env->Save(1);
  Follow(*env, 0, 4, 3);
  Follow(*calm, 0, 4, 3);
  Diagnostics out;
  ASSERT_TRUE(env->Restore(1, saved, out));
  const SnapshotTrail trail = Follow(*env, 3, 7, 20), calm_trail = Follow(*calm, 3, 7, 20);
  EXPECT_EQ(trail, calm_trail);
}

TEST(EnvSnapshot, WhatIsNoneIsRefusedAndNothingChanges) {
  const ExperimentSpec experiment = Waving();
  const auto env = MakeEnv(experiment, {.worlds = 2});
  Follow(*env, 0, 0, 3);
  const std::vector<std::uint8_t> saved = env->Save(0);
  Follow(*env, 0, 3, 2);
  const std::uint64_t hash = env->Hash(0);
  const auto refused = [&](const std::vector<std::uint8_t>& bytes, const char* why) {
    Diagnostics out;
    EXPECT_FALSE(env->Restore(0, bytes, out));
    EXPECT_NE(out.Format().find(why), std::string::npos) << out.Format();
    EXPECT_EQ(env->Hash(0), hash);
    EXPECT_EQ(env->Episode(0).steps, 5);
  };
  refused({}, "not a snapshot");
  refused(std::vector<std::uint8_t>(100, 7), "not a snapshot");
  for (const std::size_t size : {std::size_t{30}, saved.size() - 1}) {
    refused({saved.begin(), saved.begin() + static_cast<std::ptrdiff_t>(size)}, "damaged");
  }
  for (std::size_t at = 24; at < saved.size(); at += saved.size() / 23) {
    std::vector<std::uint8_t> bytes = saved;
    bytes[at] ^= 0x40;
    refused(bytes, "damaged");
  }
  ExperimentSpec other = experiment;
  other.controllers[0].impedance->cables[0].tension_offset_n += 1;
  refused(MakeEnv(other, {.worlds = 1})->Save(0), "belongs to another environment");
  refused(MakeEnv(experiment, {.worlds = 1, .randomise = false})->Save(0),
          "belongs to another environment");
}

}  // namespace
}  // namespace taut::test
