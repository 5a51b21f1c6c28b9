// A goal: its place, its sensor, and the robot's least distance from it
#include "plant/goal.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "math/vec.h"
#include "taut/rollout.h"
#include "taut/study.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

class Goal : public ExperimentErrors {
 protected:
  ExperimentSpec With(const std::string& goal, const std::string& more = "") {
    Change("duration_s: 10\n", goal + more + "duration_s: 10\n");
    ExperimentSpec experiment = Load();
    experiment.duration_s = 0.2;
    return experiment;
  }
};

/// Bodies with poses set by the test
struct Standing final : Bodies {
  BodyState Body(int lane, int body) const override { return states.at({lane, body}); }
  Vec3 NodePosition(int, int) const override { return {}; }
  Vec3 NodeVelocity(int, int) const override { return {}; }
  std::map<std::pair<int, int>, BodyState> states;
};

BodyState At(const Vec3& position_m, const Quat& orientation) {
  BodyState state;
  state.position_m = position_m;
  state.orientation = orientation;
  return state;
}

Quat TurnAbout(const Vec3& axis, double angle_rad) {
  const double s = std::sin(angle_rad / 2);
  return {std::cos(angle_rad / 2), s * axis.x, s * axis.y, s * axis.z};
}

TEST_F(Goal, TheSensorSaysTheWayInTheBodysHorizontalFrame) {
  const ExperimentSpec experiment = With("goal: {at_m: [3, 4, 9], body: b}\n");
  const RolloutWorld world = WorldOf(experiment);
  const std::array lanes{&world, &world, &world};
  plant::GoalSensor sensor({experiment, lanes});
  Standing bodies;
  // Heading along x; rotated left by a quarter turn; also rolled about its axis, and pitched up.
  bodies.states[{0, 1}].position_m = {0, 0, 5};
  bodies.states[{1, 1}] = At({3, 1, 0}, TurnAbout({0, 0, 1}, std::numbers::pi / 2));
  bodies.states[{2, 1}] = At({3, 1, 0}, TurnAbout({0, 0, 1}, std::numbers::pi / 2) *
                                            TurnAbout({0, 1, 0}, -0.7) * TurnAbout({1, 0, 0}, 2.0));
  const std::array<std::int64_t, 3> number{};
  Observation exact;
  exact.lanes = 3;
  exact.bodies = &bodies;
  sensor.Sample({AllLanes(3), number.data()}, exact);
  const double* goal = sensor.seen().goal;
  ASSERT_NE(goal, nullptr);
  EXPECT_NEAR(goal[0], 0.6, 1e-15);
  EXPECT_NEAR(goal[3], 0.8, 1e-15);
  for (const int lane : {1, 2}) {
    EXPECT_NEAR(goal[lane], 1.0, 1e-15) << lane;
    EXPECT_NEAR(goal[3 + lane], 0.0, 1e-15) << lane;
  }
  // A lane that is not due keeps its value; a body at the goal has no direction.
  bodies.states[{0, 1}].position_m = {3, 4, 1};
  bodies.states[{1, 1}].position_m = {8, 4, 0};
  sensor.Sample({Lanes{1}, number.data()}, exact);
  EXPECT_EQ(goal[0], 0.0);
  EXPECT_EQ(goal[3], 0.0);
  EXPECT_NEAR(goal[1], 1.0, 1e-15);
  sensor.Sample({Lanes{2}, number.data()}, exact);
  EXPECT_NEAR(goal[1], 0.0, 1e-15);
  EXPECT_NEAR(goal[3 + 1], 1.0, 1e-15);  // to the left
}

TEST_F(Goal, ACompassSaysItInTheWorlds) {
  const ExperimentSpec experiment = With("goal: {at_m: [3, 4, 0], body: b, frame: world}\n");
  const RolloutWorld world = WorldOf(experiment);
  const std::array lanes{&world};
  plant::GoalSensor sensor({experiment, lanes});
  Standing bodies;
  bodies.states[{0, 1}] = At({0, 0, 0}, TurnAbout({0, 0, 1}, 1.0));
  const std::int64_t number = 0;
  Observation exact;
  exact.bodies = &bodies;
  sensor.Sample({1, &number}, exact);
  EXPECT_NEAR(sensor.seen().goal[0], 0.6, 1e-15);
  EXPECT_NEAR(sensor.seen().goal[1], 0.8, 1e-15);
}

