// Errors in NTRT's YAML files
#include "import_ntrt/ntrt_yaml.h"

namespace taut {
namespace {

TEST_F(NtrtYaml, AllThatIsWrongIsSaidAtOnce) {
  EXPECT_EQ(
      Complaints("nodes:\n"
                 "  a: [0, 0]\n"
                 "  b: [0, 1, x]\n"
                 "  c: [1, 0, 0]\n"
                 "pair_groups:\n"
                 "  rod: [[a, b, c], [a, d], [a, e.b]]\n"
                 "builders:\n"
                 "  rod: {class: tgRotInfo}\n"
                 "  string: {parameters: {}}\n"
                 "  box: {class: tgBoxInfo, parameters: {widht: 1, density: -1, restitution: 2, "
                 "height: 0}}\n"
                 "  wire: {class: tgBasicActuatorInfo, parameters: {stiffness: soft, "
                 "moveCablePointAToEdge: maybe, radius: 1}}\n"
                 "bonds: {}\n"),
      "s.yaml:2:6: error: a must be [x, y, z]\n"
      "s.yaml:3:13: error: b must be a number, not \"x\"\n"
      "s.yaml:6:9: error: a pair must be two names, such as [bottom, top]\n"
      "s.yaml:6:20: error: there is no node \"d\" (did you mean \"a\"?)\n"
      "s.yaml:6:28: error: there is no substructure \"e\" for the node \"e.b\"\n"
      "s.yaml:8:16: error: there is no class \"tgRotInfo\" (did you mean \"tgRodInfo\"?)\n"
      "s.yaml:9:3: error: the builder \"string\" has no class (such as class: tgRodInfo)\n"
      "s.yaml:10:40: error: tgBoxInfo has no parameter \"widht\" (did you mean "
      "\"width\"?)\n"
      "s.yaml:10:59: error: density must not be negative\n"
      "s.yaml:10:76: error: restitution must be within 0..1\n"
      "s.yaml:10:87: error: height must be positive\n"
      "s.yaml:11:62: error: stiffness must be a number, not \"soft\"\n"
      "s.yaml:11:91: error: moveCablePointAToEdge must be true or false\n"
      "s.yaml:11:98: error: tgBasicActuatorInfo has no parameter \"radius\" (one of: "
      "stiffness, damping, pretension, history, max_tension, target_velocity, "
      "min_actual_length, min_rest_length, rotation, moveCablePointAToEdge, "
      "moveCablePointBToEdge)\n"
      "s.yaml:12:1: error: unknown key \"bonds\" (one of: nodes, pair_groups, builders, "
      "substructures, bond_groups)\n");
}

TEST_F(NtrtYaml, SizesHaveLimitsThatAreSaidOnce) {
  std::string nodes = "nodes:\n";
  for (int i = 0; i <= 20'000; ++i) nodes += "  n" + std::to_string(i) + ": [0, 0, 0]\n";
  EXPECT_EQ(Complaints(nodes), "s.yaml:20002:3: error: the structure has more than 20000 nodes\n");
  std::string pairs = "nodes: {a: [0, 0, 0], b: [0, 1, 0]}\npair_groups:\n  string:\n";
  for (int i = 0; i < 20'010; ++i) pairs += "    - [a, b]\n";
  EXPECT_EQ(Complaints(pairs), "s.yaml:20004:7: error: the structure has more than 20000 pairs\n");

  Write("part.yaml", kTwoRods);
  std::string parts = "substructures:\n";
  for (int i = 1'000; i < 3'200; ++i) {  // 100 per key: YAML keys have at most 1024 characters
    parts += std::string(i % 100 == 0 ? "  p" : "/p") + std::to_string(i) +
             (i % 100 == 99 ? ": {path: part.yaml}\n" : "");
  }
  EXPECT_EQ(Complaints(parts),
            "s.yaml:21:611: error: the structure has more than 2000 substructures\n");
  for (int i = 0; i < 40; ++i) {
    Write(std::to_string(i) + ".yaml",
          "substructures: {p: {path: " + std::to_string(i + 1) + ".yaml}}\n");
  }
  EXPECT_EQ(Complaints("substructures: {p: {path: 0.yaml}}\n"),
            "30.yaml:1:27: error: files include files more than 32 levels deep\n");
}

TEST_F(NtrtYaml, BondsAndSubstructuresAreChecked) {
  Write("part.yaml", kTwoRods);
  Write("self.yaml", "substructures: {me: {path: self.yaml}}\n");
  EXPECT_EQ(
      Complaints("substructures:\n"
                 "  p/q: {path: part.yaml, rotation: {axis: [0, 0, 0], angle: 1}, scale: 0}\n"
                 "  r: {translation: [0, 0, 1]}\n"
                 "  s: {path: nowhere.yaml}\n"
                 "  t: {path: self.yaml, turn: 1}\n"
                 "bond_groups:\n"
                 "  string:\n"
                 "    p/q/node_face: [[a, a]]\n"
                 "    p/node_node: [[a, a]]\n"
                 "    p/x/node_node: [[a, a]]\n"
                 "    q/p/node_edge: [[a, b/d]]\n"
                 "    p/q/node_edge: [[a, b/d], [a/c, b/d], [b, e/d], [c, a/b], [d, c/d]]\n"
                 "    string: []\n"
                 "  p/q/node_node: {q/p/node_node: []}\n"),
      "s.yaml:2:43: error: the axis of a rotation must not be zero\n"
      "s.yaml:2:72: error: scale must be positive\n"
      "s.yaml:3:3: error: there is no substructure \"r\" (one of its entries needs a `path`)\n"
      "s.yaml:4:13: error: path: there is no file \"nowhere.yaml\" (paths are relative to the "
      "folder of the file that contains them)\n"
      "s.yaml:5:24: error: unknown key \"turn\" (one of: path, rotation, translation, scale, "
      "offset)\n"
      "s.yaml:8:5: error: \"p/q/node_face\" does not end with a kind of bond (expected node_node "
      "or node_edge, such as t1/t2/node_node)\n"
      "s.yaml:9:5: error: a bond must join at least two substructures (such as t1/t2/node_node)\n"
      "s.yaml:10:5: error: there is no substructure \"x\"\n"
      "s.yaml:11:20: error: a node_edge bond needs at least three entries\n"
      "s.yaml:12:31: error: a node_edge bond must join a node and an edge (such as [top1, "
      "bottom1/bottom2])\n"
      "s.yaml:12:43: error: there is no node \"e\" (did you mean \"a\"?)\n"
      "s.yaml:13:5: error: a tag contains another tag instead of a bond (put bonds such as "
      "t1/t2/node_node into a tag, or tags into a bond)\n"
      "s.yaml:14:19: error: a bond cannot contain another bond (put bonds such as t1/t2/node_node "
      "into a tag, or tags into a bond)\n"
      "self.yaml:1:28: error: the file includes itself\n");
}

TEST_F(NtrtYaml, EdgesAreCablesThatSpanAPlane) {
  Write("part.yaml",
        "nodes: {a: [0, 0, 0], b: [4, 0, 0], c: [0, 0, 4], d: [0, 3, 0], e: [4, 3, 0], f: [0, 3, "
        "4]}\n"
        "pair_groups: {rod: [[a, d], [b, e], [c, f]], string: [[a, b], [b, c], [c, a], [d, e]]}\n");
  const auto bonds = [](const std::string& lines) {
    return "substructures: {p/q: {path: part.yaml}}\nbond_groups: {string: {p/q/node_edge: " +
           lines + "}}\n";
  };
  EXPECT_EQ(Complaints(bonds("[[d, a/d], [e, b/c], [f, c/a]]")),
            "s.yaml:2:40: error: the edge of a node_edge bond must be a cable, not a solid\n");
  EXPECT_EQ(Complaints(bonds("[[d, a/b], [e, a/b], [f, c/a]]")),
            "s.yaml:2:40: error: the first three node_edge bonds lie on a line (they must span a "
            "plane in both structures)\n"
            "s.yaml:2:50: warning: no cable runs along this edge, so the bond adds two cables and "
            "removes none, as in NTRT\n");
  Diagnostics found;
  EXPECT_TRUE(Import(bonds("[[d, a/b], [e, b/c], [f, a/f]]"), found));
  EXPECT_EQ(Shown(found),
            "s.yaml:2:60: warning: no cable runs along this edge, so the bond adds two cables and "
            "removes none, as in NTRT\n");
}

TEST_F(NtrtYaml, EarlierBondsGoWithWhatIsMoved) {
  Write("part.yaml",
        "nodes: {a: [0, 0, 0], b: [4, 0, 0], c: [0, 0, 4], d: [0, 3, 0], e: [4, 3, 0], f: [0, 3, "
        "4]}\n"
        "pair_groups: {rod: [[a, d], [b, e], [c, f]], string: [[a, b], [b, c], [c, a]]}\n");
  Diagnostics found;
  const auto import = Import(
      "substructures: {p/q: {path: part.yaml}}\nbond_groups:\n  string:\n"
      "    p/q/node_node: [[d, d]]\n"
      "    p/q/node_edge: [[d, a/b], [e, b/c], [f, c/a]]\n",
      found);
  EXPECT_TRUE(import);
  EXPECT_EQ(Shown(found),
            "s.yaml:5:20: warning: this bond moves \"q\", to which earlier bonds are attached: "
            "NTRT leaves the ends of these bonds behind, taut moves them, too (list this bond "
            "before the others)\n");
}

TEST_F(NtrtYaml, WhatNtrtCannotBuildIsRefused) {
  EXPECT_EQ(Complaints("nodes: {a: [0, 0, 0], b: [0, 1, 0]}\npair_groups: {tendon: [[a, b]]}\n")
                .find("s.yaml:0:0"),
            std::string::npos);
  EXPECT_NE(Complaints("nodes: {a: [0, 0, 0], b: [0, 1, 0]}\npair_groups: {tendon: [[a, b]]}\n")
                .find("s.yaml: error: the builders of this structure build no solid"),
            std::string::npos);
  EXPECT_NE(
      Complaints("nodes: {a: [0, 0, 0], b: [0, 1, 0], c: [1, 1, 1]}\n"
                 "pair_groups: {rod: [[a, b]], string: [[b, c]]}\n")
          .find("s.yaml:1:37: error: a cable ends at the node \"c\", where there is no solid"),
      std::string::npos);
  EXPECT_NE(Complaints("nodes: {a: [0, 0, 0], b: [0, 0, 0]}\npair_groups: {rod: [[a, b]]}\n")
                .find("s.yaml:2:21: error: both ends of a rod or box are at the same place"),
            std::string::npos);
  EXPECT_NE(Complaints("substructures: {}\n").find("s.yaml:1:1: error: the structure has no nodes"),
            std::string::npos);
  EXPECT_NE(Complaints("[]\n").find("an NTRT structure must be a map, not a list"),
            std::string::npos);
  EXPECT_NE(Complaints("nodes: [\n").find("error: the file is not valid YAML"), std::string::npos);
}

TEST_F(NtrtYaml, NamesWithoutAWordAreRefused) {
  // Such a substructure would match any name, and such a builder would build every pair.
  Write("part.yaml", kTwoRods);
  EXPECT_EQ(Complaints("substructures: {\" \": {path: part.yaml}, p/: {path: part.yaml}}\n"),
            "s.yaml:1:17: error: a substructure needs a name\n"
            "s.yaml:1:41: error: a substructure needs a name\n");
  EXPECT_EQ(Complaints("nodes: {a: [0, 0, 0], b: [0, 1, 0]}\npair_groups: {rod: [[a, b]]}\n"
                       "builders: {\" \": {class: tgBasicActuatorInfo}}\n"),
            "s.yaml:3:12: error: a builder needs a tag\n");
}

TEST_F(NtrtYaml, ScalesThatOverflowAreRefused) {
  Write("part.yaml", kTwoRods);
  std::string below = "part.yaml";
  for (int i = 0; i < 30; ++i) {
    const std::string file = "scaled_" + std::to_string(i) + ".yaml";
    Write(file, "substructures: {p: {path: " + below + ", scale: 1e12}}\n");
    below = file;
  }
  EXPECT_NE(
      Complaints("substructures: {p: {path: " + below + "}}\n").find("move this node too far"),
      std::string::npos);
}

TEST_F(NtrtYaml, StructuresThatWouldTakeHoursAreRefused) {
  // Each bond would search all cables once for each other bond.
  constexpr int kNodes = 600;
  std::string nodes = "nodes:\n", cables = "pair_groups:\n  string:\n", bonds;
  for (int i = 0; i < kNodes; ++i) {
    const std::string name = "n" + std::to_string(i), next = "n" + std::to_string((i + 1) % kNodes);
    nodes += "  " + name + ": [" + std::to_string(i) + ", " + std::to_string(i * i % 7) + ", " +
             std::to_string(i * i % 5) + "]\n";
    cables += "    - [" + name + ", " + next + "]\n";
    bonds += "      - [" + name + ", " + name + "/" + next + "]\n";
  }
  Write("part.yaml", nodes + cables);
  EXPECT_NE(Complaints("substructures: {p/q: {path: part.yaml}}\n"
                       "bond_groups:\n  string:\n    p/q/node_edge:\n" +
                       bonds)
                .find("s.yaml: error: the structure is too large: "),
            std::string::npos);
}

}  // namespace
}  // namespace taut
