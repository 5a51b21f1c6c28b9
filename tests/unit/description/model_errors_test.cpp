// Errors of invalid model files: every message with its line and column
#include <gtest/gtest.h>

#include <algorithm>

#include "unit/description/model_fixture.h"

namespace taut {
namespace {

TEST(ModelErrors, KeysAreStrict) {
  EXPECT_EQ(Errors(OneRod("{radius: 0.1, mass: 1}")),
            "robot.yaml:6:31: error: unknown key \"radius\" in rod (did you mean \"radius_m\"?)\n"
            "robot.yaml:6:44: error: unknown key \"mass\" in rod (did you mean \"mass_kg\" or "
            "\"mass_kg_per_m\"?)\n");
  EXPECT_EQ(Errors(OneRod("{radius_m: 0.1, mass_kg: 1}") + "conections: []\n"),
            "robot.yaml:7:1: error: unknown key \"conections\" (one of: taut, kind, name, "
            "description, base, "
            "parameters, parts, nodes, pairs, structure, builders, apart, ...)\n");
  EXPECT_EQ(Errors(OneRod("{radius_m: 0.1, mass_kg: 1}") + "pairs: []\n"),
            "robot.yaml:7:1: error: duplicate key \"pairs\" (first in line 5)\n");
}

TEST(ModelErrors, AMisspelledKeyIsOneError) {
  // Neither the missing key nor a condition on several keys follows as another error.
  const auto coded = [](const std::string& yaml) {
    std::string lines = CodedErrors(yaml), without_places;
    for (std::size_t at = 0; at < lines.size(); at = lines.find('\n', at) + 1) {
      const std::size_t from = lines.find("error: ", at) + 7;
      without_places += lines.substr(from, lines.find('\n', at) + 1 - from);
    }
    return without_places;
  };
  std::string misspelled = TwoRods();
  misspelled.replace(misspelled.find("stiffness"), 9, "stifness");
  EXPECT_EQ(coded(misspelled), "key.unknown \"stifness_n_per_m\"\n");
  EXPECT_EQ(coded(TwoRods("rest_length_m: 0.05, actuator: {max_sped_m_per_s: 1}")),
            "key.unknown \"max_sped_m_per_s\" cable.actuator\n");
  EXPECT_EQ(coded(OneRod("{radius_mm: 4, mass_kg: 1}")), "key.unknown \"radius_mm\"\n");
  // Other keys of the same map are still missing, and errors at other places are independent.
  EXPECT_EQ(coded(OneRod("{radius: 4}")),
            "key.one_of_missing mass_kg density_kg_per_m3 mass_kg_per_m\n"
            "key.unknown \"radius\"\n");
}

TEST(ModelErrors, AWrongNumberOfCopiesCausesNoErrorsOfTheCopies) {
  const std::string text = Errors(
      "parts:\n  strut:\n    nodes: {bottom: [0.1, 0, 0], top: [-0.1, 0.02, 0.2]}\n"
      "    pairs: [{nodes: [bottom, top], tags: [strut]}]\n"
      "structure:\n  - part: strut\n    copies: 3.5\n    ring: true\n"
      "    step_rotate: {axis: z, angle_rad: 2.0943951023931953}\n"
      "    connect: [{name: side, nodes: [top, bottom], tags: [side]}]\n"
      "builders:\n  - {match: strut, rod: {radius_m: 0.005, mass_kg: 0.1}}\n"
      "  - {match: side, cable: {stiffness_n_per_m: 1000, prestress_n: 1}}\n");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  EXPECT_NE(text.find("structure.copies must be a whole number"), std::string::npos) << text;
}

TEST(ModelErrors, ADecimalCommaIsOneError) {
  for (const char* const rod : {"{radius_m: 0,1, mass_kg: 1}", "{mass_kg: 1, radius_m: 0,1}"}) {
    const std::string text = Errors(OneRod(rod));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_NE(text.find("write decimal fractions with a point"), std::string::npos) << text;
  }
  const std::string list = Errors("nodes: {a: [0,5, 0, 1]}\n");
  EXPECT_EQ(list.rfind("robot.yaml:4:12: error: nodes.a must have 3 numbers, got 4 (write decimal "
                       "fractions with a point)\n",
                       0),
            0u)
      << list;
  const std::string block = Errors("parameters:\n  a_m: 0,5\nnodes: {a: [0, 0, a_m]}\n");
  EXPECT_NE(block.find("unexpected \",\" in \"0,5\" (write decimal fractions with a point)"),
            std::string::npos)
      << block;
}

TEST(ModelErrors, KeysInOtherUnitsHaveTheUnitAfterTheValue) {
  const std::string rod = Errors(OneRod("{radius_mm: 4, mass_g: 20}"));
  EXPECT_NE(rod.find("unknown key \"radius_mm\" in rod (write \"radius_m: 4 mm\")"),
            std::string::npos)
      << rod;
  EXPECT_NE(rod.find("(write \"mass_kg: 20 g\")"), std::string::npos) << rod;
  const std::string cable = Errors(TwoRods("stiffness_n_per_mm: 0.4, pretension_n: 1"));
  EXPECT_NE(cable.find("(write \"stiffness_n_per_m: 0.4 N/mm\")"), std::string::npos) << cable;
  EXPECT_NE(cable.find("(did you mean \"prestress_n\"?)"), std::string::npos) << cable;
}

TEST(ModelErrors, NumbersAreInTheirRange) {
  EXPECT_EQ(CodedErrors(OneRod(
                "{radius_m: -0.1, mass_kg: .nan, friction: -1, restitution: 2, collides: 1}")),
            "robot.yaml:6:41: error: value.out_of_range rod.radius_m -0.1\n"
            "robot.yaml:6:56: error: value.not_finite rod.mass_kg\n"
            "robot.yaml:6:72: error: value.out_of_range rod.friction -1\n"
            "robot.yaml:6:89: error: value.out_of_range rod.restitution 0..1 2\n"
            "robot.yaml:6:102: error: value.not_boolean rod.collides \"1\"\n");
  EXPECT_EQ(CodedErrors(OneRod("{radius_m: 0, mass_kg: 1}")),
            "robot.yaml:6:41: error: value.out_of_range rod.radius_m 0\n");
  EXPECT_EQ(CodedErrors(TwoRods("prestress_n: -1, damping_n_s_per_m: -1")),
            "robot.yaml:11:65: error: value.out_of_range cable.prestress_n -1\n"
            "robot.yaml:11:88: error: value.out_of_range cable.damping_n_s_per_m -1\n");
}

TEST(ModelErrors, PartsHaveNamesLikeNodes) {
  // Part names become names of bodies, channels and columns.
  for (const char* name : {"a,b", "..", "a/b", "<script>", "a b", "\u202eb", "a.b"}) {
    const std::string quoted = std::string("\"") + name + "\"";
    EXPECT_EQ(
        CodedErrors(
            "parts: {" + quoted +
            ": {nodes: {a: [0, 0, 0], b: [1, 0, 0]}, pairs: [{nodes: [a, b], tags: [rod]}]}}\n"
            "structure: [{part: " +
            quoted + "}]\nbuilders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1}}]\n"),
        "robot.yaml:4:9: error: name.bad " + quoted + "\n");
  }
}

TEST(ModelErrors, MassIsGivenOnce) {
  EXPECT_EQ(CodedErrors(OneRod("{radius_m: 0.1, mass_kg: 1, density_kg_per_m3: 1}")),
            "robot.yaml:6:58: error: key.both_given mass_kg density_kg_per_m3\n");
  EXPECT_EQ(CodedErrors(OneRod("{radius_m: 0.1, mass_kg: 0}")),
            "robot.yaml:5:9: error: body.no_mass \"robot\"\n");
}

TEST(ModelErrors, FrictionIsGivenOnce) {
  EXPECT_EQ(CodedErrors(OneRod("{radius_m: 0.1, mass_kg: 1, friction: 1, static_friction: 1}")),
            "robot.yaml:6:71: error: friction.given_twice rod.friction static_friction\n");
  EXPECT_EQ(CodedErrors(OneRod("{radius_m: 0.1, mass_kg: 1, static_friction: 1}")),
            "robot.yaml:6:30: error: key.missing \"kinetic_friction\"\n");
  EXPECT_EQ(CodedErrors(
                OneRod("{radius_m: 0.1, mass_kg: 1, static_friction: 0.1, kinetic_friction: 0.2}")),
            "robot.yaml:6:58: error: friction.static_below_kinetic rod.static_friction "
            "kinetic_friction\n");
}

TEST(ModelErrors, RestLengthIsGivenOnceAndPossible) {
  EXPECT_EQ(
      CodedErrors(TwoRods("damping_n_s_per_m: 1")),
      "robot.yaml:11:27: error: key.one_of_missing prestress_n rest_length_m rest_length_ratio\n");
  EXPECT_EQ(CodedErrors(TwoRods("prestress_n: 1, rest_length_m: 1")),
            "robot.yaml:11:68: error: key.both_given prestress_n rest_length_m\n");
  EXPECT_EQ(CodedErrors(TwoRods("prestress_n: 10")),
            "robot.yaml:11:65: error: cable.prestress_too_high cable.prestress_n 10 \"a-c\" 0.1\n");
  EXPECT_EQ(CodedErrors(TwoRods("rest_length_m: 0")),
            "robot.yaml:11:67: error: value.out_of_range cable.rest_length_m 0\n");
  EXPECT_EQ(
      CodedErrors(TwoRods("prestress_n: 9, actuator: {min_rest_length_m: 0.05}")),
      "robot.yaml:11:65: error: cable.rest_length_below_min \"a-c\" 0.01 min_rest_length_m 0.05\n");
}

TEST(ModelErrors, ActuatorsSayWhatTheyAre) {
  EXPECT_EQ(CodedErrors(TwoRods("prestress_n: 1, actuator: {}")),
            "robot.yaml:11:78: error: actuator.limits_missing cable.actuator dc_motor\n");
  EXPECT_EQ(CodedErrors(TwoRods("prestress_n: 1, actuator: {ideal: true, max_force_n: 3}")),
            "robot.yaml:11:79: error: actuator.ideal_has_no_limits\n");
  EXPECT_EQ(CodedErrors(TwoRods("prestress_n: 1, actuator: {max_speed: 3}")),
            "robot.yaml:11:79: error: key.unknown \"max_speed\" cable.actuator\n");
}

TEST(ModelErrors, NodesThatDoNotExist) {
  std::string yaml = TwoRods();
  yaml.replace(yaml.find("[a, c]"), 6, "[a, e]");
  EXPECT_EQ(CodedErrors(yaml), "robot.yaml:8:17: error: node.unknown \"e\"\n");
  EXPECT_EQ(
      CodedErrors(
          "parts: {p: {nodes: {left: [0, 0, 0], right: {at_m: [1, 0, 0], fixed_to: lift}},\n"
          "            pairs: [{nodes: [left, rigth], tags: [rod]}]}}\n"
          "structure: [{part: p, copies: 2, step_m: [1, 1, 1], connect: [{nodes: [left, rite], "
          "tags: [rod]}]}]\n"
          "builders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1}}]\n"),
      "robot.yaml:4:73: error: node.unknown \"lift\"\n"
      "robot.yaml:5:36: error: node.unknown \"rigth\" \"p\"\n"
      "robot.yaml:6:78: error: node.unknown \"rite\" \"p\"\n");
}

TEST(ModelErrors, NodesAndPairsAreWellFormed) {
  EXPECT_EQ(
      CodedErrors("nodes: {a: 3, b.c: [0, 0, 0], d: {at: [0, 0, 0]}, e: {at_m: [0, 0, 0], "
                  "fixed_to: e}}\npairs: [{nodes: [a], tags: [x]}, "
                  "{nodes: [d, d], tags: [x]}, {nodes: d, tags: [x]}, {name: n, each: [[a, d]]}, "
                  "{tags: [x]}, 7]\nbuilders: []\n"),
      "robot.yaml:4:12: error: value.wrong_kind nodes.a at_m\n"
      "robot.yaml:4:15: error: name.bad \"b.c\"\n"
      "robot.yaml:4:35: error: key.unknown \"at\" nodes.d\n"
      "robot.yaml:4:82: error: node.fixed_to_itself \"e\"\n"
      "robot.yaml:5:17: error: pair.few_nodes pairs.nodes 2 1\n"
      "robot.yaml:5:34: error: pair.no_builder \"d-d\"\n"
      "robot.yaml:5:46: error: pair.same_node_twice \"d\"\n"
      "robot.yaml:5:70: error: value.wrong_kind pairs.nodes\n"
      "robot.yaml:5:86: error: pair.name_shared pairs.each\n"
      "robot.yaml:5:102: error: pair.no_builder \"n\"\n"
      "robot.yaml:5:112: error: key.one_of_missing\n"
      "robot.yaml:5:125: error: value.wrong_kind\n");
}

TEST(ModelErrors, PartsAndStructureFitTogether) {
  EXPECT_EQ(CodedErrors("builders: []\n"), "robot.yaml:1:1: error: model.empty\n");
  EXPECT_EQ(CodedErrors("parts: {bar: {nodes: {a: [0, 0, 0]}}}\nbuilders: []\n"),
            "robot.yaml:1:1: error: model.empty\n");
  EXPECT_EQ(CodedErrors(std::string(kBars) + "structure: [{part: bat}, {name: x}]\n"),
            "robot.yaml:7:20: error: part.unknown \"bat\"\n"
            "robot.yaml:7:26: error: key.missing \"part\"\n");
  EXPECT_EQ(CodedErrors(std::string(kBars) +
                        "structure: [{part: bar}, {part: bar}]\nallow_disconnected: true\n"),
            "robot.yaml:7:26: error: structure.duplicate_name \"bar\"\n");
  EXPECT_EQ(CodedErrors(std::string(kBars) + "structure: [{part: bar, step_m: [1, 0, 0]}]\n"),
            "robot.yaml:7:25: error: structure.key_needs_copies structure.step_m\n");
}

TEST(ModelErrors, CopiesAreAReasonableNumber) {
  const auto copies = [](const std::string& count) {
    return Errors(std::string(kBars) +
                  "allow_disconnected: true\nstructure: [{part: bar, step_m: [0, 1, 0], copies: " +
                  count + "}]\n");
  };
  EXPECT_EQ(
      copies("0"),
      "robot.yaml:8:52: error: structure.copies must be a whole number within 1..10000, got 0\n");
  EXPECT_EQ(
      copies("1.5"),
      "robot.yaml:8:52: error: structure.copies must be a whole number within 1..10000, got 1.5\n");
  EXPECT_EQ(copies("1e9"),
            "robot.yaml:8:52: error: structure.copies must be a whole number within 1..10000, got "
            "1e+09\n");
  std::string many = std::string(kBars) + "allow_disconnected: true\nstructure:\n";
  for (int i = 0; i < 6; ++i)
    many += "  - {part: bar, name: b" + std::to_string(i) + ", copies: 10000, step_m: [0, 1, 0]}\n";
  EXPECT_EQ(CodedErrors(many), "robot.yaml:14:5: error: model.too_large 100000\n");
}

TEST(ModelErrors, PairsAndTagsAreAReasonableNumber) {
  std::string many;
  for (int i = 0; i < 33; ++i) many += "t" + std::to_string(i) + ", ";
  EXPECT_EQ(CodedErrors("nodes: {a: {at_m: [0, 0, 0], tags: [" + many +
                        "x]}}\n"
                        "builders: [{match: a, sphere: {radius_m: 1, mass_kg: 1}}]\n"),
            "robot.yaml:4:30: error: tags.too_many nodes.a.tags 32\n");
  std::string links;
  for (int i = 0; i < 25; ++i)
    links += "{name: l" + std::to_string(i) + ", nodes: [a, a], tags: [x]}, ";
  EXPECT_EQ(CodedErrors(std::string(kBars) +
                        "  - {match: x, cable: {stiffness_n_per_m: 1, rest_length_m: 1}}\n"
                        "structure: [{part: bar, step_m: [0, 1, 0], copies: 10000, connect: [" +
                        links + "]}]\n"),
            "robot.yaml:8:13: error: model.too_large 400000\n");
}

TEST(ModelErrors, BuildersAreAReasonableNumber) {
  std::string many = "nodes: {a: [0, 0, 0]}\nbuilders:\n";
  for (int i = 0; i < 1001; ++i) many += "  - {match: a, point_mass: {mass_kg: 1}}\n";
  EXPECT_EQ(CodedErrors(many), "robot.yaml:6:3: error: builder.too_many 1000\n");
}

TEST(ModelErrors, RotationsAreWellFormed) {
  const auto rotate = [](const std::string& text) {
    return Errors(std::string(kBars) + "structure: [{part: bar, rotate: " + text + "}]\n");
  };
  EXPECT_EQ(
      rotate("{axis: q, angle_rad: 1}"),
      "robot.yaml:7:40: error: structure.rotate.axis cannot be \"q\" (did you mean \"x\"?)\n");
  EXPECT_EQ(rotate("{axis: z}"),
            "robot.yaml:7:33: error: structure.rotate needs the key \"angle_rad\"\n");
  EXPECT_EQ(rotate("{axis: z, angle_deg: 90}"),
            "robot.yaml:7:43: error: unknown key \"angle_deg\" in structure.rotate (write "
            "\"angle_rad: 90 deg\")\n");
  EXPECT_EQ(rotate("{axis: [0, 0, 0], angle_rad: 1}"),
            "robot.yaml:7:40: error: structure.rotate.axis must not be zero (it is a direction)\n");
  EXPECT_EQ(rotate("{axis: z, angle_rad: 1e10}"),
            "robot.yaml:7:43: error: structure.rotate.angle_rad is too large\n");
  EXPECT_EQ(rotate("{quaternion: [0, 0, 0, 0]}"),
            "robot.yaml:7:46: error: structure.rotate.quaternion must not be zero (expected [w, x, "
            "y, z])\n");
  EXPECT_EQ(rotate("{quaternion: [1, 0, 0, 0], axis: z}"),
            "robot.yaml:7:34: error: structure.rotate has both a quaternion and an axis or angle "
            "(give only one of them)\n");
}

TEST(ModelErrors, TopLevelChoicesAndNames) {
  EXPECT_EQ(CodedErrors(OneRod("{radius_m: 0.1, mass_kg: 1}") +
                        "contact: {friction_combine: mean, friction: 1}\ninertia: box\n"
                        "damping_law: none\nallow_disconnected: maybe\ngravity_m_per_s2: -9.81\n"),
            "robot.yaml:7:29: error: value.unknown_word contact.friction_combine \"mean\"\n"
            "robot.yaml:7:35: error: key.unknown \"friction\"\n"
            "robot.yaml:8:10: error: value.unknown_word \"box\"\n"
            "robot.yaml:9:14: error: value.unknown_word damping_law \"none\"\n"
            "robot.yaml:10:21: error: value.not_boolean allow_disconnected \"maybe\"\n"
            "robot.yaml:11:19: error: value.wrong_kind gravity_m_per_s2 3\n");
}

TEST(ModelErrors, BasesAreModelsThatExist) {
  EXPECT_EQ(CodedErrors("base: [a]\n"), "robot.yaml:4:7: error: base.bad_name\n");
  EXPECT_EQ(CodedErrors("base: /no/such/file.yaml\n"),
            "robot.yaml:4:7: error: base.missing /no/such/file.yaml\n");
  EXPECT_EQ(CodedErrors("base: ModelErrors.BasesAreModelsThatExist.yaml\n"),
            "robot.yaml:4:7: error: base.circle robot.yaml\n");
  EXPECT_NE(Errors("base: " TAUT_SOURCE_DIR "/share/experiments/push_20n.yaml\n")
                .find("kind must be model, got experiment"),
            std::string::npos);
  EXPECT_EQ(
      CodedErrors(
          "base: " TAUT_SOURCE_DIR
          "/share/models/rod.yaml\nparameters: {length_m: 2, more: 3}\nnodes: {a: [0, 0, 0]}\n"),
      TAUT_SOURCE_DIR "/share/models/rod.yaml:16:14: error: node.unknown \"back\"\n" TAUT_SOURCE_DIR
                      "/share/models/rod.yaml:16:20: error: node.unknown \"front\"\n");
}

TEST(FileKind, IsWhatTheFileSays) {
  Diagnostics out;
  EXPECT_EQ(FileKind(TAUT_SOURCE_DIR "/share/models/rod.yaml", out), "model");
  EXPECT_EQ(FileKind(TAUT_SOURCE_DIR "/share/experiments/push_20n.yaml", out), "experiment");
  EXPECT_EQ(FileKind(TAUT_SOURCE_DIR "/share/gaits/cpg_learned.yaml", out), "gait");
  EXPECT_TRUE(out.ok());
  EXPECT_FALSE(FileKind("/no/such/file.yaml", out));
  const std::string path = ::testing::TempDir() + "taut_kind.yaml";
  std::ofstream(path) << "taut: 1\nkind: robot\n";
  EXPECT_FALSE(FileKind(path, out));
  std::remove(path.c_str());
  EXPECT_EQ(out.items()[0].what, "cannot open: No such file or directory");
  EXPECT_EQ(out.items()[1].what, "kind must be model, experiment or gait, got robot");
  EXPECT_EQ(out.items()[1].at.line, 2);
}

TEST(ModelErrors, OverridesThatNoOneKnows) {
  EXPECT_EQ(ReadModel("parameters: {edge_m: 1}\n" + OneRod("{radius_m: 0.1, mass_kg: 1}"),
                      {{"edge", "2"}})
                .errors,
            "--set edge=2: error: there is no parameter \"edge\" (did you mean \"edge_m\"?)\n");
  EXPECT_EQ(ReadModel("nodes: [\n", {{"edge", "2"}}).errors.find("--set"), std::string::npos);
}

TEST(ModelErrors, AllOfThemAtOnce) {
  const std::string errors = Errors(
      "parameters: {x: 1 / 0}\n"
      "nodes: {a: [0, 0, 0], b: [x, 0, 0], c: [1, 0]}\n"
      "pairs: [{nodes: [a, b], tags: [rod]}, {node: [a, c], tags: [cable]}]\n"
      "builders: [{match: rod, rod: {radius_m: -1, mass_kg: 1}}, {match: cable, cable: "
      "{stiffness_n_per_m: 0, prestress_n: 1}}]\n");
  EXPECT_EQ(errors,
            "robot.yaml:4:17: error: parameters.x: division by zero\n"
            "robot.yaml:5:40: error: nodes.c must have 3 numbers, got 2\n"
            "robot.yaml:6:40: error: unknown key \"node\" in pairs (did you mean \"nodes\"?)\n"
            "robot.yaml:7:41: error: rod.radius_m must be positive, got -1\n"
            "robot.yaml:7:101: error: cable.stiffness_n_per_m must be positive, got 0\n");
}

}  // namespace
}  // namespace taut
