// Load cases of experiments: reading, writing, errors
#include <gmock/gmock.h>

#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

constexpr const char* kFrame = R"(taut: 1
kind: model
name: frame
nodes: {a: [0, 0, 0], b: [2, 0, 0], c: [1, 0, 1], hook: [1, 0, 3]}
pairs:
  - {name: deck, nodes: [a, b], tags: [bar]}
  - {tags: [bar, leg], each: [[b, c], [c, a]]}
  - {name: rope, nodes: [c, hook], tags: [stay]}
  - {name: line, nodes: [c, hook], tags: [stay]}
builders:
  - {match: deck, bar: {young_pa: 1e6, area_m2: 1e-3, mass_kg: 1}}
  - {match: leg, bar: {young_pa: 1e6, area_m2: 1e-3, mass_kg: 1, expansion_per_k: 1e-5}}
  - {match: stay, cable: {stiffness_n_per_m: 100, rest_length_m: 1.5, expansion_per_k: 2e-5}}
  - {match: hook, anchor: {}}
  - {match: [[a], [b]], support: {kind: ball}}
)";
constexpr const char* kCases = R"(taut: 1
kind: experiment
name: loads
model: model.yaml
duration_s: 1
load_cases:
  - name: snow
    forces:
      - {node: c, force_n: [0, 0, -100]}
  - name: winter
    weight: false
    settlements:
      - {support: b, by_m: [0, 0, -0.01]}
    rest_lengths:
      - {members: deck, by_m: -0.002}
      - {members: stay, by_ratio: 0.01}
    temperatures:
      - {members: [[leg], [rope]], by_k: -20}
)";

class LoadCases : public ExperimentFolder {
 protected:
  LoadCases() {
    Write("model.yaml", kFrame);
    Write("trial.yaml", kCases);
  }
  std::string After(const std::string& old_text, const std::string& new_text) {
    ChangeFile("trial.yaml", kCases, old_text, new_text);
    return Without("trial.yaml:", Complaints());
  }
};

TEST_F(LoadCases, BecomeForcesSettlementsAndLengths) {
  const ExperimentSpec read = Load();
  Write("resolved.yaml", ResolvedYaml(read));
  for (const ExperimentSpec& e : {read, Load("resolved.yaml")}) {
    ASSERT_EQ(e.load_cases.size(), 2u);
    const LoadCaseSpec& snow = e.load_cases[0];
    EXPECT_EQ(snow.name, "snow");
    EXPECT_TRUE(snow.weight);
    ASSERT_EQ(snow.forces.size(), 1u);
    EXPECT_EQ(snow.forces[0].node, 2);
    EXPECT_EQ(snow.forces[0].force_n.z, -100);
    const LoadCaseSpec& winter = e.load_cases[1];
    EXPECT_FALSE(winter.weight);
    ASSERT_EQ(winter.settlements.size(), 1u);
    EXPECT_EQ(e.robot.def.joints[static_cast<std::size_t>(winter.settlements[0].joint)].name, "b");
    EXPECT_EQ(winter.settlements[0].by_m.z, -0.01);
    ASSERT_EQ(winter.cables.size(), 2u);
    EXPECT_NEAR(winter.cables[0].by_m, 0.015 - 2e-5 * 20 * 1.5, 1e-15);
    EXPECT_NEAR(winter.cables[1].by_m, 0.015, 1e-15);
    ASSERT_EQ(winter.bars.size(), 3u);
    const auto bar = [&](std::size_t i) {
      return e.robot.def.joints[static_cast<std::size_t>(winter.bars[i].index)];
    };
    EXPECT_EQ(bar(0).name, "deck");
    EXPECT_EQ(winter.bars[0].by_m, -0.002);
    EXPECT_EQ(bar(1).name, "b-c");
    EXPECT_NEAR(winter.bars[1].by_m, -1e-5 * 20 * bar(1).rest, 1e-15);
    EXPECT_EQ(e.robot.joint_tags[static_cast<std::size_t>(winter.bars[2].index)].size(), 3u);
  }
}

