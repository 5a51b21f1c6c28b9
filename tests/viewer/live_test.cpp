// Live runs: without user actions they equal the run; user actions take effect and are recorded.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "apps/viewer/recording.h"
#include "taut/live.h"
#include "taut/run.h"
#include "tests/unit/plant/recorder_fixture.h"
#include "tests/viewer/serving.h"

namespace taut::test {
namespace {

namespace fs = std::filesystem;
using viewer::FrameHeader;

ExperimentSpec LoadSpec(const std::string& path) {
  Diagnostics found;
  const auto experiment = LoadExperiment(path, {}, found);
  EXPECT_TRUE(experiment) << found.Format();
  return *experiment;
}

std::unique_ptr<LiveRun> StartRun(const ExperimentSpec& experiment) {
  Diagnostics found;
  auto run = LiveRun::Start(experiment, found);
  EXPECT_TRUE(run) << found.Format();
  return run;
}

int Node(const ExperimentSpec& experiment, const std::string& name) {
  const auto& nodes = experiment.robot.def.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].name == name) return static_cast<int>(i);
  }
  ADD_FAILURE() << "no node " << name;
  return 0;
}

TEST(LiveRun, LeftAloneItGivesTheBitsOfARun) {
  for (const std::string& path : {kHang, kPush}) {
    ExperimentSpec experiment = LoadSpec(path);
    experiment.duration_s = 2.5;
    Diagnostics found;
    const auto summary = RunExperiment(experiment, {}, found);
    ASSERT_TRUE(summary) << found.Format();
    const auto run = StartRun(experiment);
    while (run->time_s() < experiment.duration_s) ASSERT_TRUE(run->Step());
    EXPECT_EQ(run->time_s(), experiment.duration_s);
    EXPECT_EQ(run->world()->Hash(0), summary->state_hash) << path;
    for (int i = 0; i < 100; ++i)
      ASSERT_TRUE(run->Step());  // the run continues beyond the experiment's end
    EXPECT_GT(run->time_s(), experiment.duration_s + 0.05);
  }
}

TEST(LiveRun, AHandHoldsANodeUpAgainstItsWeight) {
  const ExperimentSpec experiment = LoadSpec(kHang);
  const auto run = StartRun(experiment);
  const int mass = Node(experiment, "mass");
  const double weight_n = 0.5 * 9.81;
  const Vec3 start = run->world()->NodePosition(0, mass);
  // Above the point where the cable goes slack, the user's hand carries the whole weight.
  run->SetHand(HandSpec{mass, {start.x, start.y, start.z + 0.2}});
  while (run->time_s() < 10) ASSERT_TRUE(run->Step());
  EXPECT_EQ(run->Observe().Cable(0).tension_n, 0);
  ASSERT_EQ(run->ExternalForces().size(), 1u);
  EXPECT_NEAR(run->ExternalForces()[0].force_n.z, weight_n, 1e-6);
  EXPECT_NEAR(run->world()->NodePosition(0, mass).z,
              start.z + 0.2 - weight_n / run->DragStiffness(), 1e-6);
  run->SetHand({});
  ASSERT_TRUE(run->Step());
  EXPECT_TRUE(run->ExternalForces().empty());
  EXPECT_NEAR(run->world()->Body(0, 0).velocity_m_per_s.z, -9.81e-3, 1e-6);  // it falls
}

TEST(LiveRun, APushGivesItsImpulse) {
  const ExperimentSpec experiment = LoadSpec(kHang);
  const auto pushed = StartRun(experiment), alone = StartRun(experiment);
  pushed->Push({Node(experiment, "mass"), {2, 0, 0}}, 0.05);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(pushed->Step());
    ASSERT_TRUE(alone->Step());
  }
  // 2 N for 50 ms; the cable's lateral force increases with the displacement of at most 5 mm.
  const auto momentum_x = [](const LiveRun& run) {
    return run.world()->BodyMass(0, 0) * run.world()->Body(0, 0).velocity_m_per_s.x;
  };
  EXPECT_NEAR(momentum_x(*pushed) - momentum_x(*alone), 0.1, 0.002);
  ASSERT_TRUE(pushed->Step());
  EXPECT_TRUE(pushed->ExternalForces().empty());
}

