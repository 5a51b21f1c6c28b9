// Reproducibility of runs: hash of the inputs, and the resolved experiment
#include <cmath>
#include <iterator>

#include "base/hash.h"
#include "description/yaml/yaml_hash.h"
#include "taut/run.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

class ExperimentRecord : public ExperimentFolder {
 protected:
  /// Returns the text without its initial comment, which lists the source files.
  static std::string Body(const std::string& yaml) { return yaml.substr(yaml.find("taut: 1")); }

  ExperimentSpec ThereAndBack(const ExperimentSpec& experiment) {
    Write("resolved.yaml", ResolvedYaml(experiment));
    return Load("resolved.yaml");
  }
};

TEST_F(ExperimentRecord, TheHashIsOfBytesAndNotOfNames) {
  const std::uint64_t hash = Load().input_hash;
  EXPECT_EQ(Load().input_hash, hash);
  std::filesystem::create_directory(Path("elsewhere"));
  Write("elsewhere/model.yaml", kModel);
  Write("elsewhere/renamed.yaml", kExperiment);
  EXPECT_EQ(Load("elsewhere/renamed.yaml").input_hash, hash);

  Write("elsewhere/model.yaml", std::string(kModel) + "# a comment\n");
  EXPECT_NE(Load("elsewhere/renamed.yaml").input_hash, hash);
  EXPECT_NE(Load("trial.yaml", {{"push_n", "10"}}).input_hash, hash);
  EXPECT_NE(Load("trial.yaml", {{"push_n", "10"}}).input_hash,
            Load("trial.yaml", {{"push_n", "11"}}).input_hash);
}

TEST_F(ExperimentRecord, TheHashIsFnv1a) {
  // "3:abc", computed independently: FNV-1a of the length, a colon and the bytes
  Write("abc", "abc");
  std::uint64_t expected = 0xcbf29ce484222325;
  for (const unsigned char byte : {'3', ':', 'a', 'b', 'c'}) {
    expected = (expected ^ byte) * 0x100000001b3;
  }
  Diagnostics out;
  EXPECT_EQ(description::HashInputs({Path("abc")}, {}, out), expected);
  EXPECT_EQ(description::HashInputs({}, {}, out), 0xcbf29ce484222325);
  EXPECT_EQ(base::HashText(0x00f), "000000000000000f");
}

TEST_F(ExperimentRecord, ItsNamesFollowTheRulesOfNames) {
  const std::string text = ResolvedYaml(Load());
  const auto with = [&](const std::string& old_name, const std::string& new_name) {
    std::string changed = text;
    const std::string old_text = "name: \"" + old_name + "\"";
    const std::size_t at = changed.find(old_text);
    EXPECT_NE(at, std::string::npos) << old_text;
    Write("changed.yaml", changed.replace(at, old_text.size(), "name: \"" + new_name + "\""));
    return Complaints("changed.yaml");
  };
  EXPECT_EQ(with("trial", "trial"), "");
  EXPECT_NE(with("trial", "..").find("\"..\" cannot be a name"), std::string::npos);
  EXPECT_NE(with("left", "a,b").find("\"a,b\" cannot be a name"), std::string::npos);
  EXPECT_NE(with("ground", "<b>").find("\"<b>\" cannot be a name"), std::string::npos);
}

TEST_F(ExperimentRecord, EveryShippedExperimentComesBackToTheSameBits) {
  int count = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(std::string(TAUT_SOURCE_DIR) + "/share/experiments")) {
    Diagnostics out;
    const auto experiment = LoadExperiment(file.path().string(), {}, out);
    ASSERT_TRUE(experiment) << out.Format();
    const ExperimentSpec back = ThereAndBack(*experiment);
    EXPECT_EQ(Body(ResolvedYaml(back)), Body(ResolvedYaml(*experiment)));
    EXPECT_TRUE(back.parameters.empty());
    EXPECT_EQ(back.files, std::vector<std::string>{Path("resolved.yaml")});
    ++count;
  }
  EXPECT_GE(count, 7);
}

TEST_F(ExperimentRecord, OneOfAnEarlierVersionHasNoReferences) {
  const ExperimentSpec before = Load();
  EXPECT_EQ(ResolvedYaml(before).find("references"), std::string::npos);
  EXPECT_TRUE(ThereAndBack(before).references.empty());
}

