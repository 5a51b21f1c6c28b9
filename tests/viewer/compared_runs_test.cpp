// Comparison of several runs, and contact forces, in replays and reports
#include <algorithm>
#include <cmath>

#include "apps/viewer/report.h"
#include "apps/viewer/run_names.h"
#include "tests/viewer/replay_folder.h"

namespace taut::test {
namespace {

namespace fs = std::filesystem;

class ComparedRuns : public ReplayFolder {
 protected:
  /// Records the changed experiment in a separate folder.
  std::string RecordIn(const std::string& name, const ExperimentSpec& experiment,
                       bool inputs = true) const {
    fs::create_directories(folder_ / name);
    Record((folder_ / name / "trace.h5").string(), experiment, {{"experiment", experiment.name}});
    if (inputs) Write(name + "/inputs.yaml", ResolvedYaml(experiment));
    return (folder_ / name / "trace.h5").string();
  }

  /// Returns an experiment of half the duration at half the rate, without control.
  ExperimentSpec Other() const {
    ExperimentSpec other = experiment_;
    other.duration_s = 0.25;
    other.record.rate_hz = 50;
    other.controllers.clear();
    return other;
  }
};

/// Returns the last row at or before a time, up to rounding.
std::size_t RowUntil(const Trace& file, double time_s) {
  const auto after = std::upper_bound(file.time_s.begin(), file.time_s.end(), time_s + 1e-9);
  return static_cast<std::size_t>(after - file.time_s.begin()) - 1;
}

void ExpectPose(const viewer::Frame::Body& shown, const Trace& file, const std::string& body,
                std::size_t row) {
  const auto value = [&](const char* name) {
    return file.values[*file.Find("body/" + body + "/" + name)][row];
  };
  EXPECT_EQ(shown.position_m.x, value("position_x_m"));
  EXPECT_EQ(shown.position_m.z, value("position_z_m"));
  EXPECT_EQ(shown.orientation.w, value("orientation_w"));
  EXPECT_EQ(shown.orientation.z, value("orientation_z"));
}

TEST_F(ComparedRuns, GhostsHaveThePosesOfTheirOwnRows) {
  Diagnostics found;
  const std::string a = RecordIn("a", Other());
  ExperimentSpec hang = *LoadExperiment(kHang, {}, found);
  hang.duration_s = 1;
  hang.record.channels.clear();
  const std::string b = RecordIn("b", hang);  // another robot, another sample rate
  const auto recorded = Load(trace(), {a, b});
  const Trace file_a = *ReadTrace(a, found), file_b = *ReadTrace(b, found);
  const viewer::Json scene = recorded->scene();
  ASSERT_EQ(scene["compared"].size(), 2u);
  EXPECT_EQ(scene["compared"][0]["bodies"].size(), 3u);
  EXPECT_EQ(scene["compared"][0]["cables"].size(), 12u);
  EXPECT_EQ(scene["compared"][1]["bodies"].size(), 1u);
  EXPECT_EQ(scene["compared"][1]["last_s"], 1);
  for (const std::size_t row : {0u, 1u, 12u, 25u, 26u}) {
    const viewer::Frame frame = recorded->FrameOf(row);
    ASSERT_EQ(frame.ghosts.size(), 4u);
    for (std::size_t body = 0; body < 3; ++body) {
      ExpectPose(frame.ghosts[body], file_a, experiment_.robot.def.bodies[body].name,
                 RowUntil(file_a, frame.time_s));
    }
    ExpectPose(frame.ghosts[3], file_b, hang.robot.def.bodies[0].name,
               RowUntil(file_b, frame.time_s));
  }
  const viewer::Frame late = recorded->FrameOf(28);  // 0.28 s: run a ended at 0.25 s
  EXPECT_TRUE(std::isnan(late.ghosts[0].position_m.x) && std::isnan(late.ghosts[2].orientation.w));
  EXPECT_FALSE(std::isnan(late.ghosts[3].position_m.x));
}

TEST_F(ComparedRuns, SeriesComeFromTheRunOfTheirSource) {
  Diagnostics found;
  const std::string a = RecordIn("a", Other()), b = RecordIn("b", experiment_);
  const auto recorded = Load(trace(), {a, b});
  const std::string channel = "cable/outer_top_1/tension_n";
  for (const auto& [source, path] : {std::pair{0, trace()}, {1, a}, {2, b}}) {
    const Trace file = *ReadTrace(path, found);
    const auto series = recorded->SeriesOf(channel, source, 0, 1, 1000);
    ASSERT_TRUE(series);
    EXPECT_EQ(series->first, file.values[*file.Find(channel)]) << source;
    EXPECT_EQ(series->time_s, file.time_s) << source;
  }
  EXPECT_FALSE(recorded->SeriesOf(channel, 3, 0, 1, 10));
  EXPECT_FALSE(recorded->SeriesOf("cable/outer_top_1/setpoint_n", 1, 0, 1, 10));
}

TEST_F(ComparedRuns, ARunWithoutPosesHasNoGhostAndThatIsSaid) {
  Write("measured.csv", "time_s,cable/outer_top_1/tension_n\n0,1\n0.5,2\n");
  const auto recorded = Load(trace(), {(folder_ / "measured.csv").string()});
  const viewer::Json run = recorded->scene()["compared"][0];
  EXPECT_EQ(run["bodies"].size(), 0u);
  EXPECT_EQ(run["notice"], "no ghost: the trace contains no poses of bodies");
  EXPECT_TRUE(recorded->FrameOf(3).ghosts.empty());
  // without inputs, bodies are drawn as balls; also of ghosts
  const auto balls = Load(trace(), {RecordIn("c", Other(), false)});
  EXPECT_EQ(balls->scene()["compared"][0]["bodies"][0]["shapes"][0]["kind"], "sphere");
  EXPECT_EQ(balls->scene()["compared"][0]["notice"],
            "there is no inputs.yaml in the trace's folder: bodies are shown as spheres");
}

TEST_F(ComparedRuns, NamesAreAsLongAsTellsThemApart) {
  Trace plain, pushed;
  pushed.metadata = {{"experiment", "push"}};
  EXPECT_EQ(viewer::RunNames({{&pushed, "/x/a/trace.h5"}, {&pushed, "/x/b/trace.h5"}}),
            (std::vector<std::string>{"push (a/trace.h5)", "push (b/trace.h5)"}));
  EXPECT_EQ(
      viewer::RunNames({{&pushed, "/x/a/run/trace.h5"},
                        {&pushed, "/x/b/run/trace.h5"},
                        {&plain, "/x/b/run/trace.h5"}}),
      (std::vector<std::string>{"push (a/run/trace.h5)", "push (b/run/trace.h5)", "run/trace.h5"}));
  EXPECT_EQ(viewer::RunNames({{&plain, "/t.csv"}, {&plain, "/t.csv"}, {&plain, "/t.csv"}}),
            (std::vector<std::string>{"t.csv", "t.csv #2", "t.csv #3"}));
}

TEST_F(ComparedRuns, EveryTraceThatCannotBeReadIsNamedAtOnce) {
  Write("empty.csv", "time_s,a\n");
  const std::string empty = (folder_ / "empty.csv").string();
  Diagnostics found;
  EXPECT_FALSE(viewer::Recorded::Load(trace(), {"absent.h5", empty, "nowhere.h5"}, found));
  const std::string said = found.Format();
  for (const char* why : {"absent.h5: error: cannot open", "nowhere.h5: error: cannot open",
                          "empty.csv: error: the trace has no rows"}) {
    EXPECT_NE(said.find(why), std::string::npos) << said;
  }
  Diagnostics many;
  EXPECT_FALSE(viewer::Recorded::Load(trace(), std::vector<std::string>(8, trace()), many));
  EXPECT_NE(many.Format().find("is compared with 8 runs, expected at most 7"), std::string::npos);
  EXPECT_EQ(Load(trace(), std::vector<std::string>(7, trace()))->compared().size(), 7u);
}

TEST_F(ComparedRuns, AReportHasTheRowsAndTheComparisonOfEachRun) {
  const auto recorded = Load(trace(), {RecordIn("a", Other()), RecordIn("b", experiment_)});
  const viewer::Json report = viewer::ReportOf(*recorded);
  ASSERT_EQ(report["rows"].size(), 3u);
  EXPECT_EQ(report["rows"][1]["count"], 14);  // 0.25 s at 50 Hz, and the end
  EXPECT_EQ(report["rows"][2]["count"], report["rows"][0]["count"]);
  ASSERT_EQ(report["comparisons"].size(), 2u);
  EXPECT_EQ(report["comparisons"][0]["a"]["name"], recorded->compared()[0]->run_name());
  EXPECT_EQ(report["comparisons"][0]["b"]["name"], recorded->run_name());
  EXPECT_EQ(report["comparisons"][1]["channels"][0]["rmse"], 0);
  EXPECT_EQ(report["facts"]["robot"], "tetraspine3: 3 bodies, 12 cables, 2.349 kg");
  EXPECT_EQ(report["facts"]["time"], "0.5 s in steps of 0.001 s");
  // two runs share the space of one
  const std::size_t channels = report["rows"][0]["channels"].size();
  EXPECT_EQ(viewer::ReportOf(*recorded, 3 * 51 * (1 + channels))["rows"][0]["level"], 1);
  EXPECT_GT(viewer::ReportOf(*recorded, 2 * 51 * (1 + channels))["rows"][0]["level"], 1);
}

TEST_F(ComparedRuns, ContactForcesOfATraceAreThoseThatWereRecorded) {
  EXPECT_EQ(Load(trace())->scene()["contact_forces"], false);
  EXPECT_TRUE(Load(trace())->FrameOf(50).contacts.empty());
  experiment_.record.contacts = 9;
  Record(trace(), experiment_);
  WriteInputs();
  Diagnostics found;
  const Trace file = *ReadTrace(trace(), found);
  const auto recorded = Load(trace());
  EXPECT_EQ(recorded->scene()["contact_forces"], true);
  std::size_t most = 0;
  for (const std::size_t row : {0u, 10u, 25u, 50u}) {
    const viewer::Frame frame = recorded->FrameOf(row);
    std::size_t filled = 0;
    for (int slot = 0; slot < 9; ++slot) {
      const auto value = [&](const std::string& name) {
        return file.values[*file.Find("contact/" + std::to_string(slot) + "/" + name)][row];
      };
      if (std::isnan(value("force_z_n"))) continue;
      ASSERT_LT(filled, frame.contacts.size());
      EXPECT_EQ(frame.contacts[filled].point_m.x, value("point_x_m"));
      EXPECT_EQ(frame.contacts[filled].force_n.y, value("force_y_n"));
      EXPECT_EQ(frame.contacts[filled].force_n.z, value("force_z_n"));
      ++filled;
    }
    EXPECT_EQ(frame.contacts.size(), filled);
    most = std::max(most, filled);
  }
  EXPECT_GT(most, 0u);
  // in a report all frames have room for the largest number of contacts, and contacts are not
  // curves
  const viewer::Json report = viewer::ReportOf(*recorded);
  EXPECT_EQ(report["frame_count"], 16);
  for (const viewer::Json& name : report["rows"][0]["channels"]) {
    EXPECT_FALSE(name.get<std::string>().starts_with("contact/"));
  }
}

TEST_F(ComparedRuns, ALiveRunRecordsContactsWhereItsExperimentAsksForThem) {
  Diagnostics found;
  const auto places = [](const LiveRun& run) {
    return std::count_if(run.channels().begin(), run.channels().end(),
                         [](const ChannelInfo& c) { return c.name.starts_with("contact/"); });
  };
  EXPECT_EQ(places(*LiveRun::Start(experiment_, found)), 0);
  experiment_.record.contacts = 12;
  const auto run = LiveRun::Start(experiment_, found);
  ASSERT_EQ(places(*run), 12 * 9);
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(run->Step());
  const std::vector<ContactState> contacts = run->world()->Contacts(0);
  ASSERT_FALSE(contacts.empty());
  const std::vector<double>& row = run->Row();
  for (std::size_t slot = 0; slot < 12; ++slot) {
    const std::string name = "contact/" + std::to_string(slot) + "/force_z_n";
    const auto at = std::find_if(run->channels().begin(), run->channels().end(),
                                 [&](const ChannelInfo& channel) { return channel.name == name; });
    const double value = row[static_cast<std::size_t>(at - run->channels().begin())];
    if (slot < contacts.size()) {
      EXPECT_EQ(value, contacts[slot].force_n.z);
    } else {
      EXPECT_TRUE(std::isnan(value));
    }
  }
}

}  // namespace
}  // namespace taut::test