TEST(LiveRun, SetPointsAndGainsTakeEffect) {
  const ExperimentSpec experiment = LoadSpec(kPush);
  const auto run = StartRun(experiment), alone = StartRun(experiment);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(run->Step());
    ASSERT_TRUE(alone->Step());
  }
  std::vector<LiveControl> controls = run->Controls();
  ASSERT_EQ(controls.size(), 12u);
  ASSERT_TRUE(controls[2].impedance);
  EXPECT_EQ(controls[2].impedance->tension_offset_n, 15);
  const auto cable = static_cast<std::size_t>(controls[2].cable);
  controls[2].impedance->tension_offset_n += 4;
  EXPECT_TRUE(run->SetControl(controls[2]));
  ASSERT_TRUE(run->Step());
  ASSERT_TRUE(alone->Step());
  // Both controllers have the same observations.
  EXPECT_NEAR(run->commands().set_point_n[cable], alone->commands().set_point_n[cable] + 4, 1e-12);
  controls[2].impedance->position_gain_n_per_m = 0;
  controls[2].impedance->velocity_gain_n_s_per_m = 0;
  EXPECT_TRUE(run->SetControl(controls[2]));
  ASSERT_TRUE(run->Step());
  EXPECT_EQ(run->commands().set_point_n[cable], 19);  // T0 only
  controls[2].impedance.reset();
  EXPECT_FALSE(run->SetControl(controls[2]));  // controlled by a controller
  controls[2].cable = 99;
  EXPECT_FALSE(run->SetControl(controls[2]));
}