TEST_F(ExperimentRecord, NumbersTextsAndMissingLimitsSurvive) {
  Write("trace.csv", "time_s\n");
  Change("duration_s: 10",
         "step_s: 0.1 / 3\nduration_s: 10\ncompare_with: trace.csv\n"
         "description: \"says \\\"no\\\", \\\\, \\t\\n and \u00e9\"\n"
         "place: {at_m: [0.1, 1e-300, -0.0], velocity_m_per_s: [pi, 0, 0]}");
  const ExperimentSpec before = Load(), after = ThereAndBack(before);
  EXPECT_EQ(after.step_s, 0.1 / 3);
  EXPECT_EQ(after.description, before.description);
  EXPECT_EQ(after.compare_with, Path("trace.csv"));
  EXPECT_EQ(after.robot.def.bodies[0].velocity_m_per_s.x,
            before.robot.def.bodies[0].velocity_m_per_s.x);
  EXPECT_EQ(after.robot.cable_tags, before.robot.cable_tags);
  EXPECT_EQ(after.robot.node_tags, before.robot.node_tags);
  EXPECT_EQ(after.robot.cable_sources.size(), before.robot.def.cables.size());
  const ActuatorDef& actuator = after.robot.def.cables[0].actuator;
  EXPECT_EQ(actuator.kind, ActuatorDef::Kind::kLimited);
  EXPECT_EQ(actuator.max_speed_m_per_s, 0.1);
  EXPECT_TRUE(std::isinf(actuator.max_force_n));
  EXPECT_TRUE(std::isinf(actuator.max_acceleration_m_per_s2));
}

TEST_F(ExperimentRecord, ItRepeatsTheRunBitForBit) {
  Change("duration_s: 10", "duration_s: 4.5");
  const ExperimentSpec before = Load(), after = ThereAndBack(before);
  Diagnostics out;
  const auto first = RunExperiment(before, {}, out), again = RunExperiment(after, {}, out);
  ASSERT_TRUE(first && again) << out.Format();
  EXPECT_EQ(first->state_hash, again->state_hash);
  const auto other = RunExperiment(Load("trial.yaml", {{"push_n", "10.000001"}}), {}, out);
  ASSERT_TRUE(other) << out.Format();
  EXPECT_NE(first->state_hash, other->state_hash);  // so that the hash covers the push
}

TEST_F(ExperimentRecord, ItIsAnExperimentAndHasNoParameters) {
  ThereAndBack(Load());
  Diagnostics out;
  EXPECT_EQ(FileKind(Path("resolved.yaml"), out), "experiment");
  EXPECT_TRUE(out.ok()) << out.Format();
  EXPECT_EQ(
      Complaints("resolved.yaml", {{"push_n", "3"}}),
      "--set push_n=3: error: there is no parameter \"push_n\" (the file has no parameters)\n");
}

TEST_F(ExperimentRecord, WhatWasTamperedWithIsRefused) {
  const std::string good = ResolvedYaml(Load());
  const auto complaint = [&](const std::string& old_text, const std::string& new_text) {
    ChangeFile("resolved.yaml", good, old_text, new_text);
    const std::string text = Complaints("resolved.yaml");
    return text.substr(text.find("error: "));
  };
  EXPECT_EQ(complaint("seed: 0\n", ""), "error: the file needs the key \"seed\"\n");
  EXPECT_EQ(complaint("seed: 0", "seed: x"), "error: seed must be a whole number\n");
  EXPECT_EQ(complaint("seed: 0", "sede: 0"),
            "error: unknown key \"sede\" (did you mean \"seed\"?)\n");
  EXPECT_EQ(
      complaint("start: as_described", "start: somehow"),
      "error: start cannot be \"somehow\" (one of: as_described, settled, settled_floating)\n");
  EXPECT_EQ(complaint("node: 1", "node: 99"), "error: there is no node 99\n");
  EXPECT_EQ(complaint("{cable: 0", "{cable: 99"), "error: there is no cable 99\n");
  EXPECT_EQ(complaint("fixed: false", "fixed: 0"),
            "error: robot.bodies.fixed must be true or false, got \"0\"\n");
  EXPECT_EQ(complaint("inertia_kg_m2: [", "inertia_kg_m2: [1, "),
            "error: robot.bodies.inertia_kg_m2 must have 6 numbers, got 7\n");
  EXPECT_EQ(complaint("    - [\"a0\"", "    - []\n    - [\"a0\""),
            "error: every node and every cable needs its tags\n");
}

}  // namespace
}  // namespace taut::test
