// Joints, bodies and shapes of robots on pages of user programs (taut/page.h)
#include "tests/viewer/page_fixture.h"

namespace taut::test {
namespace {

TEST_F(PageTest, JointsAreWhereTheyHoldTheirBodies) {
  Diagnostics found;
  const auto leg = LoadRobot(TAUT_SOURCE_DIR "/docs/tutorial_joints/leg.yaml", {}, found);
  ASSERT_TRUE(leg) << found.Format();
  const auto page = Open();
  page->Add(leg->def, "a");
  page->Add(leg->def, "b", {0, 2, 0});
  page->Show(0);
  Client browser = Browser(*page, page->url());
  const Json scene = browser.Await("scene")["scene"];
  const Json& joints = scene["joints"];
  EXPECT_EQ(Names(joints), (std::vector<std::string>{"a/knee", "a/hip", "b/knee", "b/hip"}));
  const auto place = [&](int joint, const char* body, const char* point) {
    Json at = joints[joint][point];
    if (joints[joint][body] == -1) return at;
    const Json origin = scene["bodies"][joints[joint][body].get<int>()]["position_m"];
    for (int k = 0; k < 3; ++k) at[k] = at[k].get<double>() + origin[k].get<double>();
    return at;
  };
  for (const int robot : {0, 1}) {
    const int knee = 2 * robot, hip = knee + 1;
    EXPECT_EQ(joints[knee]["kind"], "hinge");
    EXPECT_EQ(joints[knee]["axis"], Json({0.0, 1.0, 0.0}));
    EXPECT_EQ(joints[knee]["body_a"], 2 * robot);
    EXPECT_EQ(joints[knee]["body_b"], 2 * robot + 1);
    EXPECT_EQ(joints[hip]["body_a"], -1);
    EXPECT_EQ(joints[hip]["from_m"], Json({0.0, 2.0 * robot, 0.6}));
    for (const auto& [body, point] : {std::pair("body_a", "from_m"), std::pair("body_b", "to_m")}) {
      const Json at = place(knee, body, point);
      EXPECT_NEAR(at[0].get<double>(), 0.1, 1e-15);
      EXPECT_NEAR(at[1].get<double>(), 2.0 * robot, 1e-15);
      EXPECT_NEAR(at[2].get<double>(), 0.35, 1e-15);
    }
  }
}

TEST_F(PageTest, CablesGoRoundTheirWheelsAndHaveTheirSpans) {
  Diagnostics found;
  const auto experiment =
      LoadExperiment(TAUT_SOURCE_DIR "/docs/tutorial_cables/fall.yaml", {}, found);
  ASSERT_TRUE(experiment) << found.Format();
  const ModelDef& def = experiment->robot.def;
  WorldBatch batch(Model::Compile(def, found), {});
  batch.Step(1e-3, 100);
  const auto page = Open();
  page->Add(def, "a");
  page->Add(def, "b", {0, 2, 0});
  for (const int robot : {0, 1}) page->Set(robot, MomentOf(batch, 0));
  page->Show(0.1);
  Client browser = Browser(*page, page->url());
  const Json cables = browser.Await("scene")["scene"]["cables"];
  ASSERT_EQ(Names(cables), (std::vector<std::string>{"a/rope", "b/rope"}));
  for (const Json& cable : cables) {
    EXPECT_TRUE(cable["parted"]);
    EXPECT_EQ(cable["attachments"][1]["wheel"], cables[0]["attachments"][1]["wheel"]);
    EXPECT_TRUE(cable["attachments"][1]["parts"]);
  }
  const std::vector<double> spans = batch.CableSpanTensions(0, 0);
  ASSERT_EQ(spans.size(), 2u);
  const ReceivedFrame frame =
      browser.AwaitFrame([](const ReceivedFrame& each) { return HasTime(each, 0.1); });
  const std::vector<double> numbers(frame.numbers.end() - 8, frame.numbers.end());
  EXPECT_EQ(numbers, (std::vector<double>{0, spans[0], 0, spans[1], 1, spans[0], 1, spans[1]}));
}

}  // namespace
}  // namespace taut::test
