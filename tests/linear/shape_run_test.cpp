// Shape runs: mechanisms, states of self-stress and modes written as runs.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "math/vec.h"
#include "taut/run_folder.h"
#include "taut/shape_run.h"
#include "tests/linear/linear_robots.h"

namespace taut::test {
namespace {

namespace fs = std::filesystem;

class ShapeRun : public testing::Test {
 protected:
  ShapeRun() {
    const auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/prism3.yaml", {}, out_);
    experiment_ = ExperimentOf(robot->def);
    experiment_.robot = *robot;
    experiment_.robot.def.gravity_m_per_s2 = {};
    folder_ = fs::temp_directory_path() / ("taut_shapes_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~ShapeRun() override { fs::remove_all(folder_); }

  double At(const Trace& trace, const std::string& name, std::size_t row) {
    const auto channel = trace.Find(name);
    EXPECT_TRUE(channel) << name;
    return channel ? trace.values[*channel][row] : NAN;
  }
  Vec3 PlaceOf(const Trace& trace, const std::string& body, std::size_t row) {
    const std::string name = "body/" + body + "/position_";
    return {At(trace, name + "x_m", row), At(trace, name + "y_m", row),
            At(trace, name + "z_m", row)};
  }

  Diagnostics out_;
  ExperimentSpec experiment_;
  fs::path folder_;
};

TEST_F(ShapeRun, SwingsAsTheModeAndIsReadLikeARun) {
  const ModelDef& def = experiment_.robot.def;
  const Modes modes = FindModes(def);
  const ForceAnalysis forces = AnalyseForces(def, false);
  const std::vector<std::string> written =
      WriteShapeRuns(folder_.string(), experiment_, modes, forces, 2, {}, out_);
  ASSERT_TRUE(out_.ok()) << out_.Format();
  // A prism has one infinitesimal mechanism and one state of self-stress.
  ASSERT_EQ(written.size(), 4u);
  EXPECT_EQ(fs::path(written[2]).filename(), "mechanism_1");
  EXPECT_EQ(fs::path(written[3]).filename(), "self_stress_1");

  const auto first = std::find_if(modes.modes.begin(), modes.modes.end(),
                                  [](const Mode& mode) { return mode.kind != Mode::Kind::kRigid; });
  const auto trace = ReadTraceOfRun(written[0] + "/trace.h5", out_);
  ASSERT_TRUE(trace) << out_.Format();
  ASSERT_EQ(trace->time_s.size(), 121u);
  double greatest_m = 0;
  for (const NodeDef& node : def.nodes) {
    const auto b = static_cast<std::size_t>(node.body);
    const Vec3 way =
        first->translation_m[b] + Cross(first->turn_rad[b], node.position_m - def.bodies[b].com_m);
    greatest_m = std::max(greatest_m, std::sqrt(Dot(way, way)));
  }
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    const Vec3 t = first->translation_m[b];
    greatest_m = std::max(greatest_m, std::sqrt(Dot(t, t)));
  }
  const double amplitude = 0.08 * SizeOf(def) / greatest_m;
  for (const std::size_t row : {0u, 15u, 30u, 45u, 120u}) {  // 60 rows per oscillation
    const double share = std::sin(2 * std::numbers::pi * static_cast<double>(row) / 60);
    for (std::size_t b = 0; b < def.bodies.size(); ++b) {
      const std::string& name = def.bodies[b].name;
      const Vec3 wanted = def.bodies[b].com_m + amplitude * share * first->translation_m[b];
      const Vec3 off = PlaceOf(*trace, name, row) - wanted;
      EXPECT_LT(std::sqrt(Dot(off, off)), 1e-12) << name << " row " << row;
      const Vec3 turn = amplitude * share * first->turn_rad[b];
      EXPECT_NEAR(2 * std::acos(std::min(1.0, At(*trace, "body/" + name + "/orientation_w", row))),
                  std::sqrt(Dot(turn, turn)), 1e-7);
      // The same for the rotation: the sine of half its angle.
      const double half = std::sqrt(Dot(turn, turn)) / 2, by = half > 0 ? std::sin(half) / half : 1;
      EXPECT_NEAR(At(*trace, "body/" + name + "/orientation_x", row), by * turn.x / 2, 1e-12);
      EXPECT_NEAR(At(*trace, "body/" + name + "/orientation_y", row), by * turn.y / 2, 1e-12);
      EXPECT_NEAR(At(*trace, "body/" + name + "/orientation_z", row), by * turn.z / 2, 1e-12);
    }
  }
  for (const std::string& path : written) {
    const auto experiment = LoadExperiment(path + "/inputs.yaml", {}, out_);
    ASSERT_TRUE(experiment) << out_.Format();
    EXPECT_EQ(experiment->name, fs::path(path).filename());
  }
}

TEST_F(ShapeRun, SelfStressIsShownAsTensions) {
  const ModelDef& def = experiment_.robot.def;
  const ForceAnalysis forces = AnalyseForces(def, false);
  WriteShapeRuns(folder_.string(), experiment_, {}, forces, 0, {}, out_);
  const auto trace = ReadTraceOfRun((folder_ / "self_stress_1/trace.h5").string(), out_);
  ASSERT_TRUE(trace) << out_.Format();
  // Closed form: the force density of a side cable is 2 sin(60 degrees) times the density of a base
  // cable (share/models/prism3.yaml).
  double density[2] = {};
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const std::string name = "cable/" + def.cables[c].name + "/";
    const double q = At(*trace, name + "tension_n", 7) / At(*trace, name + "length_m", 7);
    double& of = density[def.cables[c].name.starts_with("side") ? 1 : 0];
    if (of != 0) {
      EXPECT_NEAR(q, of, 1e-9 * of);
    }
    of = q;
  }
  EXPECT_NEAR(density[1] / density[0], 2 * std::sin(std::numbers::pi / 3), 1e-9);
  // In percent, for a color scale; equal cables have equal numbers.
  EXPECT_EQ(At(*trace, "cable/side_1/tension_n", 0), 100);
  EXPECT_EQ(At(*trace, "cable/side_2/tension_n", 0), 100);
  EXPECT_EQ(At(*trace, "cable/lower_1/tension_n", 0), At(*trace, "cable/upper_2/tension_n", 0));
  EXPECT_EQ(At(*trace, "cable/" + def.cables[0].name + "/tension_n", 0),
            At(*trace, "cable/" + def.cables[0].name + "/tension_n", 30));
}

}  // namespace
}  // namespace taut::test