class LiveFolder : public testing::Test {
 protected:
  LiveFolder() {
    std::string pattern = (fs::temp_directory_path() / "taut_live_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~LiveFolder() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(LiveFolder, DragsAndPushesAreInTheTrace) {
  viewer::LiveOptions options;
  options.paused = true;
  options.record = viewer::RecordInto(folder_.string());
  {
    const Serving serving(Live(kHang, options));
    Client client(serving.port());
    client.Await("hello");
    client.Send({{"type", "step"}, {"count", 100}});
    client.Send({{"type", "drag"}, {"node", "mass"}, {"target_m", {0.2, 0, 1}}});
    client.Send({{"type", "step"}, {"count", 100}});
    client.Send({{"type", "drop"}});
    client.Send({{"type", "push"}, {"node", "mass"}, {"force_n", {0, 3, 0}}, {"duration_s", 0.05}});
    client.Send({{"type", "step"}, {"count", 100}});
    client.AwaitFrame([](const auto& f) { return f[FrameHeader::kFrameTimeS] > 0.2999; });
    client.Send({{"type", "reset"}});
    client.AwaitFrame([](const auto& f) { return f[FrameHeader::kFrameRun] == 2; });
  }
  Diagnostics found;
  const auto trace = ReadTrace((folder_ / "trace.h5").string(), found);
  ASSERT_TRUE(trace) << found.Format();
  ASSERT_EQ(trace->time_s.size(), 61u);  // 200 Hz
  const auto value = [&](const char* name, std::size_t row) {
    return trace->values[*trace->Find(name)][row];
  };
  EXPECT_EQ(value("hand/drag/node", 20), -1);
  EXPECT_GE(value("hand/drag/node", 21), 0);
  EXPECT_GT(value("hand/drag/force_x_n", 21), 0);
  EXPECT_EQ(value("hand/drag/node", 41), -1);
  EXPECT_EQ(value("hand/push/force_y_n", 41), 3);
  EXPECT_EQ(value("hand/push/node", 60), -1);
  EXPECT_TRUE(fs::exists(folder_ / "trace_2.h5"));
  std::ifstream events(folder_ / "events.jsonl");
  std::vector<std::string> lines;
  for (std::string line; std::getline(events, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(Json::parse(lines[0])["text"], "drag mass");
  EXPECT_NEAR(Json::parse(lines[0])["time_s"].get<double>(), 0.1, 1e-9);
  EXPECT_EQ(Json::parse(lines[1])["text"], "released");
  EXPECT_EQ(Json::parse(lines[2])["text"], "push mass with (0, 3, 0) N for 0.05 s");
}

TEST(LiveView, EditsOfEveryClientAreDoneInTheirOrder) {
  const Serving serving(PausedLive(kPush));
  Client client(serving.port());
  client.Await("scene");
  for (int i = 1; i <= 2000; ++i) {
    client.Send({{"type", "set_setpoint"}, {"cable", "inner_top_1"}, {"value", 0.01 * i}});
  }
  int count = 0;
  client.AwaitText([&](const Json& message) {
    if (message["type"] == "event") ++count;
    return count == 2000;
  });
  EXPECT_EQ(count, 2000);
  const Json scene = client.Await("scene")["scene"];
  double set_n = 0;
  for (const Json& control : scene["controls"]) {
    if (control["cable"] == "inner_top_1") set_n = control["tension_offset_n"];
  }
  EXPECT_EQ(set_n, 0.01 * 2000);
}

TEST(LiveView, AParameterOfTheFilesStartsAnew) {
  const Serving serving(PausedLive(kPush));
  Client client(serving.port());
  client.Await("scene");
  client.Send({{"type", "step"}, {"count", 5}});
  client.Send({{"type", "set_parameter"}, {"name", "push_n"}, {"value", 30}});
  const Json scene = client.Await("scene")["scene"];
  double push_n = 0;
  for (const Json& parameter : scene["parameters"]) {
    if (parameter["name"] == "push_n") push_n = parameter["value"];
  }
  EXPECT_EQ(push_n, 30);
  const auto frame =
      client.AwaitFrame([](const auto& f) { return f[FrameHeader::kFrameRun] == 2; });
  EXPECT_EQ(frame[FrameHeader::kFrameTimeS], 0);
}

/// Returns the frame's numbers, with NaN (such as an undefined set point) replaced by a comparable
/// number.
std::vector<double> Comparable(ReceivedFrame frame) {
  std::replace_if(
      frame.numbers.begin(), frame.numbers.end(), [](double x) { return std::isnan(x); }, -1e300);
  return frame.numbers;
}

TEST(LiveView, ItsPastIsLookedAtAndPlotted) {
  const Serving serving(PausedLive(kHang));
  Client client(serving.port());
  client.Await("scene");
  const auto until = [&](double time_s) {
    const ReceivedFrame frame = client.AwaitFrame(
        [time_s](const auto& f) { return std::fabs(f[FrameHeader::kFrameTimeS] - time_s) < 1e-9; });
    if (frame.numbers.empty()) throw std::runtime_error(fmt::format("never at {} s", time_s));
    return frame;
  };
  client.Send({{"type", "push"}, {"node", "mass"}, {"force_n", {0, 3, 0}}, {"duration_s", 0.05}});
  client.Send({{"type", "step"}, {"count", 40}});
  const auto then = until(0.04);
  client.Send({{"type", "step"}, {"count", 205}});
  const auto now = until(0.245);
  // Seek: the shown frame is from the past, the run's time does not change.
  client.Send({{"type", "seek"}, {"time_s", 0.0412}});
  const auto seen = until(0.04);
  EXPECT_EQ(seen[FrameHeader::kFrameNowS], now[FrameHeader::kFrameTimeS]);
  EXPECT_EQ(seen.numbers.size(), then.numbers.size()) << "the push is seen, too";
  for (std::size_t i = FrameHeader::kFrameHeaderSize; i < then.numbers.size(); ++i) {
    EXPECT_EQ(Comparable(seen)[i], Comparable(then)[i]) << i;
  }
  client.Send({{"type", "step"}, {"count", -2}});
  until(0.02);
  client.Send({{"type", "step"}, {"count", -1000}});
  until(0);
  client.Send({{"type", "step"}, {"count", 1000}});
  EXPECT_EQ(Comparable(until(0.245)), Comparable(now)) << "the present, as it was";
  client.Send({{"type", "step"}, {"count", -1}});
  until(0.24);
  client.Send({{"type", "seek"}, {"time_s", 99}});
  until(0.245);
  client.Send({{"type", "step"}});
  until(0.246);
  client.Send({{"type", "seek"}, {"time_s", 0.1}});
  until(0.1);
  client.Send({{"type", "resume"}});
  client.AwaitFrame([](const auto& f) { return f[FrameHeader::kFrameTimeS] > 0.247; });
  client.Send({{"type", "want_series"},
               {"id", 5},
               {"channel", "body/hanging_mass/position_y_m"},
               {"t0", 0},
               {"t1", 0.04},
               {"points", 100}});
  const Json answer = client.Await("series");
  EXPECT_EQ(answer["id"], 5);
  EXPECT_EQ(answer["series"]["first"][4], then.numbers[then.bodies() + 1]);
  client.Send({{"type", "want_series"},
               {"id", 6},
               {"channel", "body/absent/position_y_m"},
               {"t0", 0},
               {"t1", 1},
               {"points", 100}});
  EXPECT_EQ(client.Await("error")["text"], "there is no channel \"body/absent/position_y_m\"");
}

TEST(LiveView, EveryChannelOfARunIsPlotted) {
  ExperimentSpec experiment = LoadSpec(kPush);
  experiment.duration_s = 0.2;
  const Trace run = Recording(experiment).trace;
  const Serving serving(PausedLive(kPush));
  Client client(serving.port());
  std::set<std::string> offered;
  const Json scene = client.Await("scene")["scene"];
  for (const Json& channel : scene["channels"]) {
    offered.insert(channel["name"]);
  }
  client.Send({{"type", "step"}, {"count", 200}});
  client.AwaitFrame([](const auto& f) { return f[FrameHeader::kFrameTimeS] > 0.1999; });
  for (std::size_t i = 0; i < run.channels.size(); ++i) {
    const std::string& name = run.channels[i].name;
    ASSERT_TRUE(offered.contains(name)) << name;
    client.Send({{"type", "want_series"},
                 {"id", 1},
                 {"channel", name},
                 {"t0", 0},
                 {"t1", 1},
                 {"points", 100}});
    const Json series = client.Await("series")["series"];
    ASSERT_EQ(series["first"].size(), 21u) << name;
    for (std::size_t row = 0; row <= 20; ++row) {
      ASSERT_EQ(series["first"][row], run.values[i][row]) << name << " in row " << row;
    }
  }
  EXPECT_TRUE(offered.contains("node/" + experiment.robot.def.nodes[0].name + "/position_x_m"));
  EXPECT_TRUE(offered.contains("hand/drag/force_x_n"));
}

TEST(LiveView, UnitsAndSetPointsAreWhatTheyAre) {
  const Serving serving(PausedLive(kPush)), passive(PausedLive(kHang));
  Client client(serving.port()), other(passive.port());
  const Json scene = client.Await("scene")["scene"];
  std::map<std::string, std::string> units;
  for (const Json& parameter : scene["parameters"]) units[parameter["name"]] = parameter["unit"];
  EXPECT_EQ(units["rod_mass_kg_per_m"], "kg/m");
  EXPECT_EQ(units["rod_radius_m"], "m");
  EXPECT_EQ(units["push_n"], "N");
  const auto set_points = [](const Json& of) {
    return std::count_if(of["channels"].begin(), of["channels"].end(), [](const Json& channel) {
      return channel["name"].get<std::string>().ends_with("/setpoint_n");
    });
  };
  EXPECT_EQ(set_points(scene), 12);
  EXPECT_EQ(set_points(other.Await("scene")["scene"]), 0);
  const ReceivedFrame frame = other.AwaitFrame();
  EXPECT_TRUE(std::isnan(frame.numbers.at(frame.cables() + 3)));
}

TEST(LiveView, AValueThatIsRefusedLeavesTheEarlierOnes) {
  const Serving serving(PausedLive(kHang));
  Client client(serving.port());
  client.Await("scene");
  const auto set = [&](const char* name, double value) {
    client.Send({{"type", "set_parameter"}, {"name", name}, {"value", value}});
  };
  const auto shown = [&](const char* wanted) {
    const Json scene = client.Await("scene")["scene"];
    for (const Json& parameter : scene["parameters"]) {
      if (parameter["name"] == wanted) return parameter["value"].get<double>();
    }
    return std::nan("");
  };
  set("mass_kg", 0.75);
  EXPECT_EQ(shown("mass_kg"), 0.75);
  set("mass_kg", 0);
  EXPECT_NE(client.Await("error")["text"].get<std::string>().find("mass_kg"), std::string::npos);
  set("rest_length_m", 1.25);
  EXPECT_EQ(shown("mass_kg"), 0.75);
}

TEST(LiveView, StopsAtTheEndOfTheExperimentAndGoesOnWhenAsked) {
  viewer::LiveOptions options;
  options.speed = 0;
  const Serving serving(Live(kHang, options));
  Client client(serving.port());
  const auto end = client.AwaitFrame([](const auto& f) {
    return f[FrameHeader::kFrameTimeS] >= 5 && f[FrameHeader::kFramePaused] == 1;
  });
  EXPECT_EQ(end[FrameHeader::kFrameTimeS], 5);
  client.Send({{"type", "resume"}});
  EXPECT_FALSE(client.AwaitFrame([](const auto& f) { return f[FrameHeader::kFrameTimeS] > 5; })
                   .numbers.empty());
}

}  // namespace
}  // namespace taut::test
