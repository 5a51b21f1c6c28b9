// Replays: poses as in the file, seeking, plots at every resolution, damaged traces
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "apps/viewer/report.h"
#include "tests/viewer/replay_folder.h"

namespace taut::test {
namespace {

namespace fs = std::filesystem;
using viewer::FrameHeader;

using Replay = ReplayFolder;

TEST_F(Replay, ShowsThePosesAndTensionsOfTheFile) {
  Diagnostics found;
  const Trace file = *ReadTrace(trace(), found);
  const Serving serving(Session());
  Client client(serving.port());
  const Json hello = client.Await("hello");
  EXPECT_EQ(hello["mode"], "replay");
  EXPECT_EQ(hello["title"], "push_20n");
  const Json scene = client.Await("scene")["scene"];
  EXPECT_EQ(scene["channels"].size(), file.channels.size() + 3 * scene["nodes"].size());
  EXPECT_EQ(scene["first_s"], 0);
  EXPECT_EQ(scene["duration_s"], 0.5);
  for (const std::size_t row : {0u, 1u, 17u, 50u}) {
    client.Send({{"type", "seek"}, {"time_s", file.time_s[row]}});
    const ReceivedFrame frame = client.AwaitFrame(
        [&](const auto& f) { return f[FrameHeader::kFrameTimeS] == file.time_s[row]; });
    for (std::size_t b = 0; b < 3; ++b) {
      const std::string body = "body/" + experiment_.robot.def.bodies[b].name + "/";
      const char* const pose[] = {"position_x_m",  "position_y_m",  "position_z_m", "orientation_w",
                                  "orientation_x", "orientation_y", "orientation_z"};
      for (std::size_t i = 0; i < 7; ++i) {
        EXPECT_EQ(frame.numbers.at(frame.bodies() + 7 * b + i),
                  file.values[*file.Find(body + pose[i])][row]);
      }
    }
    for (std::size_t c = 0; c < 12; ++c) {
      const std::string cable = "cable/" + experiment_.robot.def.cables[c].name + "/";
      const char* const values[] = {"tension_n", "length_m", "rest_length_m", "setpoint_n"};
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(frame.numbers.at(frame.cables() + 4 * c + i),
                  file.values[*file.Find(cable + values[i])][row]);
      }
    }
    EXPECT_EQ(frame[FrameHeader::kFrameKineticJ], file.values[*file.Find("system/kinetic_j")][row]);
    EXPECT_EQ(frame[FrameHeader::kFrameContactCount],
              file.values[*file.Find("system/contact_count")][row]);
  }
}

TEST_F(Replay, PlaysStepsAndStopsAtTheEnd) {
  const Serving serving(Session());
  Client client(serving.port());
  const auto at = [&](double time_s, double paused) {
    return !client
                .AwaitFrame([&](const auto& f) {
                  return std::abs(f[FrameHeader::kFrameTimeS] - time_s) < 1e-9 &&
                         f[FrameHeader::kFramePaused] == paused;
                })
                .numbers.empty();
  };
  client.Send({{"type", "step"}, {"count", 3}});
  EXPECT_TRUE(at(0.03, 1));
  client.Send({{"type", "step"}, {"count", -1}});
  EXPECT_TRUE(at(0.02, 1));
  client.Send({{"type", "step"}, {"count", 1000}});
  EXPECT_TRUE(at(0.5, 1));
  client.Send({{"type", "reset"}});
  EXPECT_TRUE(at(0, 1));
  client.Send({{"type", "resume"}});
  EXPECT_TRUE(at(0.5, 1));  // played to its end
  client.Send({{"type", "drag"}, {"node", "a"}, {"target_m", {0, 0, 0}}});
  EXPECT_EQ(client.Await("error")["text"], "drag is not possible in a replay");
}

TEST_F(Replay, AnyoneMayAskForSeries) {
  Diagnostics found;
  const Trace file = *ReadTrace(trace(), found);
  const std::string channel = "cable/outer_top_1/tension_n";
  const std::vector<double>& column = file.values[*file.Find(channel)];
  const Serving serving(Session());
  Client driver(serving.port()), client(serving.port());
  driver.Send({{"type", "pause"}});
  driver.Await("driver");
  const auto ask = [&](const std::string& name, int points) {
    client.Send({{"type", "want_series"},
                 {"id", 7},
                 {"channel", name},
                 {"t0", 0},
                 {"t1", 0.5},
                 {"points", points}});
  };
  ask(channel, 100);
  const Json all = client.Await("series");
  EXPECT_EQ(all["id"], 7);
  EXPECT_EQ(all["series"]["level"], 1);
  EXPECT_EQ(all["series"]["first"].get<std::vector<double>>(), column);
  EXPECT_EQ(all["series"]["time_s"].get<std::vector<double>>(), file.time_s);
  ask(channel, 8);
  const Json coarse = client.Await("series")["series"];
  EXPECT_EQ(coarse["level"], 8);
  EXPECT_EQ(coarse["max"][0], *std::max_element(column.begin(), column.begin() + 8));
  EXPECT_EQ(coarse["min"][6], *std::min_element(column.begin() + 48, column.end()));
  EXPECT_EQ(coarse["first"][6], column[48]);
  ask("cable/nobody/tension_n", 8);
  EXPECT_EQ(client.Await("error")["text"], "there is no channel \"cable/nobody/tension_n\"");
}

// Oracle: the same run with recorded nodes
TEST_F(Replay, NodesThatWereNotRecordedFollowFromBodies) {
  Diagnostics found;
  ExperimentSpec all = experiment_;
  all.record.channels = {"*"};
  const auto writer = CreateHdf5Trace((folder_ / "all.h5").string(), RunChannels(all), {}, found);
  RunOptions options;
  options.traces = {writer.get()};
  ASSERT_TRUE(RunExperiment(all, options, found)) << found.Format();
  const Trace file = *ReadTrace((folder_ / "all.h5").string(), found);
  const auto recorded = Load(trace());
  std::size_t compared = 0;
  for (const NodeDef& node : experiment_.robot.def.nodes) {
    for (const char* axis : {"x", "y", "z"}) {
      const std::string name = "node/" + node.name + "/position_" + axis + "_m";
      const auto series = recorded->SeriesOf(name, 0, 0, 1, 1000);
      ASSERT_TRUE(series) << name;
      const std::vector<double>& column = file.values[*file.Find(name)];
      ASSERT_EQ(series->first.size(), column.size());
      for (std::size_t row = 0; row < column.size(); ++row, ++compared) {
        ASSERT_NEAR(series->first[row], column[row], 1e-13) << name << " in row " << row;
      }
    }
  }
  EXPECT_GT(compared, 1000u);
  EXPECT_FALSE(recorded->SeriesOf("node/nobody/position_x_m", 0, 0, 1, 9));
}

/// Decodes the numbers of a report's rows: the times, then the values of each channel.
std::vector<double> NumbersOf(const Json& rows) {
  std::vector<double> numbers;
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : rows["base64"].get<std::string>()) {
    static const std::string digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    if (c == '=') break;
    group = group << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((bits += 6) < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 255);
  }
  numbers.resize(bytes.size() / sizeof(double));
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

TEST_F(Replay, AReportHoldsTheRowsOfTheFile) {
  Diagnostics found;
  const Trace file = *ReadTrace(trace(), found);
  const Json report = viewer::ReportOf(*Load(trace()));
  ASSERT_EQ(report["rows"].size(), 1u);
  const Json& rows = report["rows"][0];
  EXPECT_EQ(rows["level"], 1);
  EXPECT_EQ(rows["count"], file.time_s.size());
  const std::vector<double> numbers = NumbersOf(rows);
  const std::size_t count = file.time_s.size();
  ASSERT_EQ(numbers.size(), count * (1 + rows["channels"].size()));
  const auto at = [&](std::size_t place) {
    const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(place * count);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  EXPECT_EQ(at(0), file.time_s);
  for (std::size_t i = 0; i < rows["channels"].size(); ++i) {
    EXPECT_EQ(at(1 + i), file.values[*file.Find(rows["channels"][i])]) << rows["channels"][i];
  }
  EXPECT_TRUE(std::any_of(rows["channels"].begin(), rows["channels"].end(),
                          [](const Json& name) { return name == "body/segment_0/position_z_m"; }));
}

TEST_F(Replay, AReportOfALongTraceHoldsBlocksOfItsRows) {
  Diagnostics found;
  const Trace file = *ReadTrace(trace(), found);
  const std::size_t channels = viewer::ReportOf(*Load(trace()))["rows"][0]["channels"].size();
  const std::size_t room = 14 * (1 + 3 * channels);  // 51 rows: 13 blocks of 4
  const Json rows = viewer::ReportOf(*Load(trace()), room)["rows"][0];
  EXPECT_EQ(rows["level"], 4);
  EXPECT_EQ(rows["count"], 13);
  const std::vector<double> numbers = NumbersOf(rows);
  ASSERT_EQ(numbers.size(), 13 * (1 + 3 * channels));
  for (std::size_t i = 0; i < channels; ++i) {
    const auto& column = file.values[*file.Find(rows["channels"][i])];
    for (std::size_t block = 0; block < 13; ++block) {
      const auto begin = column.begin() + static_cast<std::ptrdiff_t>(4 * block);
      const auto end =
          column.begin() + static_cast<std::ptrdiff_t>(std::min(4 * block + 4, column.size()));
      EXPECT_EQ(numbers[block], file.time_s[4 * block]);
      EXPECT_EQ(numbers[13 * (1 + 3 * i) + block], *begin);
      EXPECT_EQ(numbers[13 * (2 + 3 * i) + block], *std::min_element(begin, end));
      EXPECT_EQ(numbers[13 * (3 + 3 * i) + block], *std::max_element(begin, end));
    }
  }
  EXPECT_EQ(viewer::ReportOf(*Load(trace()), 1)["rows"][0]["count"], 1) << "never nothing";
}

TEST_F(Replay, AnotherTraceIsCalledWhatItSaysOfItself) {
  Diagnostics found;
  const auto reference = [&](const std::string& name) {
    auto recorded = viewer::Recorded::Load(trace(), {(folder_ / name).string()}, found);
    EXPECT_TRUE(recorded) << found.Format();
    return recorded->scene()["compared"][0];
  };
  const auto write = [&](const std::string& name, const TraceMetadata& metadata) {
    const auto writer = CreateHdf5Trace((folder_ / name).string(), {{"a_n", "N"}}, metadata, found);
    const double value = 1;
    EXPECT_TRUE(writer->Append(0, &value) && writer->Finish());
  };
  const std::string folder = folder_.filename().string();
  write("other.h5", {{"taut_version", "1"}, {"experiment", "push_30n"}});
  EXPECT_EQ(reference("other.h5")["name"], "push_30n (" + folder + "/other.h5)");
  EXPECT_EQ(reference("other.h5")["measured"], false);
  write("robot.h5", {{"measured", "the robot, trial 3"}});
  EXPECT_EQ(reference("robot.h5")["name"], "the robot, trial 3 (" + folder + "/robot.h5)");
  EXPECT_EQ(reference("robot.h5")["measured"], true);
  Write("plain.csv", "time_s,a_n\n0,1\n");
  EXPECT_EQ(reference("plain.csv")["name"], folder + "/plain.csv");
  EXPECT_EQ(reference("plain.csv")["measured"], false);
}

TEST_F(Replay, ARunWithoutAControllerHasNoSetPoint) {
  Diagnostics found;
  const auto of = [&](const std::string& path) {
    const auto channels = RunChannels(*LoadExperiment(path, {}, found));
    return std::count_if(channels.begin(), channels.end(), [](const ChannelInfo& channel) {
      return channel.name.ends_with("/setpoint_n") ||
             channel.name.ends_with("/velocity_input_m_per_s");
    });
  };
  EXPECT_EQ(of(kHang), 0);
  EXPECT_EQ(of(kPush), 24);
}

TEST_F(Replay, WithoutInputsBodiesAreBallsAndThatIsSaid) {
  fs::remove(folder_ / "inputs.yaml");
  auto recorded = Load(trace());
  EXPECT_EQ(recorded->notice(),
            "there is no inputs.yaml in the trace's folder: bodies are shown as spheres");
  Json scene = Json::parse(viewer::Dump(recorded->scene()));
  EXPECT_EQ(scene["notice"], recorded->notice());
  ASSERT_EQ(scene["bodies"].size(), 3u);
  EXPECT_EQ(scene["bodies"][0]["shapes"][0]["kind"], "sphere");
  EXPECT_EQ(scene["cables"].size(), 12u);
  EXPECT_EQ(recorded->FrameOf(3).bodies.size(), 3u);

  Write("inputs.yaml", "taut: 2");
  EXPECT_EQ(Load(trace())->notice(),
            "inputs.yaml belongs to another trace: bodies are shown as spheres");
  Diagnostics found;
  Write("inputs.yaml", ResolvedYaml(*LoadExperiment(kHang, {}, found)));
  EXPECT_EQ(Load(trace())->notice(),
            "inputs.yaml belongs to another trace: bodies are shown as spheres");
}

TEST_F(Replay, ATraceThatEndsEarlyShowsWhatIsThere) {
  experiment_.duration_s = 60;
  WriteInputs();
  const auto recorded = Load(trace());
  EXPECT_EQ(recorded->notice(), "the trace ends at 0.5 s of 60 s");
  EXPECT_EQ(recorded->trace().time_s.size(), 51u);
}

TEST_F(Replay, ABrokenTraceCannotBeLoaded) {
  Write("trace.h5", "no trace at all");
  Diagnostics found;
  EXPECT_FALSE(viewer::Recorded::Load(trace(), {}, found));
  EXPECT_NE(found.Format().find("is not HDF5 or is damaged"), std::string::npos);
  Write("empty.csv", "time_s,a\n");
  Diagnostics empty;
  EXPECT_FALSE(viewer::Recorded::Load((folder_ / "empty.csv").string(), {}, empty));
  EXPECT_NE(empty.Format().find("the trace has no rows"), std::string::npos);
}

TEST_F(Replay, PushesHaveTheirArrows) {
  experiment_.duration_s = 40;
  experiment_.record.rate_hz = 1;
  Diagnostics found;
  const auto writer = CreateHdf5Trace(trace(), RunChannels(experiment_), {}, found);
  RunOptions options;
  options.traces = {writer.get()};
  ASSERT_TRUE(RunExperiment(experiment_, options, found));
  WriteInputs();
  const viewer::Frame frame = Load(trace())->FrameOf(38);
  ASSERT_EQ(frame.pushes.size(), 3u);
  EXPECT_NEAR(frame.pushes[0].force_n.x, 22.563, 1e-9);
  EXPECT_NEAR(frame.pushes[1].force_n.x, -0.45 * 22.563, 1e-9);
  EXPECT_EQ(experiment_.robot.def.nodes[static_cast<std::size_t>(frame.pushes[0].node)].name,
            "segment_0.tip");
}

TEST(ViewPyramid, EveryLevelAgreesWithTheRows) {
  std::vector<double> times, values;
  for (int i = 0; i < 1003; ++i) {
    times.push_back(0.01 * i);
    values.push_back(i % 7 == 3 ? std::numeric_limits<double>::quiet_NaN() : std::sin(0.1 * i) * i);
  }
  for (int i = 512; i < 520; ++i) values[static_cast<std::size_t>(i)] = HUGE_VAL - HUGE_VAL;
  const viewer::Pyramid pyramid(values);
  for (const auto& [t0, t1, points] : {std::tuple{0.0, 20.0, 4u},
                                       {0.0, 20.0, 37u},
                                       {1.234, 7.5, 10u},
                                       {5.0, 5.0, 2u},
                                       {-3.0, 0.0, 5u},
                                       {10.0, 99.0, 3u},
                                       {0.0, 20.0, 2000u},
                                       {0.0, 20.0, 2u}}) {
    const viewer::Series series = pyramid.Get(times, values, t0, t1, points);
    ASSERT_LE(series.time_s.size(), points + 2);
    ASSERT_FALSE(series.time_s.empty());
    EXPECT_LE(series.time_s.front(), std::max(t0, 0.0));
    for (std::size_t i = 0; i < series.time_s.size(); ++i) {
      const auto first = static_cast<std::size_t>(
          std::lower_bound(times.begin(), times.end(), series.time_s[i]) - times.begin());
      EXPECT_EQ(first % series.level, 0u);
      double least = HUGE_VAL, greatest = -HUGE_VAL;
      for (std::size_t k = first; k < std::min(first + series.level, values.size()); ++k) {
        if (std::isnan(values[k])) continue;
        least = std::min(least, values[k]);
        greatest = std::max(greatest, values[k]);
      }
      EXPECT_TRUE(series.first[i] == values[first] ||
                  (std::isnan(series.first[i]) && std::isnan(values[first])));
      if (least > greatest) {
        EXPECT_TRUE(std::isnan(series.min[i]) && std::isnan(series.max[i]));
        continue;
      }
      EXPECT_EQ(series.min[i], least);
      EXPECT_EQ(series.max[i], greatest);
    }
  }
  EXPECT_TRUE(pyramid.Get(times, values, 2, 1, 10).time_s.size() <= 3);
  EXPECT_TRUE(viewer::Pyramid({}).Get({}, {}, 0, 1, 10).time_s.empty());
}

}  // namespace
}  // namespace taut::test
