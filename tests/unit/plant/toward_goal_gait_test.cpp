// Gaits that roll toward a goal: files, errors, signals; starts in random poses
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "math/vec.h"
#include "plant/find_start.h"
#include "plant/player_kinds.h"
#include "taut/world_batch.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

/// Three rods along the three axes, and two cables: in the described placement the middle of `one`
/// is at (0, 1.25, 0), and the middle of `two` at (0, -1.25, 0).
constexpr const char* kJack = R"(taut: 1
kind: model
name: jack
allow_disconnected: true
nodes:
  a0: [-1, 0, 0.2]
  a1: [1, 0, 0.2]
  b0: [0, -1, 1]
  b1: [0, 1, 1]
  c0: [0, 3, -1]
  c1: [0, 3, 0.5]
  d0: [-1, 2.5, -0.2]
  d1: [1, -2.5, -0.2]
pairs:
  - {name: a, nodes: [a0, a1], tags: [rod]}
  - {name: b, nodes: [b0, b1], tags: [rod]}
  - {name: c, nodes: [c0, c1], tags: [rod]}
  - {name: d, nodes: [d0, d1], tags: [rod]}
  - {name: one, nodes: [a1, d0], tags: [driven]}
  - {name: two, nodes: [a0, d1], tags: [driven]}
builders:
  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}
  - {match: driven, cable: {stiffness_n_per_m: 100, rest_length_m: 2, actuator: {max_speed_m_per_s: 1}}}
)";

constexpr const char* kTowardGoalGait = R"(taut: 1
kind: gait
name: rolling
drives: rest_length
toward_goal:
  cables: driven
  offset_m: 0.01
  ahead_m: -0.2
  up_m: 0.1
  ahead2_m: 0.05
  ahead_up_m: -0.03
  up2_m: 0.02
  ahead3_m: 0.07
  ahead2_up_m: 0.04
  ahead_up2_m: -0.06
  up3_m: 0.08
  beat: 0.25
  beat_hz: 0.5
)";

constexpr const char* kWorldGoal = "goal: {at_m: [3, 0, 0], body: a, frame: world}\n";

class TowardGoalGaits : public ExperimentFolder {
 protected:
  TowardGoalGaits() { Write("jack.yaml", kJack); }

  std::string PlayedComplaints(const std::string& gait, const std::string& keys,
                               const std::string& model = "jack.yaml") {
    Write("g.yaml", gait);
    Write("trial.yaml", "taut: 1\nkind: experiment\nname: trial\nmodel: " + model + "\n" + keys +
                            "duration_s: 1\ncontrollers:\n  - {name: motion, rest_length_input: "
                            "{gait: g.yaml}}\n");
    return Complaints();
  }
  static std::string Changed(const std::string& from, const std::string& to) {
    std::string text = kTowardGoalGait;
    return text.replace(text.find(from), from.size(), to);
  }
};

TEST_F(TowardGoalGaits, WhatIsWrittenIsReadBack) {
  Write("g.yaml", kTowardGoalGait);
  Diagnostics out;
  auto gait = LoadGait(Path("g.yaml"), out);
  ASSERT_TRUE(gait) << out.Format();
  const std::string text = GaitYaml(*gait);
  Write("again.yaml", text);
  auto again = LoadGait(Path("again.yaml"), out);
  ASSERT_TRUE(again) << out.Format();
  EXPECT_EQ(GaitYaml(*again), text);
  std::map<std::string, double> numbers;
  for (const GaitValue& value : GaitValues(*again)) numbers[value.name] = *value.value;
  EXPECT_EQ(numbers, (std::map<std::string, double>{{"toward_goal.offset_m", 0.01},
                                                    {"toward_goal.ahead_m", -0.2},
                                                    {"toward_goal.up_m", 0.1},
                                                    {"toward_goal.ahead2_m", 0.05},
                                                    {"toward_goal.ahead_up_m", -0.03},
                                                    {"toward_goal.up2_m", 0.02},
                                                    {"toward_goal.ahead3_m", 0.07},
                                                    {"toward_goal.ahead2_up_m", 0.04},
                                                    {"toward_goal.ahead_up2_m", -0.06},
                                                    {"toward_goal.up3_m", 0.08},
                                                    {"toward_goal.beat", 0.25},
                                                    {"toward_goal.beat_hz", 0.5}}));
}

TEST_F(TowardGoalGaits, AResolvedExperimentHasItAndItsStart) {
  EXPECT_EQ(PlayedComplaints(kTowardGoalGait,
                             std::string(kWorldGoal) + "start_noise: {any_pose: true}\n"),
            "");
  const ExperimentSpec experiment = Load();
  Write("resolved.yaml", ResolvedYaml(experiment));
  const ExperimentSpec again = Load("resolved.yaml");
  EXPECT_TRUE(again.start_noise.any_pose);
  EXPECT_EQ(GaitYaml(again.controllers[0].rest_length_input->gait),
            GaitYaml(experiment.controllers[0].rest_length_input->gait));
  // Files without this feature stay readable by earlier versions.
  EXPECT_EQ(PlayedComplaints(kTowardGoalGait,
                             std::string(kWorldGoal) + "start_noise: {position_m: 0.1}\n"),
            "");
  EXPECT_EQ(ResolvedYaml(Load()).find("any_pose"), std::string::npos);
}