TEST_F(Goal, WhatAPlantSaysItselfIsShown) {
  const ExperimentSpec experiment = With("goal: {at_m: [3, 4, 0], body: b}\n");
  const RolloutWorld world = WorldOf(experiment);
  const std::array lanes{&world};
  plant::GoalSensor sensor({experiment, lanes});
  const std::int64_t number = 0;
  const double beacon[] = {0.28, -0.96};
  Observation exact;
  sensor.Sample({1, &number}, exact);
  EXPECT_EQ(sensor.seen().goal[0], 0.0);  // unknown
  exact.goal = beacon;
  sensor.Sample({1, &number}, exact);
  EXPECT_EQ(sensor.seen().goal, beacon);
}

TEST_F(Goal, NoiseTurnsItAboutTheOrigin) {
  const GoalSpec goal{.at_m = {3, 4, 1}};
  double least = 1, most = -1;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Vec3 at = plant::GoalOf(goal, {.goal_rad = std::numbers::pi / 2}, seed);
    EXPECT_NEAR(std::hypot(at.x, at.y), 5.0, 1e-12);
    EXPECT_EQ(at.z, 1.0);
    const double turned = (3 * at.x + 4 * at.y) / 25;  // cosine
    least = std::min(least, turned), most = std::max(most, turned);
  }
  EXPECT_NEAR(least, 0.0, 0.05);
  EXPECT_GT(most, 0.999);
  EXPECT_EQ(plant::GoalOf(goal, {}, 7).x, 3.0);
}

// Bodies in free lateral motion: at speed v for t they come v t nearer to a goal ahead.
TEST_F(Goal, NearerIsTheDistanceBeforeLessTheDistanceAfter) {
  const ExperimentSpec experiment =
      With("goal: {at_m: [3.5, 0, 0], body: b}\n",
           "place: {at_m: [0, 0, 5], velocity_m_per_s: [2, 0, 0]}\nset: {stiffness_n_per_m: 1e-6}\n"
           "gravity_m_per_s2: [0, 0, 0]\n");
  ObjectiveSpec objective;
  objective.measure = Measure::kNearer;
  Diagnostics out;
  std::vector<RolloutWorld> worlds(3, WorldOf(experiment));
  worlds[1].start_noise.goal_rad = 3.0;
  worlds[1].seed = 4;
  ExperimentSpec loose = experiment;
  loose.controllers.clear();
  for (RolloutWorld& world : worlds) world.controllers.clear();
  for (CableDef& cable : loose.robot.def.cables) cable.rest_length_m = 2.0;
  const auto results = Rollouts::Create(loose, objective, {}, out)->Run(worlds);
  ASSERT_TRUE(out.ok()) << out.Format();
  EXPECT_NEAR(results[0].score, 0.4, 1e-9);
  EXPECT_EQ(results[2].score, results[0].score);
  const Vec3 goal = plant::GoalOf(*experiment.goal, worlds[1].start_noise, 4);
  EXPECT_NEAR(results[1].score, std::hypot(goal.x - 0.5, goal.y) - std::hypot(goal.x - 0.9, goal.y),
              1e-9);
}

TEST_F(Goal, WrongGoalsAreAnswered) {
  Expect("duration_s: 10\n", "duration_s: 10\ngoal: {at_m: [3, 0, 0], body: c}\n",
         "9:31: error: goal.body: there is no body c (did you mean \"a\"?)");
  Expect("duration_s: 10\n", "duration_s: 10\ngoal: {at_m: [3, 0, 0]}\n",
         "9:7: error: goal needs the key \"body\"");
  Expect("duration_s: 10\n", "duration_s: 10\nstart_noise: {goal_rad: 1}\n",
         "9:14: error: start_noise.goal_rad: the experiment has no `goal`");
  Write("trial.yaml", kExperiment);
  Write("study.yaml", R"(taut: 1
kind: study
name: s
experiment: trial.yaml
vary: [{name: friction, all: model.friction, low: 0.5, high: 2}]
objective: {measure: nearer}
worlds: {count: 2, start: {goal_rad: 1}}
search: [{method: monte_carlo, evaluations: 1}]
)");
  Diagnostics out;
  EXPECT_FALSE(LoadStudy(Path("study.yaml"), {}, out));
  EXPECT_EQ(
      Without(Path(""), out.Format()),
      "study.yaml:6:13: error: objective.measure: nearer needs a goal (add a `goal` to the "
      "experiment)\nstudy.yaml:7:9: error: worlds.start.goal_rad: the experiment has no `goal`\n");
}

}  // namespace
}  // namespace taut::test
