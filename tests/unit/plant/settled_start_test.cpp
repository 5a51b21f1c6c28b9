// Settled starts: poses and messages
#include <cmath>

#include "math/align.h"
#include "math/vec.h"
#include "plant/find_start.h"
#include "taut/run.h"
#include "taut/summary.h"
#include "unit/description/experiment_fixture.h"
#include "unit/scenes/heap_models.h"

namespace taut::test {
namespace {

TEST(Align, FindsTheMotionThatPointsHaveMadeTogether) {
  const std::vector<Vec3> from{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0.3, 0.1, -0.7}};
  const double s = std::sqrt(0.5);
  const Quat turn{s, 0, 0, s};  // a quarter turn about z: x to y, y to -x
  std::vector<Vec3> to;
  for (const Vec3& p : from) to.push_back(Rotate(turn, p) + Vec3{5, -3, 2});
  const RigidMotion motion = Align(from, to);
  for (std::size_t i = 0; i < from.size(); ++i) {
    EXPECT_LT(Length(motion.Of(from[i]) - to[i]), 1e-14) << i;
  }
  EXPECT_LT(Length(motion.Of({0, 1, 0}) - Vec3{4, -3, 2}), 1e-14);
}

TEST(Align, AMirrorImageIsNoRigidMotion) {
  const std::vector<Vec3> from{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Vec3> to{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  const RigidMotion motion = Align(from, to);
  double worst = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    worst = std::max(worst, Length(motion.Of(from[i]) - to[i]));
  }
  EXPECT_GT(worst, 0.2);
}

class SettledStartTest : public ExperimentFolder {
 protected:
  SettledStartTest() {
    Write("prism.yaml", kPrism);
    Write("stands.yaml", kSettledPrism);
  }
  std::optional<taut::SettledStart> Settle(const Overrides& overrides, Diagnostics& out) const {
    return FindSettledStart(Load("stands.yaml", overrides), out);
  }
};

TEST_F(SettledStartTest, ARobotThatHoldsItsShapeIsNotWarnedOf) {
  Diagnostics out;
  const auto settled = Settle({}, out);
  ASSERT_TRUE(settled) << out.Format();
  EXPECT_EQ(out.Format(), "");
  EXPECT_EQ(settled->change.taut_cables, 9);
  EXPECT_TRUE(settled->change.slack_cables.empty());
  // Its weight, 1 N, is small compared with 20 N: the cables yield less than 1 N / (1000 N/m).
  EXPECT_LT(settled->change.largest_displacement_m, 1e-3);
  EXPECT_GT(settled->change.largest_displacement_m, 0);
  // The farthest node is a strut's end: at a radius of 0.1 m and 0.1 m above the center.
  EXPECT_NEAR(settled->change.size_m, 2 * std::sqrt(0.02), 1e-12);
  EXPECT_NEAR(settled->change.described_max_tension_n, 20, 1e-9);
}

TEST_F(SettledStartTest, FloatingItTouchesNoGroundOfAnyKind) {
  ExperimentSpec experiment = Load("stands.yaml", {});
  experiment.start = StartKind::kSettledFloating;
  experiment.robot.def.planes.clear();
  Diagnostics out;
  const auto free = FindSettledStart(experiment, out);
  HeightFieldDef field;  // 4 mm above the underside of its lower ends
  field.columns = field.rows = 2;
  field.cell_m = 4;
  field.height_m = {0.004, 0.004, 0.004, 0.004};
  experiment.robot.def.height_fields.push_back(field);
  const auto in_ground = FindSettledStart(experiment, out);
  ASSERT_TRUE(free && in_ground) << out.Format();
  for (std::size_t b = 0; b < free->pose.bodies.size(); ++b) {
    EXPECT_EQ(free->pose.bodies[b].position_m.z, in_ground->pose.bodies[b].position_m.z) << b;
  }
}

TEST_F(SettledStartTest, AHeapIsWarnedOfWithNamesAndNumbers) {
  Diagnostics out;
  const auto settled = Settle({{"turn_rad", "-0.6"}, {"side_n", "2"}}, out);
  ASSERT_TRUE(settled) << out.Format();
  const StartChange& change = settled->change;
  EXPECT_FALSE(change.slack_cables.empty());
  const std::string text = out.Format();
  EXPECT_NE(
      text.find(" of the 9 cables that are taut in the described pose are slack after settling: " +
                change.slack_cables[0] + ", "),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("N, in the described pose 2 N ("), std::string::npos) << text;
  EXPECT_LT(change.max_tension_n, change.described_max_tension_n);
  out.WarningsToErrors();
  EXPECT_FALSE(out.ok());
}

TEST_F(SettledStartTest, LookingOnDoesNotChangeWhatItSettlesTo) {
  const ExperimentSpec experiment = Load("stands.yaml");
  Diagnostics out;
  const auto model = Model::Compile(experiment.robot.def, out);
  WorldBatch seen(model, {}), unseen(model, {});
  std::optional<taut::SettledStart> settled;
  ASSERT_TRUE(plant::PrepareStart(experiment, seen, out, {}, &settled)) << out.Format();
  ASSERT_TRUE(plant::PrepareStart(experiment, unseen, out)) << out.Format();
  EXPECT_EQ(seen.Hash(0), unseen.Hash(0));
}

TEST_F(SettledStartTest, IsInTheSummaryOfARun) {
  Diagnostics out;
  ExperimentSpec experiment = Load("stands.yaml");
  experiment.duration_s = 0.01;
  const auto run = RunExperiment(experiment, {}, out);
  ASSERT_TRUE(run && run->start) << out.Format();
  EXPECT_EQ(run->start->taut_cables, 9);
  const std::string table = SummaryTable(*run);
  EXPECT_NE(table.find("settled at the start: largest displacement "), std::string::npos) << table;
  EXPECT_NE(table.find("slack: none\n"), std::string::npos) << table;
  EXPECT_NE(SummaryJson(*run).find("\"slack_cables\": []"), std::string::npos);
  experiment.start = StartKind::kAsDescribed;
  const auto described = RunExperiment(experiment, {}, out);
  ASSERT_TRUE(described);
  EXPECT_FALSE(described->start);
  EXPECT_NE(SummaryJson(*described).find("\"start\": null"), std::string::npos);
}

TEST(StartWarnings, SayWhatIsFarAndWhatTouches) {
  StartChange change;
  change.largest_displacement_m = 0.3;
  change.displaced_node = "tip";
  change.size_m = 1.0;
  change.new_contacts = {{"a", "b"}};
  Diagnostics out;
  WarnOfStart(change, out);
  const std::string hint = " (see the settled robot with `taut check --settled` or `taut view`)\n";
  EXPECT_EQ(
      out.Format(),
      "warning: bodies that do not touch in the described pose touch after settling: a on "
      "b" +
          hint +
          "warning: the robot settles to another shape: the node \"tip\" moves 0.3 m from its "
          "described position, 30 % of the robot's size of 1 m" +
          hint);
  change = {};
  change.taut_cables = 20;
  change.slack_cables = {"a", "b", "c", "d", "e", "f", "g"};
  change.max_tension_n = 0.55;
  change.described_max_tension_n = 25.7;
  Diagnostics slack;
  WarnOfStart(change, slack);
  EXPECT_EQ(slack.Format(),
            "warning: 7 of the 20 cables that are taut in the described pose are slack after "
            "settling: a, "
            "b, c and 4 more; largest tension 0.55 N, in the described pose 25.7 N" +
                hint);
}

TEST(StartWarnings, AreNotGivenOfTheSixStrutThatDrawsItselfTogether) {
  for (const char* spacing : {"0.75", "rod_length_m / 4"}) {
    SCOPED_TRACE(spacing);
    Diagnostics out;
    ExperimentSpec experiment;
    const auto robot =
        LoadRobot(TAUT_SOURCE_DIR "/share/models/six_strut.yaml", {{"spacing_m", spacing}}, out);
    ASSERT_TRUE(robot) << out.Format();
    experiment.robot = *robot;
    experiment.start = StartKind::kSettledFloating;
    const auto settled = FindSettledStart(experiment, out);
    ASSERT_TRUE(settled) << out.Format();
    EXPECT_EQ(out.Format(), "");
    EXPECT_TRUE(settled->change.slack_cables.empty());
  }
}

}  // namespace
}  // namespace taut::test
