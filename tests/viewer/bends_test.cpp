// Cables in contact with obstacles: frames of traces contain the recorded bends.
#include <algorithm>
#include <cmath>

#include "apps/viewer/report.h"
#include "tests/viewer/replay_folder.h"

namespace taut::test {
namespace {

class Bends : public ReplayFolder {
 protected:
  Bends() {
    Diagnostics found;
    experiment_ =
        *LoadExperiment(TAUT_SOURCE_DIR "/docs/tutorial_cables/over_wall.yaml", {}, found);
    experiment_.duration_s = 0.4;  // it lies on the wall from 0.1 s on
    WriteInputs();
  }

  std::string RecordIn(const std::string& name, const ExperimentSpec& experiment) const {
    std::filesystem::create_directories(folder_ / name);
    Write(name + "/inputs.yaml", ResolvedYaml(experiment_));
    Record((folder_ / name / "trace.h5").string(), experiment);
    return (folder_ / name / "trace.h5").string();
  }
  /// Records a run without bend channels, as in old traces.
  std::string RecordStraight() const {
    ExperimentSpec without = experiment_;
    without.robot.def.cables[0].touches = CableTouches::kNone;
    without.robot.def.cables[0].radius_m = 0;
    return RecordIn("straight", without);
  }
};

/// Returns the bends of a row, as many as its channel `bends` counts.
std::vector<double> InRow(const Trace& file, std::size_t row, int cable) {
  std::vector<double> numbers;
  const auto value = [&](const std::string& name) {
    return file.values[*file.Find("cable/rope/" + name)][row];
  };
  for (int i = 1; i <= static_cast<int>(value("bends")); ++i) {
    numbers.push_back(cable);
    for (const char* axis : {"x", "y", "z"}) {
      numbers.push_back(value("bend_" + std::to_string(i) + "_" + axis + "_m"));
    }
  }
  return numbers;
}

std::vector<double> Numbers(const std::vector<viewer::Frame::Bend>& bends) {
  std::vector<double> numbers;
  for (const auto& [cable, place] : bends) {
    for (const double x : {static_cast<double>(cable), place.x, place.y, place.z}) {
      numbers.push_back(x);
    }
  }
  return numbers;
}

TEST_F(Bends, AreThoseOfTheRowsAndOfTheGhostsRows) {
  Diagnostics found;
  const std::string here = RecordIn("here", experiment_);
  ExperimentSpec higher = experiment_;
  for (BodyDef& body : higher.robot.def.bodies) body.velocity_m_per_s.z = -0.5;
  const std::string there = RecordIn("there", higher);
  const auto recorded = Load(here, {RecordStraight(), there});
  const Trace file = *ReadTrace(here, found), other = *ReadTrace(there, found);
  std::size_t bent = 0, apart = 0;
  for (std::size_t row = 0; row < file.time_s.size(); ++row) {
    std::vector<double> expected = InRow(file, row, 0);
    const std::vector<double> ghost = InRow(other, row, 2);
    bent += expected.size() == 8;
    apart += expected.size() != ghost.size();
    expected.insert(expected.end(), ghost.begin(), ghost.end());
    ASSERT_EQ(Numbers(recorded->FrameOf(row).bends), expected) << row;
  }
  EXPECT_GT(bent, 10u);
  EXPECT_GT(apart, 1u);
  const viewer::Json report = viewer::ReportOf(*recorded);
  const auto plotted = [&](const std::string& channel) {
    const viewer::Json& names = report["rows"][0]["channels"];
    return std::find(names.begin(), names.end(), channel) != names.end();
  };
  EXPECT_TRUE(plotted("cable/rope/bends"));
  EXPECT_FALSE(plotted("cable/rope/bend_1_x_m"));  // shown by the frames, not as a curve
}

TEST_F(Bends, ATraceWithoutThemIsDrawnStraightAndSaysNothing) {
  const auto recorded = Load(RecordStraight());
  EXPECT_EQ(recorded->scene()["cables"][0]["most_bends"], CableDef::kMostBends);
  for (const std::size_t row : {0u, 20u, 40u}) EXPECT_TRUE(recorded->FrameOf(row).bends.empty());
  EXPECT_EQ(recorded->notice(), "");
}

TEST_F(Bends, PartACableWithFrictionIntoSpans) {
  Diagnostics found;
  ExperimentSpec rough = experiment_;
  rough.robot.def.cables[0].touch_friction = 0.2;
  rough.robot.def.bodies[1].mass_kg *= 1.5;
  const std::string path = RecordIn("rough", rough);
  const auto recorded = Load(path, {});
  const Trace file = *ReadTrace(path, found);
  std::size_t parted = 0;
  for (std::size_t row = 0; row < file.time_s.size(); ++row) {
    const auto value = [&](const std::string& name) {
      return file.values[*file.Find("cable/rope/" + name)][row];
    };
    const std::vector<viewer::Frame::Span> spans = recorded->FrameOf(row).spans;
    ASSERT_EQ(static_cast<double>(spans.size()), value("bends") + 1) << row;
    for (std::size_t i = 0; i < spans.size(); ++i) {
      EXPECT_EQ(spans[i].cable, 0);
      EXPECT_EQ(spans[i].tension_n, value("span_" + std::to_string(i + 1) + "_tension_n"));
    }
    EXPECT_TRUE(std::isnan(value("span_9_tension_n")));
    parted += spans.size() == 3 && spans[2].tension_n > 1.2 * spans[0].tension_n;
  }
  EXPECT_GT(parted, 10u);
  EXPECT_GT(viewer::ReportOf(*recorded)["frame_values"], 0);
}

}  // namespace
}  // namespace taut::test