TEST_F(LoadCases, LineLoadsActAtTheEndsOfMembers) {
  After("    forces:\n      - {node: c, force_n: [0, 0, -100]}",
        "    weight_factor: 1.35\n    max_displacement_m: 20 mm\n    line_loads:\n"
        "      - {members: [bar], force_n_per_m: [0, 0, -50]}\n"
        "      - {members: stay, force_n_per_m: [3, 0, 0]}");
  const ExperimentSpec read = Load();
  Write("resolved.yaml", ResolvedYaml(read));
  for (const ExperimentSpec& e : {read, Load("resolved.yaml")}) {
    const LoadCaseSpec& snow = e.load_cases.at(0);
    EXPECT_EQ(snow.GravityFactor(), 1.35);
    EXPECT_EQ(snow.max_displacement_m, 0.02);
    // a and b: half of the deck of 2 m and of a leg of sqrt(2) m; c: half of two legs, and half of
    // two ropes of 2 m, whose other halves act on the hook, in the world
    const double leg = 25 * std::sqrt(2.0);
    ASSERT_EQ(snow.forces.size(), 4u);
    for (const LoadCaseSpec::NodeForce& force : snow.forces) {
      const std::string& name = e.robot.def.nodes[static_cast<std::size_t>(force.node)].name;
      const double z_n = name == "hook" ? 0 : name == "c" ? -2 * leg : -50 - leg;
      EXPECT_NEAR(force.force_n.z, z_n, 1e-12) << name;
      EXPECT_NEAR(force.force_n.x, name == "c" || name == "hook" ? 6 : 0, 1e-12) << name;
    }
  }
}

TEST_F(LoadCases, ForcesOnSelectedNodesActOnEach) {
  After("{node: c, force_n: [0, 0, -100]}", "{nodes: [[a], [b]], force_n: [0, 0, -100]}");
  const LoadCaseSpec snow = Load().load_cases.at(0);
  ASSERT_EQ(snow.forces.size(), 2u);
  EXPECT_EQ(snow.forces[0].node, 0);
  EXPECT_EQ(snow.forces[1].node, 1);
  EXPECT_EQ(snow.forces[1].force_n.z, -100);
}

TEST_F(LoadCases, CombinationsAreSumsWithFactors) {
  ChangeFile("trial.yaml", kCases, "load_cases:\n",
             "load_combinations:\n"
             "  - {name: uls, factors: {snow: 1.5, winter: 0.6}, max_displacement_m: 0.1}\n"
             "  - {name: none, factors: {winter: 2}}\n"
             "load_cases:\n");
  const ExperimentSpec read = Load();
  Write("resolved.yaml", ResolvedYaml(read));
  for (const ExperimentSpec& e : {read, Load("resolved.yaml")}) {
    ASSERT_EQ(e.load_cases.size(), 4u);
    const LoadCaseSpec &winter = e.load_cases[1], &uls = e.load_cases[2];
    EXPECT_EQ(uls.name, "uls");
    EXPECT_EQ(uls.GravityFactor(), 1.5);
    EXPECT_EQ(uls.max_displacement_m, 0.1);
    ASSERT_EQ(uls.forces.size(), 1u);
    EXPECT_EQ(uls.forces[0].force_n.z, -150);
    EXPECT_EQ(uls.settlements.at(0).by_m.z, 0.6 * -0.01);
    ASSERT_EQ(uls.cables.size(), winter.cables.size());
    EXPECT_EQ(uls.cables[0].by_m, 0.6 * winter.cables[0].by_m);
    EXPECT_EQ(uls.bars.at(0).by_m, 0.6 * -0.002);
    EXPECT_EQ(e.load_cases[3].GravityFactor(), 0);
    EXPECT_FALSE(e.load_cases[3].weight);
  }
}

