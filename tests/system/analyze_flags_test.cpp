// Flags of `taut analyze`: poses, mode shapes as runs, contact forces that equilibrium does not
// determine
#include <cmath>
#include <nlohmann/json.hpp>

#include "system/taut_command.h"

namespace taut {
namespace {

using nlohmann::json;

constexpr double kGravity = 9.81;
const std::string kAnalyzedPrism = TAUT_SOURCE_DIR "/share/models/prism3.yaml";

class AnalyzeFlags : public test::CommandTest {
 protected:
  /// Writes a model of a ball on two ropes with at least 20 N each in the described pose.
  void WriteHanger() const {
    Write("hanger.yaml",
          "taut: 1\nkind: model\nname: hanger\n"
          "nodes:\n  left: [-0.3, 0, 1]\n  right: [0.3, 0, 1]\n  ball: [0, 0, 0.6]\n"
          "pairs:\n"
          "  - {name: l, nodes: [left, ball], tags: [rope]}\n"
          "  - {name: r, nodes: [right, ball], tags: [rope]}\n"
          "builders:\n"
          "  - {match: left, anchor: {}}\n  - {match: right, anchor: {}}\n"
          "  - {match: ball, point_mass: {mass_kg: 2}}\n"
          "  - {match: rope, cable: {stiffness_n_per_m: 1000, rest_length_m: 0.48}}\n");
    Write("two_cases.yaml",
          "taut: 1\nkind: experiment\nname: two\nmodel: hanger.yaml\nduration_s: 1\nload_cases:\n"
          "  - {name: own, weight: true}\n"
          "  - {name: more, forces: [{node: ball, force_n: [0, 0, -30]}]}\n");
  }
  /// Returns a recording: the ball 0.8 m below the ropes' ends, then 0.4 m.
  static std::string Seen() {
    return "time_s,body/hanger/position_x_m,body/hanger/position_y_m,body/hanger/position_z_m,"
           "body/hanger/orientation_w,body/hanger/orientation_x,body/hanger/orientation_y,"
           "body/hanger/orientation_z\n"
           "0,0,0,0.2,1,0,0,0\n1,0,0,0.6,1,0,0,0\n";
  }
  /// Writes an experiment with a box on the ground.
  void WriteSlab() const {
    Write("slab.yaml",
          "taut: 1\nkind: model\nname: slab\nnodes:\n  slab: [0, 0, 0.05]\nbuilders:\n"
          "  - {match: slab, box: {size_m: [0.4, 0.2, 0.1], mass_kg: 3, friction: 0.5}}\n");
    Write("lies.yaml",
          "taut: 1\nkind: experiment\nname: lies\nmodel: slab.yaml\nduration_s: 1\nterrain:\n"
          "  - {name: ground, plane: {height_m: 0, friction: 0.5}}\n");
  }

