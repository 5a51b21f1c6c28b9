// Errors of invalid model files: every message with its line and column
#include <gtest/gtest.h>

#include "unit/description/model_fixture.h"

namespace taut {
namespace {

TEST(ModelErrors, KeysAreStrict) {
  EXPECT_EQ(Errors(OneRod("{radius: 0.1, mass: 1}")),
            "robot.yaml:6:30: error: rod needs one of mass_kg, density_kg_per_m3, mass_kg_per_m\n"
            "robot.yaml:6:30: error: rod needs the key \"radius_m\"\n"
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

TEST(ModelErrors, KeysInOtherUnitsHaveTheFactor) {
  const std::string rod = Errors(OneRod("{radius_mm: 4, mass_g: 20}"));
  EXPECT_NE(
      rod.find("unknown key \"radius_mm\" in rod (write \"radius_m\", and the value times 0.001)"),
      std::string::npos)
      << rod;
  EXPECT_NE(rod.find("(write \"mass_kg\", and the value times 0.001)"), std::string::npos) << rod;
  const std::string cable = Errors(TwoRods("stiffness_n_per_mm: 0.4, pretension_n: 1"));
  EXPECT_NE(cable.find("(write \"stiffness_n_per_m\", and the value times 1000)"),
            std::string::npos)
      << cable;
  EXPECT_NE(cable.find("(did you mean \"prestress_n\"?)"), std::string::npos) << cable;
}

TEST(ModelErrors, NumbersAreInTheirRange) {
  EXPECT_EQ(
      Errors(OneRod("{radius_m: -0.1, mass_kg: .nan, friction: -1, restitution: 2, collides: 1}")),
      "robot.yaml:6:41: error: rod.radius_m must be positive, got -0.1\n"
      "robot.yaml:6:56: error: rod.mass_kg must be a finite number, got .nan\n"
      "robot.yaml:6:72: error: rod.friction must not be negative, got -1\n"
      "robot.yaml:6:89: error: rod.restitution must be within 0..1, got 2\n"
      "robot.yaml:6:102: error: rod.collides must be true or false, got \"1\"\n");
  EXPECT_EQ(Errors(OneRod("{radius_m: 0, mass_kg: 1}")),
            "robot.yaml:6:41: error: rod.radius_m must be positive, got 0\n");
  EXPECT_EQ(Errors(TwoRods("prestress_n: -1, damping_n_s_per_m: -1")),
            "robot.yaml:11:65: error: cable.prestress_n must not be negative, got -1\n"
            "robot.yaml:11:88: error: cable.damping_n_s_per_m must not be negative, got -1\n");
}

TEST(ModelErrors, PartsHaveNamesLikeNodes) {
  // Part names become names of bodies, channels and columns.
  for (const char* name : {"a,b", "..", "a/b", "<script>", "a b", "\u202eb", "a.b"}) {
    const std::string quoted = std::string("\"") + name + "\"";
    EXPECT_EQ(
        Errors("parts: {" + quoted +
               ": {nodes: {a: [0, 0, 0], b: [1, 0, 0]}, pairs: [{nodes: [a, b], tags: [rod]}]}}\n"
               "structure: [{part: " +
               quoted + "}]\nbuilders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1}}]\n"),
        "robot.yaml:4:9: error: parts: " + quoted +
            " cannot be a name (use letters, digits, _ and -)\n");
  }
}

TEST(ModelErrors, MassIsGivenOnce) {
  EXPECT_EQ(Errors(OneRod("{radius_m: 0.1, mass_kg: 1, density_kg_per_m3: 1}")),
            "robot.yaml:6:58: error: rod has both mass_kg and density_kg_per_m3 (give only one of "
            "them)\n");
  EXPECT_EQ(Errors(OneRod("{radius_m: 0.1, mass_kg: 0}")),
            "robot.yaml:5:9: error: the body \"robot\" has no mass\n");
}

TEST(ModelErrors, FrictionIsGivenOnce) {
  EXPECT_EQ(Errors(OneRod("{radius_m: 0.1, mass_kg: 1, friction: 1, static_friction: 1}")),
            "robot.yaml:6:71: error: rod.friction already sets static_friction (give friction "
            "alone, or static_friction and kinetic_friction)\n");
  EXPECT_EQ(Errors(OneRod("{radius_m: 0.1, mass_kg: 1, static_friction: 1}")),
            "robot.yaml:6:30: error: rod needs the key \"kinetic_friction\"\n");
  EXPECT_EQ(
      Errors(OneRod("{radius_m: 0.1, mass_kg: 1, static_friction: 0.1, kinetic_friction: 0.2}")),
      "robot.yaml:6:58: error: rod.static_friction is below kinetic_friction (static friction must "
      "be at least the kinetic friction)\n");
}

TEST(ModelErrors, RestLengthIsGivenOnceAndPossible) {
  EXPECT_EQ(Errors(TwoRods("damping_n_s_per_m: 1")),
            "robot.yaml:11:27: error: cable needs one of prestress_n, rest_length_m, "
            "rest_length_ratio\n");
  EXPECT_EQ(Errors(TwoRods("prestress_n: 1, rest_length_m: 1")),
            "robot.yaml:11:68: error: cable has both prestress_n and rest_length_m (give only one "
            "of them)\n");
  EXPECT_EQ(Errors(TwoRods("prestress_n: 10")),
            "robot.yaml:11:65: error: cable.prestress_n: 10 N would stretch the cable \"a-c\" by "
            "its whole length of 0.1 m or more (with a stiffness of 100 N/m at most 10 N)\n");
  EXPECT_EQ(Errors(TwoRods("rest_length_m: 0")),
            "robot.yaml:11:67: error: cable.rest_length_m must be positive, got 0\n");
  EXPECT_EQ(
      Errors(TwoRods("prestress_n: 9, actuator: {min_rest_length_m: 0.05}")),
      "robot.yaml:11:65: error: the cable \"a-c\" starts with a rest length of 0.01 m, below its "
      "min_rest_length_m of 0.05 m\n");
}

TEST(ModelErrors, ActuatorsSayWhatTheyAre) {
  EXPECT_EQ(Errors(TwoRods("prestress_n: 1, actuator: {}")),
            "robot.yaml:11:78: error: cable.actuator needs limits, a `dc_motor`, or `ideal: true` "
            "(leave out the actuator for a fixed rest length)\n");
  EXPECT_EQ(Errors(TwoRods("prestress_n: 1, actuator: {ideal: true, max_force_n: 3}")),
            "robot.yaml:11:79: error: an ideal actuator cannot have limits (leave out `ideal`, or "
            "the limits)\n");
  EXPECT_EQ(Errors(TwoRods("prestress_n: 1, actuator: {max_speed: 3}")),
            "robot.yaml:11:78: error: cable.actuator needs limits, a `dc_motor`, or `ideal: true` "
            "(leave out the actuator for a fixed rest length)\n"
            "robot.yaml:11:79: error: unknown key \"max_speed\" in cable.actuator (did you mean "
            "\"max_speed_m_per_s\"?)\n");
}

TEST(ModelErrors, NodesThatDoNotExist) {
  std::string yaml = TwoRods();
  yaml.replace(yaml.find("[a, c]"), 6, "[a, e]");
  EXPECT_EQ(Errors(yaml), "robot.yaml:8:17: error: there is no node \"e\" (did you mean \"a\"?)\n");
  EXPECT_EQ(
      Errors("parts: {p: {nodes: {left: [0, 0, 0], right: {at_m: [1, 0, 0], fixed_to: lift}},\n"
             "            pairs: [{nodes: [left, rigth], tags: [rod]}]}}\n"
             "structure: [{part: p, copies: 2, step_m: [1, 1, 1], connect: [{nodes: [left, rite], "
             "tags: [rod]}]}]\n"
             "builders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1}}]\n"),
      "robot.yaml:4:73: error: there is no node \"lift\" in this part (did you mean \"left\"?)\n"
      "robot.yaml:5:36: error: there is no node \"rigth\" in part \"p\" (did you mean \"right\"?)\n"
      "robot.yaml:6:78: error: there is no node \"rite\" in part \"p\" (one of: left, right)\n");
}

TEST(ModelErrors, NodesAndPairsAreWellFormed) {
  EXPECT_EQ(
      Errors("nodes: {a: 3, b.c: [0, 0, 0], d: {at: [0, 0, 0]}, e: {at_m: [0, 0, 0], "
             "fixed_to: e}}\npairs: [{nodes: [a], tags: [x]}, "
             "{nodes: [d, d], tags: [x]}, {nodes: d, tags: [x]}, {name: n, each: [[a, d]]}, "
             "{tags: [x]}, 7]\nbuilders: []\n"),
      "robot.yaml:4:12: error: nodes.a must be [x, y, z] or a map with at_m, got a text\n"
      "robot.yaml:4:15: error: nodes: \"b.c\" cannot be a name (use letters, digits, _ and -)\n"
      "robot.yaml:4:34: error: nodes.d needs the key \"at_m\"\n"
      "robot.yaml:4:35: error: unknown key \"at\" in nodes.d (did you mean \"at_m\"?)\n"
      "robot.yaml:4:82: error: the node \"e\" is fixed to itself\n"
      "robot.yaml:5:17: error: pairs.nodes must name 2 or more nodes, got 1\n"
      "robot.yaml:5:34: error: no builder matches the pair \"d-d\" (its tags are [x, d-d])\n"
      "robot.yaml:5:46: error: a pair connects \"d\" to itself\n"
      "robot.yaml:5:70: error: pairs.nodes must be a list of nodes, got a text\n"
      "robot.yaml:5:86: error: pairs.each makes several pairs, which cannot share a name\n"
      "robot.yaml:5:102: error: no builder matches the pair \"n\" (its tags are [n])\n"
      "robot.yaml:5:112: error: pairs needs one of nodes, each, route\n"
      "robot.yaml:5:125: error: pairs must be a map, got a text\n");
}

TEST(ModelErrors, PartsAndStructureFitTogether) {
  EXPECT_EQ(Errors("builders: []\n"),
            "robot.yaml:1:1: error: the model has neither nodes nor a structure (add `nodes:`, or "
            "`parts:` and a `structure:`)\n");
  EXPECT_EQ(Errors("parts: {bar: {nodes: {a: [0, 0, 0]}}}\nbuilders: []\n"),
            "robot.yaml:1:1: error: the model has neither nodes nor a structure (place the parts "
            "in a `structure:` list)\n");
  EXPECT_EQ(Errors(std::string(kBars) + "structure: [{part: bat}, {name: x}]\n"),
            "robot.yaml:7:20: error: there is no part \"bat\" (did you mean \"bar\"?)\n"
            "robot.yaml:7:26: error: structure needs the key \"part\"\n");
  EXPECT_EQ(Errors(std::string(kBars) +
                   "structure: [{part: bar}, {part: bar}]\nallow_disconnected: true\n"),
            "robot.yaml:7:26: error: two placements in the structure have the name \"bar\" (give "
            "each placement a different `name:`)\n");
  EXPECT_EQ(
      Errors(std::string(kBars) + "structure: [{part: bar, step_m: [1, 0, 0]}]\n"),
      "robot.yaml:7:25: error: structure.step_m needs `copies` (write `copies: 2` or more)\n");
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
  EXPECT_EQ(Errors(many),
            "robot.yaml:14:5: error: the model has more than 100000 nodes (reduce the 10000 copies "
            "of this placement)\n");
}

TEST(ModelErrors, PairsAndTagsAreAReasonableNumber) {
  std::string many;
  for (int i = 0; i < 33; ++i) many += "t" + std::to_string(i) + ", ";
  EXPECT_EQ(Errors("nodes: {a: {at_m: [0, 0, 0], tags: [" + many +
                   "x]}}\n"
                   "builders: [{match: a, sphere: {radius_m: 1, mass_kg: 1}}]\n"),
            "robot.yaml:4:30: error: nodes.a.tags has more than 32 tags\n");
  std::string links;
  for (int i = 0; i < 25; ++i)
    links += "{name: l" + std::to_string(i) + ", nodes: [a, a], tags: [x]}, ";
  EXPECT_EQ(Errors(std::string(kBars) +
                   "  - {match: x, cable: {stiffness_n_per_m: 1, rest_length_m: 1}}\n"
                   "structure: [{part: bar, step_m: [0, 1, 0], copies: 10000, connect: [" +
                   links + "]}]\n"),
            "robot.yaml:8:13: error: the pairs of the model have more than 400000 nodes in all "
            "(reduce the 10000 copies of this placement)\n");
}

TEST(ModelErrors, BuildersAreAReasonableNumber) {
  std::string many = "nodes: {a: [0, 0, 0]}\nbuilders:\n";
  for (int i = 0; i < 1001; ++i) many += "  - {match: a, point_mass: {mass_kg: 1}}\n";
  EXPECT_EQ(Errors(many),
            "robot.yaml:6:3: error: the model has more than 1000 builders (match tags that several "
            "nodes or pairs share)\n");
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
            "robot.yaml:7:33: error: structure.rotate needs the key \"angle_rad\"\n"
            "robot.yaml:7:43: error: unknown key \"angle_deg\" in structure.rotate (write "
            "\"angle_rad\", and the value times pi / 180)\n");
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
  EXPECT_EQ(Errors(OneRod("{radius_m: 0.1, mass_kg: 1}") +
                   "contact: {friction_combine: mean, friction: 1}\ninertia: box\n"
                   "damping_law: none\nallow_disconnected: maybe\ngravity_m_per_s2: -9.81\n"),
            "robot.yaml:7:29: error: contact.friction_combine cannot be \"mean\" (one of: product, "
            "geometric_mean, minimum, maximum)\n"
            "robot.yaml:7:35: error: unknown key \"friction\" in contact (did you mean "
            "\"friction_combine\" or \"friction_law\"?)\n"
            "robot.yaml:8:10: error: inertia cannot be \"box\" (one of: exact, bounding_box)\n"
            "robot.yaml:9:14: error: damping_law cannot be \"none\" (one of: exact, clamped)\n"
            "robot.yaml:10:21: error: allow_disconnected must be true or false, got \"maybe\"\n"
            "robot.yaml:11:19: error: gravity_m_per_s2 must be a list of 3 numbers, got a text\n");
}

TEST(ModelErrors, BasesAreModelsThatExist) {
  EXPECT_EQ(Errors("base: [a]\n"),
            "robot.yaml:4:7: error: base must be the name of a file of kind model\n");
  EXPECT_EQ(Errors("base: /no/such/file.yaml\n"),
            "robot.yaml:4:7: error: base: there is no file /no/such/file.yaml (paths are relative "
            "to the folder of this file)\n");
  EXPECT_EQ(Errors("base: ModelErrors.BasesAreModelsThatExist.yaml\n"),
            "robot.yaml:4:7: error: base files refer to each other in a circle: robot.yaml\n");
  EXPECT_NE(Errors("base: " TAUT_SOURCE_DIR "/share/experiments/push_20n.yaml\n")
                .find("kind must be model, got experiment"),
            std::string::npos);
  EXPECT_EQ(
      Errors("base: " TAUT_SOURCE_DIR
             "/share/models/rod.yaml\nparameters: {length_m: 2, more: 3}\nnodes: {a: [0, 0, 0]}\n"),
      TAUT_SOURCE_DIR
      "/share/models/rod.yaml:16:14: error: there is no node \"back\" (one of: a)\n" TAUT_SOURCE_DIR
      "/share/models/rod.yaml:16:20: error: there is no node \"front\" (one of: a)\n");
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
            "robot.yaml:6:39: error: pairs needs one of nodes, each, route\n"
            "robot.yaml:6:40: error: unknown key \"node\" in pairs (did you mean \"nodes\"?)\n"
            "robot.yaml:7:41: error: rod.radius_m must be positive, got -1\n"
            "robot.yaml:7:101: error: cable.stiffness_n_per_m must be positive, got 0\n");
}

}  // namespace
}  // namespace taut