TEST_F(TowardGoalGaits, WhatIsWrongIsAnswered) {
  EXPECT_EQ(PlayedComplaints(kTowardGoalGait, ""),
            "g.yaml:6:3: error: gait rolling moves toward a goal, but the experiment has no `goal` "
            "(add its position and the tracked body: `goal: {at_m: [3.5, 0, 0], body: ...}`)\n");
  EXPECT_EQ(PlayedComplaints(kTowardGoalGait, "goal: {at_m: [3, 0, 0], body: a}\n"),
            "g.yaml:6:3: error: gait rolling needs the direction to the goal in the world frame "
            "(write `goal: {frame: world, ...}`: a rolling body has no forward direction)\n");
  EXPECT_EQ(
      PlayedComplaints(kTowardGoalGait, kWorldGoal, "model.yaml"),
      "g.yaml:6:3: error: toward_goal: the 2 struts of pair do not have three independent "
      "directions (the rotation of the robot is computed from bodies that are a single rod)\n");
  EXPECT_EQ(PlayedComplaints(Changed("cables: driven", "cables: one"), kWorldGoal),
            "g.yaml:6:3: error: toward_goal: all selected cables have the same "
            "midpoint (select cables on all sides of the robot)\n");
  EXPECT_EQ(PlayedComplaints(Changed("beat_hz: 0.5", "beat_hz: -1"), kWorldGoal),
            "g.yaml:18:12: error: toward_goal.beat_hz must not be negative, got -1\n");
  EXPECT_EQ(PlayedComplaints(Changed("up3_m: 0.08", "up4_m: 0.08"), kWorldGoal)
                .find("g.yaml:16:3: error: unknown key \"up4_m\" in toward_goal"),
            0u);
}

/// Bodies with orientations set by the test
struct Turned final : Bodies {
  BodyState Body(int lane, int) const override {
    BodyState state;
    state.orientation = turns.at(static_cast<std::size_t>(lane));
    return state;
  }
  Vec3 NodePosition(int, int) const override { return {}; }
  Vec3 NodeVelocity(int, int) const override { return {}; }
  std::vector<Quat> turns;
};

Quat About(const Vec3& axis, double angle_rad) {
  const double s = std::sin(angle_rad / 2);
  return {std::cos(angle_rad / 2), s * axis.x, s * axis.y, s * axis.z};
}

struct PlayingToGoal {
  PlayingToGoal(const std::vector<const GaitSpec*>& gaits, const RobotSpec& robot) {
    plant::GaitSetup setup;
    setup.gaits = gaits;
    Diagnostics out;
    setup.resolved = ResolveGait(*gaits[0], robot, out).value_or(ResolvedGait{});
    EXPECT_TRUE(out.ok()) << out.Format();
    player = plant::PlayerOf(setup);
    lanes = gaits.size();
    goal.resize(2 * lanes);
    number.resize(lanes);
    time_s.resize(lanes);
    bodies.turns.resize(lanes);
  }
  const std::vector<double>& At(double t_s, bool knows_bodies = true) {
    time_s.assign(lanes, t_s);
    Observation seen;
    seen.lanes = static_cast<int>(lanes);
    seen.goal = goal.data();
    if (knows_bodies) seen.bodies = &bodies;
    player->Tick({AllLanes(seen.lanes), number.data(), time_s.data(), time_s.data()}, seen);
    return player->signal();
  }
  std::unique_ptr<plant::GaitPlayer> player;
  std::size_t lanes = 1;
  Turned bodies;
  std::vector<double> goal, time_s;
  std::vector<std::int64_t> number;
};

double Polynomial(double a, double z, double strength) {
  return 0.01 +
         strength * (-0.2 * a + 0.1 * z + 0.05 * a * a - 0.03 * a * z + 0.02 * z * z +
                     0.07 * a * a * a + 0.04 * a * a * z - 0.06 * a * z * z + 0.08 * z * z * z);
}

// The middles of the cables are 1.25 m from their mean, which is the radius: in radii, a rotated
// robot's middles are (0, 1, 0) and (0, -1, 0) after the rotation.
TEST_F(TowardGoalGaits, ACablesPlaceIsThatOfTheTurnedRobot) {
  ASSERT_EQ(PlayedComplaints(kTowardGoalGait, kWorldGoal), "");
  const ExperimentSpec experiment = Load();
  const GaitSpec& gait = experiment.controllers[0].rest_length_input->gait;
  PlayingToGoal playing({&gait}, experiment.robot);
  playing.goal = {0.6, -0.8};
  for (const Quat& turn :
       {Quat{}, About({1, 0, 0}, 0.7), About({1, 0, 0}, 0.7) * About({0, 0, 1}, 2.0),
        About({0.6, 0, 0.8}, -1.3)}) {
    playing.bodies.turns = {turn};
    const Vec3 place = Rotate(turn, {0, 1, 0});
    const double a = 0.6 * place.x - 0.8 * place.y, z = place.z, t_s = 0.3;
    const double strength = 1 + 0.25 * std::cos(2 * std::numbers::pi * 0.5 * t_s);
    const std::vector<double>& signal = playing.At(t_s);
    EXPECT_NEAR(signal[0], Polynomial(a, z, strength), 1e-14);
    EXPECT_NEAR(signal[1], Polynomial(-a, -z, strength), 1e-14);
  }
}