  json Json(const std::vector<std::string>& arguments) const {
    const test::CommandResult shown = Taut(arguments);
    EXPECT_EQ(shown.status, 0) << shown.errors;
    return json::parse(shown.output, nullptr, false);
  }
  void Refuses(const std::vector<std::string>& arguments, int status, const std::string& why) {
    const test::CommandResult shown = Taut(arguments);
    EXPECT_EQ(shown.status, status) << shown.errors;
    EXPECT_NE(shown.errors.find(why), std::string::npos) << shown.errors;
    EXPECT_EQ(shown.output, "");
  }
};

TEST_F(AnalyzeFlags, APoseIsThatOfARecordingsRow) {
  WriteHanger(), Write("seen.csv", Seen());
  // At 0.8 m below, the ropes are sqrt(0.09 + 0.64) m long, and their tensions carry the weight.
  const double length_m = std::sqrt(0.73);
  const json first =
      Json({"analyze", "hanger.yaml", "--pose", "seen.csv", "--at_s", "0.3", "--json"});
  for (const json& member : first["as_described"]["members"]) {
    EXPECT_NEAR(member["length_m"].get<double>(), length_m, 1e-12);
    EXPECT_NEAR(member["force_n"].get<double>(), 1000 * (length_m - 0.48), 1e-9);
  }
  const json last = Json({"analyze", "hanger.yaml", "--pose", "seen.csv", "--json"});
  EXPECT_NEAR(last["as_described"]["members"][0]["length_m"].get<double>(), 0.5, 1e-12);

  const json held =
      Json({"analyze", "hanger.yaml", "--pose", "seen.csv", "--at_s", "0", "--inverse", "--json"});
  const double tension_n = 2 * kGravity / 2 * length_m / 0.8;
  for (const json& cable : held["load_cases"][0]["cables"]) {
    EXPECT_NEAR(cable["tension_n"].get<double>(), tension_n, 1e-9);
    const double rest_m = length_m - tension_n / 1000;
    EXPECT_NEAR(cable["rest_length_m"].get<double>(), rest_m, 1e-12);
    EXPECT_NEAR(cable["command_m"].get<double>(), rest_m - 0.48, 1e-12);
  }
}

/// Commands are relative to the rest lengths of the file, not to the recorded ones.
TEST_F(AnalyzeFlags, RestLengthsOfARecordingCount) {
  WriteHanger();
  std::string seen = Seen();
  seen.insert(seen.find('\n'), ",cable/l/rest_length_m");
  seen.insert(seen.find("1,0,0,0\n") + 7, ",0.47");
  seen.insert(seen.size() - 1, ",0.45");
  Write("seen.csv", seen);
  const json shown = Json({"analyze", "hanger.yaml", "--pose", "seen.csv", "--json"});
  EXPECT_NEAR(shown["as_described"]["members"][0]["force_n"].get<double>(), 50, 1e-9);
  EXPECT_NEAR(shown["as_described"]["members"][1]["force_n"].get<double>(), 20, 1e-9);
  const json held = Json({"analyze", "hanger.yaml", "--pose", "seen.csv", "--inverse", "--json"});
  for (const json& cable : held["load_cases"][0]["cables"]) {
    EXPECT_NEAR(cable["command_m"].get<double>(), 0.02 - 2 * kGravity / 1.6 / 1000, 1e-12);
  }
}

TEST_F(AnalyzeFlags, APoseOfARunIsWhereTheRunWas) {
  ASSERT_EQ(Taut({"run", TAUT_SOURCE_DIR "/share/experiments/drop_six_strut.yaml", "--out", "run",
                  "--duration_s", "0.6", "--csv", "--quiet"})
                .status,
            0);
  const json shown = Json({"analyze", TAUT_SOURCE_DIR "/share/experiments/drop_six_strut.yaml",
                           "--pose", "run/trace.h5", "--modes", "0", "--json"});
  const std::string csv = Read(Path("run/trace.csv"));
  const auto cells = [](const std::string& line) {
    std::vector<std::string> all;
    for (std::size_t at = 0; at <= line.size();) {
      const std::size_t end = std::min(line.find(',', at), line.size());
      all.push_back(line.substr(at, end - at));
      at = end + 1;
    }
    return all;
  };
  const std::vector<std::string> names = cells(csv.substr(0, csv.find('\n')));
  const std::size_t last = csv.rfind('\n', csv.size() - 2) + 1;
  const std::vector<std::string> values = cells(csv.substr(last, csv.size() - 1 - last));
  ASSERT_EQ(names.size(), values.size());
  int compared = 0;
  for (const json& member : shown["as_described"]["members"]) {
    const std::string name = "cable/" + member["name"].get<std::string>() + "/length_m";
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) continue;
    const double length_m = std::stod(values[static_cast<std::size_t>(found - names.begin())]);
    EXPECT_NEAR(member["length_m"].get<double>(), length_m, 1e-9) << name;
    ++compared;
  }
  EXPECT_EQ(compared, 24);
}

TEST_F(AnalyzeFlags, PosesThatAreNoneAreNamed) {
  WriteHanger();
  Write("seen.csv", Seen());
  Write("half.csv", "time_s,body/hanger/position_x_m\n0,0\n");
  Write("none.csv", "time_s,body/hanger/position_x_m\n");
  Refuses({"analyze", "hanger.yaml", "--pose", "half.csv"}, 3,
          "half.csv: error: the trace has no channel body/hanger/position_y_m");
  Refuses({"analyze", "hanger.yaml", "--pose", "half.csv"}, 3,
          "half.csv: error: the trace has no channel body/hanger/orientation_z");
  Refuses({"analyze", "hanger.yaml", "--pose", "none.csv"}, 3, "none.csv");
  Refuses({"analyze", "hanger.yaml", "--pose", "nowhere.csv"}, 3, "nowhere.csv");
  Refuses({"analyze", "hanger.yaml", "--pose", "."}, 3, "./trace.h5: error: cannot open");
  Refuses({"analyze", "hanger.yaml", "--pose", "hanger.yaml"}, 3,
          "contains no recorded pose (expected a trace");
  Refuses({"analyze", "hanger.yaml", "--pose", "seen.csv", "--at_s", "2"}, 3,
          "has no row at 2 s (expected 0 s to 1 s)");
  Refuses({"analyze", "hanger.yaml", "--at_s", "2"}, 2, "--at_s requires --pose");
  Refuses({"analyze", "hanger.yaml", "--pose", "seen.csv", "--at_s", "soon"}, 2, "\"soon\"");
}

/// Rotations are relative to the described pose: a model without its experiment is placed
/// differently.
TEST_F(AnalyzeFlags, ARecordingOfAnotherPlacementIsAWarning) {
  WriteHanger();
  std::string seen = Seen();
  seen.insert(seen.find('\n'), ",cable/l/length_m");
  seen.insert(seen.find("1,0,0,0\n") + 7, ",0.85");
  seen.insert(seen.size() - 1, ",0.6");
  Write("seen.csv", seen);
  const test::CommandResult shown = Taut({"analyze", "hanger.yaml", "--pose", "seen.csv"});
  EXPECT_EQ(shown.status, 0);
  EXPECT_NE(shown.errors.find("warning: cable l is 0.5 m long in this pose, but 0.6 m in the"),
            std::string::npos)
      << shown.errors;
  Refuses({"analyze", "hanger.yaml", "--pose", "seen.csv", "--strict"}, 3, "error: cable l is");
}

TEST_F(AnalyzeFlags, ShapesAreRuns) {
  const test::CommandResult shown =
      Taut({"analyze", kAnalyzedPrism, "--modes", "2", "--out", "shapes"});
  ASSERT_EQ(shown.status, 0) << shown.errors;
  for (const char* name : {"mode_1", "mode_2", "mechanism_1", "self_stress_1"}) {
    const std::string folder = std::string("shapes/") + name;
    EXPECT_NE(shown.output.find("Shape: " + folder + "/trace.h5\n"), std::string::npos)
        << shown.output;
    EXPECT_EQ(Taut({"check", folder + "/inputs.yaml", "--quiet"}).status, 0) << name;
    // The files are readable as runs; each equals itself.
    EXPECT_EQ(Taut({"compare", folder + "/trace.h5", folder + "/trace.h5"}).status, 0) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(Path("shapes/mode_3")));
  const json stress = json::parse(Read(Path("shapes/self_stress_1/summary.json")));
  EXPECT_EQ(stress["system_max_tension_n"], 100);
  for (const json& cable : stress["cables"]) {
    const bool side = cable["name"].get<std::string>().starts_with("side");
    EXPECT_EQ(cable["tension"]["max_n"] == 100, side) << cable;
    EXPECT_GT(cable["tension"]["max_n"], 0);
  }
  const json silent = Json({"analyze", kAnalyzedPrism, "--modes", "1", "--out", "again", "--json"});
  EXPECT_EQ(silent["format_version"], 1) << "what is written is told on stderr";
}

TEST_F(AnalyzeFlags, ShapesOfSeveralLoadCasesHaveAFolderEach) {
  WriteHanger();
  const test::CommandResult shown =
      Taut({"analyze", "two_cases.yaml", "--modes", "1", "--out", "shapes"});
  ASSERT_EQ(shown.status, 0) << shown.errors;
  for (const char* const name : {"own", "more"}) {
    const std::string inputs = Path(std::string("shapes/") + name + "/mode_1/inputs.yaml");
    EXPECT_TRUE(std::filesystem::exists(inputs)) << shown.output;
  }
  // The modes are about the equilibrium under the load case: with 30 N more the ball hangs lower.
  const auto height = [&](const std::string& name) {
    const json pose = Json({"analyze", "shapes/" + name + "/mode_1/inputs.yaml", "--pose",
                            "shapes/" + name + "/mode_1/trace.h5", "--at_s", "0", "--json"});
    const json lengths = pose["as_described"]["members"];
    return lengths[0]["length_m"].get<double>();
  };
  const json solved = Json({"analyze", "two_cases.yaml", "--json"});
  for (const int number : {0, 1}) {
    const json& one = solved["load_cases"][static_cast<std::size_t>(number)];
    EXPECT_NEAR(height(one["name"]), one["members"][0]["length_m"].get<double>(), 1e-9);
  }
  EXPECT_GT(height("more"), height("own") + 0.005);
}

TEST_F(AnalyzeFlags, ShapesThatCannotBeWrittenAreAnError) {
  Write("taken", "a file");
  const test::CommandResult shown = Taut({"analyze", kAnalyzedPrism, "--out", "taken"});
  EXPECT_EQ(shown.status, 1);
  EXPECT_NE(shown.errors.find("taken"), std::string::npos) << shown.errors;
  Refuses({"analyze", kAnalyzedPrism, "--out", "x", "--inverse"}, 2, "--inverse excludes --out");
}

TEST_F(AnalyzeFlags, ForcesThatSupportsLeaveOpenHaveLimits) {
  WriteSlab();
  const json shown = Json({"analyze", "lies.yaml", "--json"});
  const json& own = shown["load_cases"][0];
  const double weight_n = 3 * kGravity;
  // Four corners: two diagonal pairs can carry half the weight each, so that no corner carries more
  // than that.
  ASSERT_EQ(own["open_forces"]["ground"].size(), 4u);
  for (const json& corner : own["open_forces"]["ground"]) {
    EXPECT_NEAR(corner["normal_force_n"]["low_n"].get<double>(), 0, 1e-6);
    EXPECT_NEAR(corner["normal_force_n"]["high_n"].get<double>(), weight_n / 2, 1e-6);
    EXPECT_EQ(corner["friction"], 0.5);
  }
  const test::CommandResult text = Taut({"analyze", "lies.yaml", "--tables"});
  EXPECT_NE(text.output.find("  ground at slab  0.000  14.715\n"), std::string::npos)
      << text.output;
  // The rotation on the ground is a rigid motion, not a mechanism.
  EXPECT_EQ(own["modes"]["rigid"], 3);
  EXPECT_EQ(own["modes"]["mechanisms"], 0);
}

/// A rod that lies on both its ends: friction forces of the ends may oppose each other, but the
/// normal forces are determined. For rods on one end each, held by cables, all forces are
/// determined.
TEST_F(AnalyzeFlags, OnTwoEndsOnlyFrictionIsOpen) {
  Write("rod.yaml",
        "taut: 1\nkind: model\nname: rod\nnodes:\n  a: [0, 0, 0.01]\n  b: [0.4, 0, 0.01]\n"
        "pairs: [{name: rod, nodes: [a, b]}]\n"
        "builders:\n  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1, friction: 0.5}}\n");
  Write("lies.yaml",
        "taut: 1\nkind: experiment\nname: lies\nmodel: rod.yaml\nduration_s: 1\nterrain:\n"
        "  - {name: ground, plane: {height_m: 0, friction: 0.5}}\n");
  const json open =
      Json({"analyze", "lies.yaml", "--modes", "0", "--json"})["load_cases"][0]["open_forces"];
  ASSERT_EQ(open["ground"].size(), 2u);
  EXPECT_EQ(open["undetermined"], 1);
  for (const json& end : open["ground"]) {
    EXPECT_NEAR(end["normal_force_n"]["low_n"].get<double>(), kGravity / 2, 1e-6);
    EXPECT_NEAR(end["normal_force_n"]["high_n"].get<double>(), kGravity / 2, 1e-6);
  }
  EXPECT_NE(Taut({"analyze", "lies.yaml", "--modes", "0", "--tables"})
                .output.find("only along the ground"),
            std::string::npos);
  const std::string six = TAUT_SOURCE_DIR "/share/experiments/drop_six_strut.yaml";
  EXPECT_TRUE(
      Json({"analyze", six, "--modes", "0", "--json"})["load_cases"][0]["open_forces"].is_null());
}

TEST_F(AnalyzeFlags, ForcesThatNothingLeavesOpenHaveNone) {
  WriteHanger();
  const json shown = Json({"analyze", "hanger.yaml", "--json"});
  EXPECT_TRUE(shown["load_cases"][0]["open_forces"].is_null());
}

TEST_F(AnalyzeFlags, WithoutASelfStressTheHintIsTheForm) {
  const std::string six = TAUT_SOURCE_DIR "/share/models/six_strut.yaml";
  EXPECT_NE(Taut({"analyze", six, "--modes", "0", "--tables"})
                .output.find("(--form --tension_n 10 finds"),
            std::string::npos);
  EXPECT_EQ(Taut({"analyze", six, "--form", "--tension_n", "10"}).status, 0) << "as it says";
  EXPECT_EQ(Taut({"analyze", kAnalyzedPrism, "--modes", "0"}).output.find("--form"),
            std::string::npos);
  WriteHanger();  // it hangs from the world: no form with a self-stress exists
  EXPECT_EQ(Taut({"analyze", "hanger.yaml", "--modes", "0"}).output.find("--form"),
            std::string::npos);
}

}  // namespace
}  // namespace taut
