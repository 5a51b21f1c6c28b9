// Kinematic bodies in experiment files
#include <gmock/gmock.h>

#include "taut/run.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

using testing::HasSubstr;

class MotionText : public ExperimentFolder {
 protected:
  void Add(const std::string& motion, const std::string& terrain = "") {
    std::string text = kExperiment;
    const auto after = [&](const std::string& line, const std::string& more) {
      text.insert(text.find(line) + line.size(), more);
    };
    after("duration_s: 10\n", "motion:\n" + motion);
    after("friction: 0.5}}\n", terrain);
    Write("trial.yaml", text);
  }
};

constexpr const char* kPlate =
    "  - {name: plate, box: {center_m: [0, 0, -0.1], size_m: [4, 4, 0.1], friction: 0.7}}\n";

TEST_F(MotionText, ABoxOfTheTerrainBecomesABody) {
  Add("  - name: shaker\n"
      "    of: plate\n"
      "    slide: {direction: [2, 0, 0], amplitude_m: 0.01, frequency_hz: 2, phase_rad: 0.5}\n"
      "    turn: {axis: [0, 0, 1], center_m: [1, 0, 0], speed_rad_per_s: [[0, 0], [2, pi]]}\n",
      kPlate);
  const ModelDef def = Load().robot.def;
  EXPECT_TRUE(def.terrain_boxes.empty());
  ASSERT_EQ(def.motions.size(), 1u);
  const MotionDef& m = def.motions[0];
  EXPECT_EQ(m.name, "shaker");
  const BodyDef& body = def.bodies.at(static_cast<std::size_t>(m.body));
  EXPECT_EQ(body.name, "plate");
  EXPECT_TRUE(body.fixed);
  EXPECT_EQ(def.boxes.back().half_extents_m.x, 2);
  EXPECT_EQ(def.boxes.back().material.kinetic_friction, 0.7);
  EXPECT_EQ(m.direction.x, 1);
  EXPECT_EQ(m.slide.amplitude, 0.01);
  EXPECT_EQ(m.slide.phase_rad, 0.5);
  EXPECT_EQ(m.center_m.x, 1);
  ASSERT_EQ(m.turn.speed.size(), 2u);
  EXPECT_NEAR(m.turn.speed[1].second, 3.14159265358979, 1e-12);
}

TEST_F(MotionText, ABodyOfTheRobotIsNotMovedByForcesAnyMore) {
  Add("  - {name: hand, of: b, slide: {direction: [0, 0, 1], speed_m_per_s: [[1, 0.1]]}}\n");
  const ModelDef def = Load().robot.def;
  ASSERT_EQ(def.motions.size(), 1u);
  EXPECT_EQ(def.motions[0].body, 1);
  EXPECT_TRUE(def.bodies[1].fixed);
}

TEST_F(MotionText, AResolvedExperimentHasIt) {
  Add("  - {name: hand, of: plate, slide: {direction: [0, 0, 1], speed_m_per_s: [[1, 0.1], [2, "
      "0]]}}\n",
      kPlate);
  ExperimentSpec before = Load();
  before.name = "trial";
  Write("resolved.yaml", ResolvedYaml(before));
  const ExperimentSpec after = Load("resolved.yaml");
  ASSERT_EQ(after.robot.def.motions.size(), 1u);
  const auto robot = [](const ExperimentSpec& e) {
    const std::string text = ResolvedYaml(e);
    return text.substr(text.find("robot:"));
  };
  EXPECT_EQ(robot(after), robot(before));
  EXPECT_EQ(after.robot.def.motions[0].slide.speed, before.robot.def.motions[0].slide.speed);
}

TEST_F(MotionText, EveryMistakeIsNamedAtOnce) {
  Add("  - {name: a, of: plat, slide: {direction: [0, 0, 1], speed_m_per_s: [[-1, 0.1]]}}\n"
      "  - {name: b, of: plate}\n"
      "  - {name: c, of: a, slide: {direction: [0, 0, 1]}}\n"
      "  - {name: c, of: b, turn: {axis: [0, 0, 0], speed_rad_per_s: [[1, 1], [0.5, 2]]}}\n"
      "  - {name: d, of: b, slide: {direction: [1, 0, 0], amplitude_m: 1}}\n"
      "  - {name: e, of: b, slide: {direction: [1, 0, 0], amplitude_m: 1, frequency_hz: -1}}\n",
      kPlate);
  const std::string errors = Complaints();
  EXPECT_THAT(errors, HasSubstr("\"plat\" is neither a body of the robot nor a box"));
  EXPECT_THAT(errors, HasSubstr("plate"));
  EXPECT_THAT(errors, HasSubstr("motion needs `slide` or `turn`"));
  EXPECT_THAT(errors, HasSubstr("has neither a speed nor an amplitude"));
  EXPECT_THAT(errors, HasSubstr("turn.axis must not be zero"));
  EXPECT_THAT(errors, HasSubstr("time_s must not be negative"));
  EXPECT_THAT(errors, HasSubstr("times must increase"));
  EXPECT_THAT(errors, HasSubstr("needs frequency_hz"));
  EXPECT_THAT(errors, HasSubstr("frequency_hz"));
  EXPECT_THAT(errors, HasSubstr("two motions are called c"));
}

TEST_F(MotionText, WhatGoesTooFarIsAnErrorAndWhatIsTooFastAWarning) {
  Add("  - {name: a, of: plate, slide: {direction: [0, 0, 1], speed_m_per_s: [[0, 1e300]]}}\n"
      "  - {name: b, of: b, turn: {axis: [0, 0, 1], speed_rad_per_s: [[0, 1], [1, -1e9]]}}\n",
      kPlate);
  const std::string errors = Complaints();
  EXPECT_THAT(errors,
              HasSubstr("the motion \"a\" may move by 1e+301 m in 10 s (use a smaller motion: "
                        "positions that far away are rounded too coarsely for this robot)"));
  EXPECT_THAT(errors,
              HasSubstr("the motion \"b\" may rotate by 1e+10 rad in 10 s (at most 1e9 rad"));
  Add("  - {name: a, of: plate, slide: {direction: [0, 0, 1], amplitude_m: 0.1, frequency_hz: "
      "600}}\n",
      kPlate);
  Diagnostics out;
  EXPECT_TRUE(LoadExperiment(Path("trial.yaml"), {}, out));
  EXPECT_THAT(out.Format(),
              HasSubstr("warning: the motion \"a\" has 600 Hz, so a step of 0.001 s gives less "
                        "than two steps per period (use a smaller step_s)"));
}

TEST_F(MotionText, WhatASupportHoldsCannotBeMoved) {
  std::string model = kModel;
  Write("model.yaml", model + "  - {match: a0, support: {kind: ball}}\n");
  Add("  - {name: hand, of: a, slide: {direction: [0, 0, 1], speed_m_per_s: [[0, 1]]}}\n");
  EXPECT_THAT(Complaints(),
              HasSubstr("trial.yaml:10:22: error: motion.of: the joint \"a0\" connects"));
}

TEST_F(MotionText, WhileItSettlesNothingMoves) {
  Add("  - {name: hand, of: a, slide: {direction: [0, 0, 1], speed_m_per_s: [[0, 0.5]]}}\n");
  ExperimentSpec experiment = Load();
  experiment.start = StartKind::kSettledFloating;
  Diagnostics out;
  const auto settled = FindSettledStart(experiment, out);
  ASSERT_TRUE(settled) << out.Format();
  EXPECT_EQ(settled->pose.bodies[0].position_m.z, experiment.robot.def.bodies[0].com_m.z);
}

}  // namespace
}  // namespace taut::test
