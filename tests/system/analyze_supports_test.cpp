// `taut analyze` of supported structures: rigid motions, missing supports, warnings about large
// displacements, safety factors and slack
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "system/taut_command.h"

namespace taut {
namespace {

using nlohmann::json;

class AnalyzeSupports : public test::CommandTest {
 protected:
  /// Writes a prism of 2 m on ball joints under its first `supports` feet, with load cases.
  void WriteTower(int supports) const {
    std::string text =
        "taut: 1\nkind: model\nname: tower\nnodes:\n"
        "  b0: [1, 0, 0]\n  b1: [-0.5, 0.8660254, 0]\n  b2: [-0.5, -0.8660254, 0]\n"
        "  t0: [-0.8660254, 0.5, 2]\n  t1: [0, -1, 2]\n  t2: [0.8660254, 0.5, 2]\npairs:\n";
    const char* const pairs[] = {"b0, t0", "b1, t1", "b2, t2", "b0, b1", "b1, b2", "b2, b0",
                                 "t0, t1", "t1, t2", "t2, t0", "t0, b1", "t1, b2", "t2, b0"};
    for (int i = 0; i < 12; ++i) {
      text += std::string("  - {nodes: [") + pairs[i] + "], tags: [" +
              (i < 3 ? "strut" : (i < 9 ? "flat" : "side")) + "]}\n";
    }
    text +=
        "builders:\n"
        "  - {match: strut, rod: {radius_m: 0.02, mass_kg: 2, young_pa: 70e9, area_m2: 1e-4,\n"
        "      second_moment_m4: 1e-9, yield_pa: 200e6}}\n"
        "  - {match: flat, cable: {stiffness_n_per_m: 1e5, prestress_n: 100, strength_n: 2000}}\n"
        "  - {match: side, cable: {stiffness_n_per_m: 1e5, prestress_n: 208, strength_n: 2000}}\n";
    for (int i = 0; i < supports; ++i) {
      text += "  - {match: b" + std::to_string(i) + ", support: {kind: ball}}\n";
    }
    Write("tower.yaml", text);
    Write("loads.yaml",
          "taut: 1\nkind: experiment\nname: loads\nmodel: tower.yaml\nduration_s: 1\nload_cases:\n"
          "  - {name: own, weight: true}\n"
          "  - {name: lift, forces: [{node: t0, force_n: [0, 0, 20]}]}\n"
          "  - {name: settled, settlements: [{support: b0, by_m: [0, 0, -0.001]}]}\n");
  }
  json Shown(const std::string& file) const {
    const test::CommandResult shown = Taut({"analyze", file, "--json"});
    EXPECT_EQ(shown.status, 0) << shown.errors;
    return json::parse(shown.output, nullptr, false);
  }
};

TEST_F(AnalyzeSupports, ATowerOnTooFewSupportsIsRefusedBeforeItIsSolved) {
  WriteTower(1);
  test::CommandResult shown = Taut({"analyze", "loads.yaml"});
  EXPECT_EQ(shown.status, 3);
  EXPECT_EQ(shown.output, "");
  for (const char* const name : {"own", "lift", "settled"}) {
    const std::string line = std::string("loads.yaml: error: load case ") + name +
                             ": the structure can still rotate about x, y and z through (1, 0, 0), "
                             "and the loads topple it (no member resists these motions: add "
                             "anchors or supports that hold at least 3 directions at nodes that "
                             "move)";
    EXPECT_NE(shown.errors.find(line), std::string::npos) << shown.errors;
  }
  WriteTower(2);
  shown = Taut({"analyze", "loads.yaml", "--load_case", "own"});
  EXPECT_EQ(shown.status, 3);
  EXPECT_NE(shown.errors.find("can still rotate about (0.866, -0.5, 0) through (1, 0, 0), and"),
            std::string::npos)
      << shown.errors;
  // A robot without supports and loads is analyzed for self-stress.
  WriteTower(0);
  shown = Taut({"analyze", "tower.yaml"});
  EXPECT_EQ(shown.status, 0) << shown.errors;
}

/// The modes of a structure with a settled support swing about its equilibrium on this support.
TEST_F(AnalyzeSupports, ShapesOfASettledStructureAreWritten) {
  WriteTower(3);
  const test::CommandResult shown = Taut({"analyze", "loads.yaml", "--out", "shapes"});
  EXPECT_EQ(shown.status, 0) << shown.errors;
  for (const char* const name : {"own", "lift", "settled"}) {
    EXPECT_TRUE(std::filesystem::exists(Path(std::string("shapes/") + name + "/mode_1/trace.h5")))
        << name;
  }
  EXPECT_NE(shown.output.find("next: taut view shapes/own/mode_1/trace.h5"), std::string::npos)
      << shown.output;
}

TEST_F(AnalyzeSupports, SafetyAndSlackAreNumbersOfTheirOwn) {
  WriteTower(3);
  const json shown = Shown("loads.yaml");
  EXPECT_EQ(shown["as_described"]["rigid"], 0);
  EXPECT_EQ(shown["as_described"]["pin_jointed"]["rigid"], 0);
  EXPECT_FALSE(shown["as_described"].contains("lowest_stiffness_n_per_m"));
  const json& lift = shown["load_cases"][1];
  double safety = 1e300, slack = 1e300;
  for (const json& member : lift["members"]) {
    for (const char* const factor : {"buckling_factor", "yield_factor", "strength_factor"}) {
      if (!member[factor].is_null()) safety = std::min(safety, member[factor].get<double>());
    }
    const json& own = member["slack_factor"];
    if (!own.is_null()) slack = std::min(slack, own.get<double>());
  }
  EXPECT_EQ(lift["least_safety"]["factor"], safety);
  EXPECT_EQ(lift["least_safety"]["of"], "buckling");
  EXPECT_EQ(lift["first_slack"]["factor"], slack);
  EXPECT_NE(safety, slack);
  EXPECT_GT(lift["least_stiffness_n_per_m"], 0);
  EXPECT_LT(lift["largest_move"]["distance_m"],
            0.25 * lift["largest_move"]["size_m"].get<double>());
  const test::CommandResult text =
      Taut({"analyze", "loads.yaml", "--load_case", "lift", "--tables"});
  EXPECT_EQ(text.errors, "");
  for (const char* const part :
       {"  least safety factor: ", " (buckling of ", "  first slack: ", " times the load\n",
        "  least stiffness: ", "  largest displacement: "}) {
    EXPECT_NE(text.output.find(part), std::string::npos) << part << "\n" << text.output;
  }
}

TEST_F(AnalyzeSupports, ANodeThatMovesFarIsAWarning) {
  Write("soft.yaml",
        "taut: 1\nkind: model\nname: soft\nnodes:\n  top: [0, 0, 1]\n  mass: [0, 0, 0]\n"
        "pairs:\n  - {name: rope, nodes: [top, mass]}\n"
        "builders:\n  - {match: top, anchor: {}}\n  - {match: mass, point_mass: {mass_kg: 1}}\n"
        "  - {match: rope, cable: {stiffness_n_per_m: 30, rest_length_m: 1}}\n");
  const test::CommandResult shown = Taut({"analyze", "soft.yaml"});
  EXPECT_EQ(shown.status, 0);
  EXPECT_NE(shown.errors.find("soft.yaml: warning: load case own_weight: node \"mass\" moves by "
                              "0.327 m, more than a quarter of the structure's size of 1 m"),
            std::string::npos)
      << shown.errors;
  EXPECT_EQ(Taut({"analyze", "soft.yaml", "--strict"}).status, 1);
}

/// Three cables in a row between anchors: their two nodes can move laterally.
TEST_F(AnalyzeSupports, ARowBetweenAnchorsHasMechanisms) {
  Write("row.yaml",
        "taut: 1\nkind: model\nname: row\ngravity_m_per_s2: [0, 0, 0]\nnodes:\n"
        "  a: [-1, 0, 1]\n  m: [0, 0, 1]\n  n: [1, 0, 1]\n  b: [2, 0, 1]\npairs:\n"
        "  - {name: c1, nodes: [a, m], tags: [cable]}\n"
        "  - {name: c2, nodes: [m, n], tags: [cable]}\n"
        "  - {name: c3, nodes: [n, b], tags: [cable]}\nbuilders:\n"
        "  - {match: a, anchor: {}}\n  - {match: b, anchor: {}}\n"
        "  - {match: m, point_mass: {mass_kg: 1}}\n  - {match: n, point_mass: {mass_kg: 1}}\n"
        "  - {match: cable, cable: {stiffness_n_per_m: 1000, prestress_n: 10}}\n");
  const test::CommandResult text = Taut({"analyze", "row.yaml", "--tables"});
  EXPECT_EQ(text.status, 0) << text.errors;
  for (const char* const part : {"  states of self-stress: 1, mechanisms: 4, rigid motions: 0",
                                 "    states of self-stress: 1, mechanisms: 4, rigid motions: 0\n",
                                 "  stable by prestress: ", "  least stiffness: 10 N/m\n"}) {
    EXPECT_NE(text.output.find(part), std::string::npos) << part << "\n" << text.output;
  }
}

}  // namespace
}  // namespace taut
