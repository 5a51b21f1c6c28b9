// Limits of the viewer for clients and traces: excess is rejected, closed or drawn more coarsely.
#include <stdexcept>
#include <utility>

#include "apps/viewer/report.h"
#include "apps/viewer/robot_session.h"
#include "apps/viewer/scene.h"
#include "taut/link/robot_plant.h"
#include "tests/viewer/replay_folder.h"

namespace taut::test {
namespace {

using viewer::Command;

TEST(ViewLimits, SixtyFourMayLookOfWhichFortyEightMayOnlyWatch) {
  const Serving serving(PausedLive(kHang));
  std::vector<std::unique_ptr<Client>> clients;
  const auto add = [&](const std::string& target) {
    auto client = std::make_unique<Client>(serving.port(), target);
    if (!client->open()) return false;
    client->Await("hello");  // the client counts from here on
    clients.push_back(std::move(client));
    return true;
  };
  while (add(kToWatch)) ASSERT_LE(clients.size(), 48u);
  EXPECT_EQ(clients.size(), 48u);
  while (add(kToDrive)) ASSERT_LE(clients.size(), 64u);
  EXPECT_EQ(clients.size(), 64u);
  EXPECT_EQ(Get(serving.port(), "/").status, 200u) << "the page itself comes";
}

TEST(ViewLimits, TheHeadOfARequestHas8KibibytesAtMost) {
  const Serving serving(PausedLive(kHang));
  EXPECT_EQ(Get(serving.port(), "/", {{"X-Long", std::string(7'000, 'x')}}).status, 200u);
  EXPECT_THROW(Get(serving.port(), "/", {{"X-Long", std::string(8'200, 'x')}}), std::runtime_error);
}

TEST(ViewLimits, APageThatLeavesTooMuchUnreadIsClosed) {
  viewer::ServerOptions options;
  EXPECT_EQ(options.max_unread_bytes, 64u << 20);
  options.max_unread_bytes = 100;  // less than the greeting
  const Serving serving(PausedLive(kHang), options);
  EXPECT_EQ(Client(serving.port()).AwaitClose().reason, "too slow");
}

/// A session that was not started: posted commands wait.
class Waiting final : public viewer::Session {
 public:
  Waiting() : Session("live", "waiting") {}

 private:
  void Handle(int, const Command&) override {}
  Clock::time_point Work() override { return Clock::now() + std::chrono::hours(1); }
};

TEST(ViewLimits, AHundredThousandCommandsOr256SeriesWaitAtMost) {
  const auto taken = [](const char* type) {
    Waiting session;
    Command command;
    command.type = type;
    int count = 0;
    while (session.Post(1, command)) ++count;
    return count;
  };
  EXPECT_EQ(taken("step"), 100'000);
  EXPECT_EQ(taken("want_series"), 256);
}

TEST(ViewLimits, OfARobotsCommandsAThousandWaitAndTheStopAlways) {
  Diagnostics found;
  const auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/tetraspine3_motors.yaml", {}, found);
  ASSERT_TRUE(robot) << found.Format();
  viewer::RobotSessionOptions options;
  options.robot = *robot;
  options.cables = link::MotorNames(*robot);
  viewer::RobotSession session("a robot", std::move(options));
  Command hold, stop;
  hold.type = "robot_mode";
  hold.mode = "hold";
  stop.type = "stop";
  for (int i = 0; i < 1'001; ++i) EXPECT_TRUE(session.Post(1, hold));
  EXPECT_EQ(session.TakeCommands().size(), 1'000u);
  for (int i = 0; i < 1'001; ++i) session.Post(1, hold);
  session.Post(1, stop);
  EXPECT_EQ(session.TakeCommands().size(), 1u);
}

using ReportLimits = ReplayFolder;

TEST_F(ReportLimits, AReportHas4000PicturesAtMost) {
  // 150 s would be 4501 pictures at 30 per second.
  Diagnostics found;
  const std::vector<ChannelInfo> channels{{"body/segment_0/position_x_m", "m"}};
  const auto writer = CreateHdf5Trace((folder_ / "long.h5").string(), channels, {}, found);
  ASSERT_TRUE(writer) << found.Format();
  for (int row = 0; row <= 5'000; ++row) {
    const double x_m = 1e-3 * row;
    ASSERT_TRUE(writer->Append(0.03 * row, &x_m)) << writer->error();
  }
  ASSERT_TRUE(writer->Finish()) << writer->error();
  EXPECT_EQ(viewer::ReportOf(*Load((folder_ / "long.h5").string()))["frame_count"], 4'000);
}

TEST(ViewLimits, OfAHeightField250000CornersAreDrawnAtMost) {
  ExperimentSpec experiment;
  HeightFieldDef field;
  field.name = "hills", field.cell_m = 0.1;
  field.columns = field.rows = 501;
  field.height_m.assign(501 * 501, 0.0);
  experiment.robot.def.height_fields = {field};
  const auto corners = [&] {
    const viewer::Json scene = viewer::SceneOf(experiment);
    return scene["terrain"][0]["corners_m"].size() / 3;
  };
  EXPECT_EQ(corners(), 251u * 251u);  // every second corner
}

}  // namespace
}  // namespace taut::test