// Unknown orientation: only the constant part. Unknown goal: the vertical direction still acts.
TEST_F(TowardGoalGaits, WhatIsNotSensedIsNothing) {
  ASSERT_EQ(PlayedComplaints(kTowardGoalGait, kWorldGoal), "");
  const ExperimentSpec experiment = Load();
  PlayingToGoal playing({&experiment.controllers[0].rest_length_input->gait}, experiment.robot);
  playing.goal = {1, 0};
  EXPECT_EQ(playing.At(0, false), (std::vector<double>{0.01, 0.01}));
  playing.goal = {0, 0};
  playing.bodies.turns = {About({1, 0, 0}, std::numbers::pi / 2)};
  EXPECT_NEAR(playing.At(0)[0], Polynomial(0, 1, 1.25), 1e-14);
}

TEST_F(TowardGoalGaits, ALaneHasItsOwnNumbersAndBodies) {
  ASSERT_EQ(PlayedComplaints(kTowardGoalGait, kWorldGoal), "");
  const ExperimentSpec experiment = Load();
  std::vector<GaitSpec> gaits(3, experiment.controllers[0].rest_length_input->gait);
  gaits[1].toward_goal->ahead = 0.4;
  gaits[2].toward_goal->beat_hz = 0.9;
  PlayingToGoal together({&gaits[0], &gaits[1], &gaits[2]}, experiment.robot);
  together.goal = {1, 0.6, 0, 0, 0.8, -1};
  for (std::size_t j = 0; j < 3; ++j) {
    together.bodies.turns[j] = About({0, 0.6, 0.8}, 0.5 + static_cast<double>(j));
  }
  const std::vector<double> all = together.At(0.4);
  for (std::size_t j = 0; j < 3; ++j) {
    PlayingToGoal alone({&gaits[j]}, experiment.robot);
    alone.goal = {together.goal[j], together.goal[3 + j]};
    alone.bodies.turns = {together.bodies.turns[j]};
    EXPECT_EQ(alone.At(0.4)[0], all[j]);
    EXPECT_EQ(alone.At(0.4)[1], all[3 + j]);
  }
  together.player->Restart(0, gaits[1]);
  EXPECT_NE(together.At(0.4)[0], all[0]);
  EXPECT_EQ(together.At(0.4)[1], all[1]);
}

// Uniformly distributed rotations have no preferred direction: the mean of a rotated axis is 0, and
// of its square 1/3 along each axis of the world, here for 600 starts to three deviations. The
// center of mass is unchanged, and so are distances from it.
TEST_F(TowardGoalGaits, AStartInAnyPoseIsATurnAboutTheCentreOfMass) {
  ASSERT_EQ(PlayedComplaints(kTowardGoalGait,
                             std::string(kWorldGoal) + "start_noise: {any_pose: true}\n"),
            "");
  ExperimentSpec experiment = Load();
  Diagnostics out;
  const auto model = Model::Compile(experiment.robot.def, out);
  const auto center = [](const WorldBatch& batch) {
    Vec3 sum;
    for (int b = 0; b < 4; ++b) sum = sum + 0.25 * batch.Body(0, b).position_m;
    return sum;
  };
  const WorldBatch described(model, {});
  const Vec3 middle = center(described);
  Vec3 mean, squares;
  constexpr int kStarts = 600;
  for (int i = 0; i < kStarts; ++i) {
    experiment.seed = static_cast<std::uint64_t>(i);
    WorldBatch batch(model, {});
    ASSERT_TRUE(plant::PrepareStart(experiment, batch, out)) << out.Format();
    const Vec3 moved = center(batch) - middle;
    EXPECT_LT(std::sqrt(Dot(moved, moved)), 1e-14);
    const BodyState a = batch.Body(0, 0), b = batch.Body(0, 1);
    const Vec3 before = described.Body(0, 1).position_m - middle;
    const Vec3 turned = Rotate(b.orientation, before) - (b.position_m - middle);
    EXPECT_LT(std::sqrt(Dot(turned, turned)), 1e-14);
    const Vec3 x = Rotate(a.orientation, {1, 0, 0});
    mean = mean + (1.0 / kStarts) * x;
    squares = squares + (1.0 / kStarts) * Vec3{x.x * x.x, x.y * x.y, x.z * x.z};
  }
  for (const double m : {mean.x, mean.y, mean.z})
    EXPECT_LT(std::fabs(m), 3 * std::sqrt(1.0 / 3 / kStarts));
  for (const double s : {squares.x, squares.y, squares.z}) {
    EXPECT_LT(std::fabs(s - 1.0 / 3), 3 * std::sqrt(4.0 / 45 / kStarts));
  }
}

}  // namespace
}  // namespace taut::test