TEST_F(LoadCases, MistakesInSumsAndLineLoadsAreNamed) {
  EXPECT_EQ(
      After("load_cases:\n",
            "load_combinations: [{name: much, factors: {winter: 1500}}]\nload_cases:\n"),
      "6:28: error: the load case \"much\" makes the rest length of \"deck\" zero or negative "
      "(it is 2 m without the load case)\n");
  EXPECT_EQ(
      After("weight: false", "weight: false\n    weight_factor: 2"),
      "12:5: error: load_case.weight_factor has no effect with `weight: false` (remove one of "
      "the two keys)\n");
  EXPECT_EQ(After("load_cases:\n",
                  "load_combinations: [{name: snow, factors: {snow: 1, wintr: 1.5}}]\n"
                  "load_cases:\n"),
            "6:28: error: two load cases are called snow (the first is in line 8)\n"
            "6:53: error: there is no load case \"wintr\" (did you mean \"winter\"?)\n");
  EXPECT_EQ(After("{node: c, force_n", "{node: c, nodes: [c], force_n"),
            "9:19: error: force has both node and nodes (give only one of them)\n");
  EXPECT_EQ(After("{node: c, force_n", "{nodes: dd, force_n"),
            "9:17: error: forces.nodes: no node matches dd (no node is called or tagged \"dd\"; "
            "one of: a, b, c, hook)\n");
  EXPECT_EQ(After("    forces:\n",
                  "    line_loads: [{members: dek, force_n_per_m: [0, 0, 1]}]\n"
                  "    forces:\n"),
            "8:28: error: line_loads.members: no cable, bar or rod matches dek (no cable, bar or "
            "rod is called or tagged \"dek\"; did you mean \"deck\"?)\n");
}

TEST_F(LoadCases, MistakesAreNamed) {
  EXPECT_EQ(After("node: c", "node: d"),
            "9:16: error: there is no node \"d\" (did you mean \"a\"?)\n");
  EXPECT_EQ(After("support: b", "support: c"),
            "13:19: error: there is no support \"c\" (did you mean \"a\"?)\n");
  EXPECT_EQ(After("members: stay", "members: stray"),
            "16:19: error: rest_lengths.members: no cable or bar matches stray (no cable or bar is "
            "called or tagged \"stray\"; did you mean \"stay\"?)\n");
  EXPECT_EQ(After("by_ratio: 0.01", "by_ratio: -1"),
            "16:19: error: the load case \"winter\" makes the rest length of \"line\" zero or "
            "negative (it is 1.5 m without the load case)\n"
            "18:19: error: the load case \"winter\" makes the rest length of \"rope\" zero or "
            "negative (it is 1.5 m without the load case)\n");
  EXPECT_EQ(After("by_ratio: 0.01", "by_ratio: 0.01, by_m: 1"),
            "16:25: error: rest_lengths has both by_m and by_ratio (give only one of them)\n");
  EXPECT_EQ(After("[[leg], [rope]]", "bar"),
            "18:19: error: temperatures.members: the thermal expansion is not known for deck (add "
            "`expansion_per_k` to the builder in the model: steel has 12e-6)\n");
  EXPECT_EQ(After("name: winter", "name: snow"),
            "10:11: error: two load cases are called snow (the first is in line 7)\n");
  EXPECT_EQ(After("by_k: -20", "by_c: -20"),
            "18:36: error: unknown key \"by_c\" in temperatures (did you mean \"by_k\"?)\n");
  EXPECT_EQ(After("    weight: false", "    weigth: false"),
            "11:5: error: unknown key \"weigth\" in load_case (did you mean \"weight\"?)\n");
  EXPECT_EQ(After("force_n: [0, 0, -100]", "force_n: 100"),
            "9:28: error: force.force_n must be a list of 3 numbers, got a text\n");
}

TEST_F(LoadCases, OfResolvedExperimentsReferToWhatIsThere) {
  const std::string text = ResolvedYaml(Load());
  const auto with = [&](const std::string& old_text, const std::string& new_text) {
    ChangeFile("resolved.yaml", text, old_text, new_text);
    return Without("resolved.yaml:", Complaints("resolved.yaml"));
  };
  EXPECT_THAT(with("node: 2, force_n", "node: 4, force_n"),
              testing::HasSubstr("there is no node 4"));
  EXPECT_THAT(with("joint: 4, by_m", "joint: -2, by_m"), testing::HasSubstr("must be"));
  EXPECT_THAT(with("{index: 1, by_m", "{index: 9, by_m"),
              testing::HasSubstr("there is no cable 9"));
  const std::string other = with("rest_m: ", "rest_rad: ");
  EXPECT_THAT(other, testing::HasSubstr("rest_rad has the wrong unit"));
  EXPECT_THAT(other, testing::Not(testing::HasSubstr("unknown key")));  // reported once only
}

