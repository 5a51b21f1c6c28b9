// Couplings of CPG networks: the paper's counts, NTRT's network, any number of segments
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "taut/gait.h"
#include "taut/play.h"
#include "taut/spec.h"
#include "taut/trace.h"

namespace taut::test {
namespace {

const std::string kRoot = TAUT_SOURCE_DIR "/";

RobotSpec Spine(int segments) {
  Diagnostics out;
  auto robot = LoadRobot(kRoot + "share/models/tetraspine3.yaml",
                         {{"segments", std::to_string(segments)}}, out);
  EXPECT_TRUE(robot) << out.Format();
  return robot.value_or(RobotSpec{});
}

CouplingGraph Couplings(const RobotSpec& robot, CpgSymmetry symmetry,
                        const std::vector<std::string>& order = {}) {
  Diagnostics out;
  auto graph = FindCouplings(robot, symmetry, order, {}, out);
  EXPECT_TRUE(graph) << out.Format();
  return graph.value_or(CouplingGraph{});
}

GaitSpec LearnedGait() {
  Diagnostics out;
  auto gait = LoadGait(kRoot + "share/gaits/cpg_learned.yaml", out);
  EXPECT_TRUE(gait) << out.Format();
  return gait.value_or(GaitSpec{});
}

std::size_t UsedGroups(const CouplingGraph& graph) {
  std::set<int> used;
  for (const auto& link : graph.couplings) used.insert(link.group);
  return used.size();
}

const std::string& CableOf(const RobotSpec& robot, const CouplingGraph& graph, int oscillator) {
  return robot.def
      .cables[static_cast<std::size_t>(graph.cables[static_cast<std::size_t>(oscillator)])]
      .name;
}

TEST(Couplings, OscillatorsAre65535AtMost) {
  RobotSpec robot;
  robot.def.cables.resize(65'536);
  std::vector<std::string> order(65'536, "a");
  for (std::size_t c = 0; c < robot.def.cables.size(); ++c) {
    robot.def.cables[c].name = std::to_string(c);
    robot.def.cables[c].actuator.kind = ActuatorDef::Kind::kIdeal;
  }
  for (const auto& names : {std::vector<std::string>{}, order}) {
    Diagnostics out;
    EXPECT_FALSE(FindCouplings(robot, CpgSymmetry::kNone, names, {}, out));
    EXPECT_EQ(out.Format(), "error: the gait has more than 65535 oscillators\n");
  }
}

// "Symmetry rules can then be used to reduce the number of phase offsets from 132 to 57. Thus, the
// simulation needs to learn 116 parameters" [M15].
TEST(Couplings, ThreeSegmentsHaveThePapersCounts) {
  const RobotSpec robot = Spine(3);
  for (const CpgSymmetry symmetry : {CpgSymmetry::kSegments, CpgSymmetry::kIndex}) {
    const CouplingGraph graph = Couplings(robot, symmetry);
    EXPECT_EQ(graph.cables.size(), 12u);
    EXPECT_EQ(graph.couplings.size(), 132u);  // all to all
    EXPECT_EQ(graph.groups.size(), 57u);
    EXPECT_EQ(UsedGroups(graph), 57u);
    EXPECT_EQ(2 * UsedGroups(graph) + 2, 116u);
  }
  const CouplingGraph free = Couplings(robot, CpgSymmetry::kNone);
  EXPECT_EQ(free.groups.size(), 132u);
  EXPECT_EQ(free.groups[0], "outer_right_1.outer_left_1");
}

// N segments have N - 1 joints of 6 cables. A joint's cables share a body with each other and with
// the cables of the neighboring joints: 30 couplings within a joint, 2 x 36 between neighbors.
TEST(Couplings, LongerSpinesReachNoFurtherThanTheNextJoint) {
  for (const int segments : {2, 4, 12}) {
    const RobotSpec robot = Spine(segments);
    const CouplingGraph graph = Couplings(robot, CpgSymmetry::kSegments);
    const std::size_t joints = static_cast<std::size_t>(segments) - 1;
    EXPECT_EQ(graph.cables.size(), 6 * joints);
    EXPECT_EQ(graph.couplings.size(), 30 * joints + 72 * (joints - 1));
    EXPECT_EQ(graph.groups.size(), 57u);
    EXPECT_EQ(UsedGroups(graph), segments == 2 ? 15u : 57u);
    for (const auto& link : graph.couplings) {
      const auto joint = [&](int oscillator) {
        const std::string& name = CableOf(robot, graph, oscillator);
        return std::stoi(name.substr(name.rfind('_') + 1));
      };
      ASSERT_LE(std::abs(joint(link.to) - joint(link.from)), 1);
      const std::string& group = graph.groups[static_cast<std::size_t>(link.group)];
      const int ahead = joint(link.to) - joint(link.from);
      ASSERT_EQ(group.substr(0, group.find('.')), ahead > 0    ? "front"
                                                  : ahead == 0 ? "same"
                                                               : "behind");
    }
  }
}

// A gait for three segments fits twelve, because its groups are the same.
TEST(Couplings, AGaitOfThreeSegmentsPlaysOnTwelve) {
  Diagnostics out;
  const auto gait = NewCpgGait(Spine(3), CpgSymmetry::kSegments, out);
  ASSERT_TRUE(gait);
  EXPECT_EQ(gait->cpg->groups.size(), 57u);
  const auto resolved = ResolveGait(*gait, Spine(12), out);
  ASSERT_TRUE(resolved) << out.Format();
  EXPECT_EQ(resolved->cables.size(), 66u);
  EXPECT_TRUE(ResolveGait(*gait, Spine(2), out)) << out.Format();
}

TEST(Couplings, CouplingsComeByOscillatorAndAreNeverToItself) {
  const CouplingGraph graph = Couplings(Spine(4), CpgSymmetry::kSegments);
  for (std::size_t i = 0; i < graph.couplings.size(); ++i) {
    const auto& link = graph.couplings[i];
    ASSERT_NE(link.to, link.from);
    if (i == 0) continue;
    const auto& before = graph.couplings[i - 1];
    ASSERT_LT(std::pair(before.to, before.from), std::pair(link.to, link.from));
  }
}

// Both directions within a joint share a group; forward and backward couplings do not.
TEST(Couplings, TheSymmetryIsWhatItSays) {
  const RobotSpec robot = Spine(3);
  const CouplingGraph graph = Couplings(robot, CpgSymmetry::kSegments);
  std::map<std::pair<std::string, std::string>, std::string> group;
  for (const auto& link : graph.couplings) {
    group[{CableOf(robot, graph, link.to), CableOf(robot, graph, link.from)}] =
        graph.groups[static_cast<std::size_t>(link.group)];
  }
  const auto of = [&](const char* to, const char* from) { return group.at({to, from}); };
  EXPECT_EQ(of("outer_top_1", "inner_top_1"), "same.outer_top.inner_top");
  EXPECT_EQ(of("inner_top_1", "outer_top_1"), "same.outer_top.inner_top");
  EXPECT_EQ(of("inner_top_2", "outer_top_2"), "same.outer_top.inner_top");
  EXPECT_EQ(of("outer_top_1", "inner_top_2"), "behind.outer_top.inner_top");
  EXPECT_EQ(of("inner_top_1", "outer_top_2"), "behind.outer_top.inner_top");
  EXPECT_EQ(of("outer_top_2", "inner_top_1"), "front.outer_top.inner_top");
  EXPECT_EQ(of("outer_top_2", "outer_top_1"), "front.outer_top.outer_top");
}

TEST(Couplings, IndexSymmetryRefusesAnOrderItCannotNumber) {
  std::vector<std::string> order;
  for (const char* role :
       {"outer_top", "inner_top", "outer_left", "inner_left", "outer_right", "inner_right"}) {
    for (int joint = 1; joint <= 3; ++joint) order.push_back(role + ("_" + std::to_string(joint)));
  }
  Diagnostics out;
  EXPECT_FALSE(FindCouplings(Spine(4), CpgSymmetry::kIndex, order, {"g.yaml", 5, 3}, out));
  EXPECT_EQ(out.Format(),
            "g.yaml:5:3: error: symmetry: index couples oscillators up to 11 places apart, but "
            "outer_top_1 and outer_right_1 are 12 apart (list the cables of neighboring segments "
            "together in cpg.order)\n");
}

struct Edge {
  double weight_per_m, phase_rad;
};

// The 132 couplings of a running NTRT
TEST(Couplings, TheLearnedGaitHasNtrtsNetwork) {
  std::map<std::pair<std::string, std::string>, Edge> expected;
  std::ifstream file(kRoot + "tests/data/ntrt/cpg_couplings.csv");
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string from, to, weight, phase;
    std::getline(cells, from, ',');
    std::getline(cells, to, ',');
    std::getline(cells, weight, ',');
    std::getline(cells, phase, ',');
    expected[{from, to}] = {std::stod(weight) * 100.0, std::stod(phase)};
  }
  ASSERT_EQ(expected.size(), 132u);

  const RobotSpec robot = Spine(3);
  const GaitSpec gait = LearnedGait();
  ASSERT_TRUE(gait.cpg);
  Diagnostics out;
  const auto resolved = ResolveGait(gait, robot, out);
  ASSERT_TRUE(resolved) << out.Format();
  ASSERT_EQ(resolved->graph.couplings.size(), 132u);
  for (const auto& link : resolved->graph.couplings) {
    const auto found = expected.find(
        {CableOf(robot, resolved->graph, link.to), CableOf(robot, resolved->graph, link.from)});
    ASSERT_NE(found, expected.end());
    const CouplingGroup& group = gait.cpg->groups[static_cast<std::size_t>(link.group)];
    // the table has six and nine digits
    EXPECT_NEAR(group.weight, found->second.weight_per_m, 1e-9);
    EXPECT_NEAR(group.phase_rad, found->second.phase_rad, 5e-9 * std::numbers::pi);
  }
  EXPECT_NEAR(gait.cpg->frequency_hz, 5.948289, 1e-9);
  EXPECT_NEAR(gait.cpg->amplitude, 0.5154273, 1e-9);
}

/// Returns the largest difference of the gait's output from NTRT's trace up to a time [m/s].
double WorstAgainstTrace(const std::string& gait_file, const std::string& trace_file,
                         const std::string& column, double until_s) {
  Diagnostics out;
  const auto gait = LoadGait(kRoot + "share/" + gait_file, out);
  const auto trace = ReadTrace(kRoot + "tests/data/ntrt/" + trace_file, out);
  if (!gait || !trace) {
    ADD_FAILURE() << out.Format();
    return 1.0;
  }
  const RobotSpec robot = Spine(3);
  const auto table = PlayGait(*gait, robot, 1000.0, until_s, out);
  const auto resolved = ResolveGait(*gait, robot, out);
  double worst = 0.0;
  int compared = 0;
  for (std::size_t i = 0; i < table->cables.size(); ++i) {
    const auto channel =
        std::find_if(trace->channels.begin(), trace->channels.end(),
                     [&](const ChannelInfo& c) { return c.name == table->cables[i] + column; });
    if (channel == trace->channels.end()) {
      ADD_FAILURE() << table->cables[i];
      return 1.0;
    }
    const auto& values = trace->values[static_cast<std::size_t>(channel - trace->channels.begin())];
    const double sign = resolved->sign.empty() ? 1.0 : resolved->sign[i];
    for (std::size_t row = 1; row < trace->time_s.size() && trace->time_s[row] <= until_s; ++row) {
      const auto tick = static_cast<std::size_t>(std::llround(trace->time_s[row] * 1000.0));
      worst = std::max(worst, std::fabs(sign * table->rows[tick][i] - values[row]));
      ++compared;
    }
  }
  EXPECT_EQ(compared, 12 * static_cast<int>(std::floor(until_s / 0.04 + 0.5)));
  return worst;
}

// The amplitude is 0.515 m/s (docs/validation/gaits.md); NTRT integrates with a tolerance of 1e-6
// per step.
TEST(Couplings, TheLearnedGaitCommandsWhatNtrtsDid) {
  EXPECT_LT(
      WorstAgainstTrace("gaits/cpg_learned_ntrt.yaml", "cpg_learned_1000hz.csv.gz", "_cpg_m_s", 60),
      3e-6);
}

// The trace has seven digits.
TEST(Couplings, TheHandTunedGaitCommandsWhatNtrtsDid) {
  EXPECT_LT(WorstAgainstTrace("gaits/hand_tuned_sine.yaml", "sine_hand_tuned_1000hz.csv.gz",
                              "_velocity_input_m_s", 60),
            1e-7);
}

std::string ReferenceFolder() {
  const char* given = std::getenv("TAUT_REFERENCE");
  return std::string(given ? given : TAUT_SOURCE_DIR "/../shared/reference") + "/ntrt/gait";
}

// The shipped gaits equal the import of NTRT's files, number by number.
TEST(NtrtGait, TheShippedGaitsAreTheImportedOnes) {
  if (!std::filesystem::is_directory(ReferenceFolder())) {
    GTEST_SKIP() << "no gaits of NTRT: set TAUT_REFERENCE";
  }
  for (const auto& [name, source] :
       {std::pair("cpg_learned_ntrt", ReferenceFolder()),
        {"hand_tuned_sine", ReferenceFolder() + "/handTunedSineWaves_controlVars.json"}}) {
    Diagnostics out;
    auto imported = ImportNtrtGait(source, NtrtCableOrder::kPaper2015, out);
    ASSERT_TRUE(imported) << out.Format();
    auto shipped = LoadGait(kRoot + "share/gaits/" + name + ".yaml", out);
    ASSERT_TRUE(shipped) << out.Format();
    imported->name = shipped->name;
    imported->description = shipped->description;
    EXPECT_EQ(GaitYaml(*imported), GaitYaml(*shipped));
  }
}

class NtrtFolder : public testing::Test {
 protected:
  NtrtFolder() : folder_(std::filesystem::path(testing::TempDir()) / "taut_ntrt_gait") {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~NtrtFolder() override { std::filesystem::remove_all(folder_); }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::string Complaints(const std::string& path) const {
    Diagnostics out;
    EXPECT_FALSE(ImportNtrtGait(path, NtrtCableOrder::kPaper2015, out));
    std::string text = out.Format();
    const std::string head = folder_.string();
    for (std::size_t at; (at = text.find(head)) != text.npos;) text.erase(at, head.size());
    return text;
  }
  std::filesystem::path folder_;
};

TEST_F(NtrtFolder, LearnedParametersAreScaledAndPlaced) {
  Write("best-1_node-0.nnw", "0.1,0.2");
  for (int i = 0; i < 57; ++i) {
    Write("best-1_edge-" + std::to_string(i) + ".nnw", std::to_string(i) + "e-2, 0.75\n");
  }
  Diagnostics out;
  const auto gait = ImportNtrtGait(folder_.string(), NtrtCableOrder::kSince2016, out);
  ASSERT_TRUE(gait) << out.Format();
  EXPECT_NEAR(gait->cpg->frequency_hz, 9.0, 1e-12);  // 3 times 0.1 of 30 Hz
  EXPECT_NEAR(gait->cpg->amplitude, 0.18, 1e-12);    // 3 times 0.2 of 30 cm/s
  EXPECT_EQ(gait->cpg->order[0], "outer_right_1");
  // file 56 is entry (0, 0, 0), file 0 is (2, 5, 5); a weight of 1 is 1/cm
  EXPECT_EQ(gait->cpg->groups.front().name, "rp0.0.0");
  EXPECT_NEAR(gait->cpg->groups.front().weight, 56.0, 1e-12);
  EXPECT_EQ(gait->cpg->groups.back().name, "rp2.5.5");
  EXPECT_EQ(gait->cpg->groups.back().weight, 0.0);
  EXPECT_NEAR(gait->cpg->groups[30].phase_rad, std::numbers::pi / 2, 1e-12);
}

TEST_F(NtrtFolder, WhatIsMissingOrNotANumberIsSaid) {
  EXPECT_EQ(Complaints(folder_.string() + "/none"),
            "/none: error: there is no such file or folder\n");
  EXPECT_EQ(Complaints(folder_.string()),
            ": error: the folder has no file ..._node-0.nnw (expected a folder with "
            "bestParameters-9_node-0.nnw and bestParameters-9_edge-0.nnw to -56.nnw)\n");
  Write("a_node-0.nnw", "0.1,2");
  for (int i = 1; i < 57; ++i) Write("a_edge-" + std::to_string(i) + ".nnw", "0.5,0.5");
  Write("a_edge-7.nnw", "0.5");
  const std::string wrong =
      ": error: the file must contain two numbers within 0..1, such as 0.5036,0.9295\n";
  EXPECT_EQ(Complaints(folder_.string()),
            "/a_edge-0.nnw: error: cannot open: No such file or directory\n/a_edge-7.nnw:1:1" +
                wrong + "/a_node-0.nnw:1:1" + wrong);
  Write("b_node-0.nnw", "0.1,0.1");
  EXPECT_EQ(Complaints(folder_.string()),
            ": error: the folder has several sets of learned parameters (expected a folder with "
            "bestParameters-9_node-0.nnw and bestParameters-9_edge-0.nnw to -56.nnw)\n");
  Write("v.json", "{\"cpg_frequency\": 0.5, \"front_offset\": \"x\"}");
  const std::string text = Complaints((folder_ / "v.json").string());
  EXPECT_NE(text.find("controlVars needs the key \"in_top_amp_a\""), text.npos) << text;
  EXPECT_NE(text.find("front_offset"), text.npos) << text;
}

}  // namespace
}  // namespace taut::test
