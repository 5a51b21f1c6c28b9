// The commands `taut analyze` and `taut size`
#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "system/taut_command.h"

namespace taut {
namespace {

using nlohmann::json;

class AnalyzeCommand : public test::CommandTest {
 protected:
  /// Writes a model of a ball on two ropes from the ceiling.
  std::string WriteHanger() const {
    return Write("hanger.yaml",
                 "taut: 1\nkind: model\nname: hanger\n"
                 "nodes:\n"
                 "  left: [-0.3, 0, 1]\n"
                 "  right: [0.3, 0, 1]\n"
                 "  ball: [0, 0, 0.6]\n"
                 "pairs:\n"
                 "  - {nodes: [left, ball], tags: [rope]}\n"
                 "  - {nodes: [right, ball], tags: [rope]}\n"
                 "builders:\n"
                 "  - {match: left, anchor: {}}\n"
                 "  - {match: right, anchor: {}}\n"
                 "  - {match: ball, point_mass: {mass_kg: 2}}\n"
                 "  - {match: rope, cable: {stiffness_n_per_m: 1e6, rest_length_ratio: 1}}\n");
  }
};

TEST_F(AnalyzeCommand, FindsTheTensionsOfAWeightOnTwoRopes) {
  WriteHanger();
  const test::CommandResult shown = Taut({"analyze", "hanger.yaml", "--json"});
  ASSERT_EQ(shown.status, 0) << shown.errors;
  const json result = json::parse(shown.output);
  EXPECT_EQ(result["format_version"], 1);
  const json& own = result["load_cases"].at(0);
  EXPECT_EQ(own["name"], "own_weight");
  EXPECT_TRUE(own["found"]);
  double held_z = 0;
  for (const json& member : own["members"]) {
    // Height 0.4 m of 0.5 m length: 2 T 0.8 = m g. The ropes' stiffness of 1 MN/m causes a relative
    // error of 1e-5.
    EXPECT_NEAR(member["tension_n"].get<double>(), 2 * 9.81 / 1.6, 1e-3);
    EXPECT_FALSE(member["slack"]);
  }
  for (const json& reaction : own["reactions"]) held_z += reaction["force_n"].at(2).get<double>();
  ASSERT_EQ(own["reactions"].size(), 2u);
  EXPECT_EQ(own["reactions"][0]["name"], "left");
  EXPECT_NEAR(held_z, 2 * 9.81, 1e-6);
}

TEST_F(AnalyzeCommand, TheLeastTensionsOfAPrismKeepItsRatio) {
  const std::string prism = TAUT_SOURCE_DIR "/share/models/prism3.yaml";
  const test::CommandResult shown =
      Taut({"analyze", prism, "--inverse", "--at_least_n", "10", "--json"});
  ASSERT_EQ(shown.status, 0) << shown.errors;
  const json result = json::parse(shown.output);
  const json& own = result["load_cases"].at(0);
  ASSERT_TRUE(own["found"]);
  // The single state of self-stress: force densities of side cables are 2 sin(pi / 3) times those
  // of base cables. The base cables are shorter, so that their tension is at the bound.
  const double base = 10 / (0.2 * std::sin(std::acos(-1.0) / 3));
  for (const json& cable : own["cables"]) {
    const bool side = cable["name"].get<std::string>().starts_with("side");
    EXPECT_NEAR(cable["force_density_n_per_m"].get<double>(), side ? std::sqrt(3.0) * base : base,
                1e-9 * base);
    EXPECT_EQ(cable["at_bound"].get<bool>(), !side);
  }
}

TEST_F(AnalyzeCommand, BoundsWithinWhichNothingHoldsThePoseAreSaid) {
  const test::CommandResult shown = Taut({"analyze", TAUT_SOURCE_DIR "/share/models/prism3.yaml",
                                          "--inverse", "--at_least_n", "10", "--at_most_n", "12"});
  EXPECT_EQ(shown.status, 1);
  EXPECT_NE(
      shown.errors.find("no forces within their bounds balance the loads; out of balance: strut_"),
      std::string::npos)
      << shown.errors;
}

TEST_F(AnalyzeCommand, TheFormOfSixStrutsIsAModelWithASelfStressAndAMechanism) {
  const test::CommandResult formed =
      Taut({"analyze", TAUT_SOURCE_DIR "/share/models/six_strut.yaml", "--form", "--tension_n",
            "20", "--out", "form.yaml"});
  ASSERT_EQ(formed.status, 0) << formed.errors;
  const test::CommandResult shown = Taut({"analyze", "form.yaml", "--modes", "0", "--tables"});
  ASSERT_EQ(shown.status, 0) << shown.errors;
  // 30 members at 12 nodes: rank 29, so one state of self-stress and one mechanism
  // (docs/theory/statics.md)
  EXPECT_NE(shown.output.find("as pin-jointed: nodes: 12, members: 30, rank: 29 "),
            std::string::npos)
      << shown.output;
}

TEST_F(AnalyzeCommand, ARobotThatNothingHoldsIsAnalysedWithoutWeight) {
  const test::CommandResult shown =
      Taut({"analyze", TAUT_SOURCE_DIR "/share/models/prism3.yaml", "--modes", "6", "--tables"});
  EXPECT_EQ(shown.status, 0) << shown.errors;
  EXPECT_NE(shown.output.find("the robot has no support in the world: weight is left out"),
            std::string::npos)
      << shown.output;
  EXPECT_NE(shown.output.find("slack: none"), std::string::npos);
  EXPECT_NE(shown.output.find("rigid motions: 6, mechanisms: 0, unstable: 0"), std::string::npos)
      << shown.output;
}

TEST_F(AnalyzeCommand, ALoadCaseThatIsNotThereIsAnError) {
  WriteHanger();
  const test::CommandResult shown = Taut({"analyze", "hanger.yaml", "--load_case", "wind"});
  EXPECT_EQ(shown.status, 3);
  EXPECT_NE(shown.errors.find("hanger.yaml: error: there is no load case \"wind\""),
            std::string::npos)
      << shown.errors;
  EXPECT_EQ(shown.output, "");
}

TEST_F(AnalyzeCommand, AllMistakesOfAFileAreNamed) {
  Write("bad.yaml",
        "taut: 1\nkind: model\nname: bad\nnodes:\n  a: [0, 0]\nbuilders:\n"
        "  - {match: a, point_mass: {mass_kg: -1}}\n");
  const test::CommandResult shown = Taut({"analyze", "bad.yaml"});
  EXPECT_EQ(shown.status, 3);
  EXPECT_NE(shown.errors.find("bad.yaml:5:"), std::string::npos) << shown.errors;
  EXPECT_NE(shown.errors.find("bad.yaml:7:"), std::string::npos) << shown.errors;
  EXPECT_EQ(Taut({"analyze", "nowhere.yaml"}).status, 3);
  EXPECT_EQ(Taut({"analyze"}).status, 2);
  EXPECT_EQ(Taut({"analyze", "bad.yaml", "--modes", "-1"}).status, 2);
}

TEST_F(AnalyzeCommand, AGaitIsRefused) {
  const test::CommandResult shown =
      Taut({"analyze", TAUT_SOURCE_DIR "/share/gaits/hand_tuned_sine.yaml"});
  EXPECT_EQ(shown.status, 3);
  EXPECT_NE(shown.errors.find("is a gait"), std::string::npos) << shown.errors;
}

TEST_F(AnalyzeCommand, ShapesStayWholeUntilNewOnesHaveTheirFirstRow) {
  const std::vector<std::string> words = {
      "analyze", TAUT_SOURCE_DIR "/share/models/prism3.yaml", "--modes", "1", "--out", "shapes"};
  ASSERT_EQ(Taut(words).status, 0);
  const std::string shape = Path("shapes/mode_1/");
  const std::string summary = Read(shape + "summary.json"), inputs = Read(shape + "inputs.yaml");
  // A limit of the file size acts like a disk with room for inputs.yaml, but not for the trace.
  const rlim_t bytes = 2 * inputs.size();
  ASSERT_LT(bytes, std::filesystem::file_size(shape + "trace.h5"));
  const test::CommandResult full = Taut(words, [bytes] {
    const rlimit size{bytes, bytes};
    if (setrlimit(RLIMIT_FSIZE, &size) != 0) _exit(96);
  });
  EXPECT_EQ(full.status, 1) << full.output;
  EXPECT_EQ(Read(shape + "summary.json"), summary);
  EXPECT_EQ(Read(shape + "inputs.yaml"), inputs);
  EXPECT_EQ(Taut({"report", "shapes/mode_1"}).status, 0);
}

TEST_F(AnalyzeCommand, SizeSaysWhatARunAsksFor) {
  ASSERT_EQ(Taut({"run", TAUT_SOURCE_DIR "/share/experiments/rest_length_sine.yaml", "--out", "run",
                  "--duration_s", "2"})
                .status,
            0);
  const test::CommandResult shown =
      Taut({"size", "run", "--catalogue", TAUT_SOURCE_DIR "/examples/winches.yaml", "--json"});
  EXPECT_TRUE(shown.status == 0 || shown.status == 1) << shown.errors;
  const json result = json::parse(shown.output);
  EXPECT_EQ(result["format_version"], 1);
  EXPECT_TRUE(result["peaks_of_every_step"]);
  const json summary = json::parse(Read(Path("run/summary.json")));
  ASSERT_EQ(result["cables"].size(), summary["cables"].size());
  bool all = true;
  for (std::size_t i = 0; i < result["cables"].size(); ++i) {
    const json& cable = result["cables"][i];
    EXPECT_EQ(cable["peak_force_n"], summary["cables"][i]["tension"]["max_n"]);
    EXPECT_EQ(cable["net_energy_j"], summary["cables"][i]["actuator"]["net_energy_j"]);
    EXPECT_LE(cable["rms_force_n"], cable["peak_force_n"]);
    EXPECT_EQ(cable["motors"].size(), 2u);
    bool any = false;
    for (const json& motor : cable["motors"]) any = any || motor["fits"].get<bool>();
    bool spring = false;
    for (const json& one : cable["springs"]) spring = spring || one["fits"].get<bool>();
    all = all && any && spring;
  }
  EXPECT_EQ(shown.status, all ? 0 : 1);
  EXPECT_EQ(Taut({"size", "run"}).status, 0) << "without a catalogue nothing can fail to fit";
}

TEST_F(AnalyzeCommand, SizeNamesWhatIsWrong) {
  Write("bad.yaml",
        "taut: 1\nkind: catalogue\nname: c\nmotors:\n  m: {rated_torque_n_m: 1, "
        "peak_torque_n_m: 2, max_speed_rad_per_s: 3}\n");
  const test::CommandResult shown = Taut({"size", "nowhere", "--catalogue", "bad.yaml"});
  EXPECT_EQ(shown.status, 3);
  EXPECT_NE(shown.errors.find("motor m has no spool_radius_m"), std::string::npos) << shown.errors;
  EXPECT_NE(shown.errors.find("nowhere/inputs.yaml"), std::string::npos) << shown.errors;
}

}  // namespace
}  // namespace taut