/// Robots of model files and of inputs.yaml, which stores bodies as wholes.
TEST_F(LoadCases, RobotsWithBarsAreWrittenAsModels) {
  ChangeFile("model.yaml", kFrame, "expansion_per_k: 2e-5}",
             "expansion_per_k: 2e-5, mass_kg: 0.2, strength_n: 40}");
  const ExperimentSpec read = Load();
  Write("resolved.yaml", ResolvedYaml(read));
  for (const ExperimentSpec& e : {read, Load("resolved.yaml")}) {
    Diagnostics out;
    const auto text = ModelYaml(e.robot, "", out);
    ASSERT_TRUE(text) << out.Format();
    Write("written.yaml", *text);
    const auto back = LoadRobot(Path("written.yaml"), {}, out);
    ASSERT_TRUE(back) << out.Format() << *text;
    ASSERT_EQ(back->def.bodies.size(), 3u);
    EXPECT_NEAR(back->def.bodies[2].mass_kg, 1 + 0.2, 1e-15);
    const JointDef &leg = back->def.joints.at(1), &was = read.robot.def.joints.at(1);
    EXPECT_EQ(leg.name, was.name);
    EXPECT_EQ(leg.stiffness, was.stiffness);
    EXPECT_EQ(leg.rest, was.rest);
    EXPECT_EQ(leg.member.expansion_per_k, 1e-5);
    EXPECT_EQ(leg.member.mass_kg, 1);
    EXPECT_THAT(back->joint_tags.at(1), testing::Contains("leg"));
    EXPECT_EQ(back->def.cables.at(0).member.strength_n, 40);
  }
}

TEST_F(LoadCases, NumbersHaveLimits) {
  std::string many = "load_combinations:\n";
  for (int i = 0; i < 9999; ++i)
    many += "  - {name: k" + std::to_string(i) + ", factors: {snow: 1}}\n";
  EXPECT_EQ(
      After("load_cases:\n", many + "load_cases:\n"),
      "10007:11: error: there are 10001 load cases and combinations, more than 10000 (analyze "
      "them in several experiments)\n");
  many.erase(many.rfind("  - "));  // 10000 are read at once
  EXPECT_EQ(After("load_cases:\n", many + "load_cases:\n"), "");
}

TEST_F(LoadCases, CombinationsThatRepeatTooManyLoadsAreRefusedBeforeTheirForcesExist) {
  std::string many = "load_combinations:\n";
  for (int i = 0; i < 9990; ++i)
    many += "  - {name: k" + std::to_string(i) + ", factors: {snow: 1}}\n";
  std::string forces = "    forces:\n";
  for (int i = 0; i < 1001; ++i) forces += "      - {node: c, force_n: [0, 0, -100]}\n";
  EXPECT_EQ(
      After("load_cases:\n  - name: snow\n    forces:\n",
            many + "load_cases:\n  - name: snow\n" + forces),
      "9986:12: error: the load cases and combinations up to this one have more than 10000000 "
      "forces and changes of length (analyze them in several experiments)\n");
}

TEST_F(LoadCases, SelectorsThatExamineTooManyPartsAreRefused) {
  Write("model.yaml",
        "taut: 1\nkind: model\nname: many\nallow_disconnected: true\n"
        "parts: {ball: {nodes: {a: {at_m: [0, 0, 1], tags: [ball]}}}}\n"
        "structure: [{part: ball, copies: 10000, step_m: [0, 1, 0]}]\n"
        "builders: [{match: ball, sphere: {radius_m: 0.1, mass_kg: 1}}]\n");
  std::string cases =
      "taut: 1\nkind: experiment\nname: loads\nmodel: model.yaml\nduration_s: 1\n"
      "load_cases:\n  - name: snow\n    forces:\n";
  for (int i = 0; i <= 10'000; ++i) cases += "      - {nodes: ball, force_n: [0, 0, -1]}\n";
  Write("trial.yaml", cases);
  EXPECT_EQ(Without("trial.yaml:", Complaints()),
            "7:11: error: the 10001 loads up to this load case and the 10000 nodes, cables, joints "
            "and rods of the robot have a product of more than 100000000 (use fewer "
            "selectors that match more elements, or several experiments)\n");
}

}  // namespace
}  // namespace taut::test
