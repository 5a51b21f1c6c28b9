// Features of NTRT's YAML; import_ntrt_test.py tests whole structures.
#include <cmath>

#include "import_ntrt/ntrt_yaml.h"
#include "mechanics/mass_properties.h"
#include "taut/statics.h"

namespace taut {
namespace {

TEST_F(NtrtYaml, UnitsAndAxesBecomeTauts) {
  const RobotSpec robot = Robot(kTwoRods + kBuilders);
  ASSERT_EQ(robot.def.bodies.size(), 2u);
  ASSERT_EQ(robot.def.cables.size(), 2u);
  // NTRT's y axis is up; NTRT's x is taut's y
  EXPECT_EQ(robot.def.nodes[3].position_m.y, 0.3);
  EXPECT_EQ(robot.def.nodes[3].position_m.z, 0.4);
  const double pi = std::acos(-1.0);
  EXPECT_NEAR(robot.def.bodies[0].mass_kg, 2 * pi * 0.04 * 4, 1e-12);
  EXPECT_EQ(robot.def.capsules[0].radius_m, 0.02);
  EXPECT_EQ(robot.def.capsules[0].material.kinetic_friction, 1.0);
  EXPECT_EQ(robot.def.capsules[0].material.restitution, 0.2);
  const CableDef& cable = robot.def.cables[0];
  EXPECT_EQ(cable.stiffness_n_per_m, 100.0);
  EXPECT_EQ(cable.damping_n_s_per_m, 10.0);
  EXPECT_EQ(cable.damping_law, DampingLaw::kClamped);
  EXPECT_NEAR(CableLength(cable), 0.26, 1e-15);  // from surface to surface
  EXPECT_NEAR(CableTension(cable), 5.0, 1e-12);
  EXPECT_EQ(cable.actuator.max_speed_m_per_s, 10.0);
  EXPECT_EQ(cable.actuator.max_force_n, 100.0);
  EXPECT_NEAR(cable.actuator.min_rest_length_m, 0.01, 1e-15);
  EXPECT_NEAR(cable.actuator.min_length_m, 0.01, 1e-15);
  EXPECT_EQ(robot.def.friction_combine, CombineRule::kProduct);
  EXPECT_EQ(robot.def.restitution_combine, CombineRule::kProduct);
  EXPECT_EQ(robot.def.friction_law, FrictionLaw::kCone);
  // Bullet treats a single cylinder exactly; only compounds have the inertia of boxes.
  const Inertia inertia = robot.def.bodies[0].inertia_kg_m2;
  const double m = robot.def.bodies[0].mass_kg;
  EXPECT_NEAR(inertia.zz, m * 0.02 * 0.02 / 2, 1e-15);
  EXPECT_NEAR(inertia.xx, m * (3 * 0.02 * 0.02 + 0.4 * 0.4) / 12, 1e-14);
  EXPECT_EQ(warnings_, "");
}

TEST_F(NtrtYaml, DefaultsAreThoseOfItsReader) {
  const RobotSpec robot = Robot(kTwoRods);
  EXPECT_EQ(robot.def.capsules[0].radius_m, 0.05);
  EXPECT_NEAR(robot.def.bodies[0].mass_kg, std::acos(-1.0) * 0.25 * 4, 1e-12);
  EXPECT_EQ(robot.def.cables[0].stiffness_n_per_m, 1000.0);
  EXPECT_EQ(CableTension(robot.def.cables[0]), 0.0);
}

TEST_F(NtrtYaml, TheLastBuilderThatMatchesBuilds) {
  const RobotSpec robot =
      Robot(kTwoRods + kBuilders + "  rod rod: {class: tgRodInfo, parameters: {radius: 0.3}}\n");
  EXPECT_NEAR(robot.def.capsules[0].radius_m, 0.03, 1e-15);
}

TEST_F(NtrtYaml, AFileThatIncludesOthersHasTheLastWord) {
  Write("part.yaml", kTwoRods + kBuilders);
  const RobotSpec robot = Robot(
      "substructures:\n"
      "  p/q: {path: part.yaml, offset: [0, 0, 10]}\n"
      "bond_groups:\n"
      "  string: {p/q/node_node: [[a, c], [b, d]]}\n"
      "builders:\n"
      "  rod: {class: tgRodInfo, parameters: {radius: 0.1}}\n");
  ASSERT_EQ(robot.def.bodies.size(), 4u);
  EXPECT_EQ(robot.def.capsules[3].radius_m, 0.01);
  EXPECT_EQ(robot.def.cables.size(), 6u);
  // One part, placed twice
  EXPECT_NE(text_.find("{part: part, name: q, at_m: [1, 0, 0]}"), text_.npos) << text_;
  EXPECT_NE(text_.find("- tags: [string, p, q, p-q]"), text_.npos) << text_;
}

TEST_F(NtrtYaml, AttributesOfASubstructureAddUp) {
  Write("part.yaml", "nodes: {a: [0, 0, 0], b: [0, 4, 0]}\npair_groups: {rod: [[a, b]]}\n");
  // Two keys: rotation about NTRT's z from y to -x, then scaling by 2, both about the center (0, 2,
  // 0); then translation.
  const RobotSpec robot = Robot(
      "substructures:\n"
      "  p: {path: part.yaml, scale: 2}\n"
      "  o/p: {offset: [10, 0, 0], translation: [1, 2, 3]}\n"
      "  o: {path: part.yaml, rotation: {axis: [0, 0, 2], angle: 90, reference: [0, 0, 0]}}\n");
  const auto at = [&](const std::string& name) {
    for (const NodeDef& node : robot.def.nodes) {
      if (node.name == name) return node.position_m;
    }
    return Vec3{NAN, NAN, NAN};
  };
  EXPECT_NEAR(at("p.a").y, 1.1, 1e-14);
  EXPECT_NEAR(at("p.a").z, 0.0, 1e-14);
  EXPECT_NEAR(at("p.b").z, 0.8, 1e-14);
  EXPECT_NEAR(at("p.b").x, 0.3, 1e-14);
  EXPECT_NEAR(at("o.b").y, 0.1 - 0.4, 1e-14);
  EXPECT_NEAR(at("o.b").z, 0.2, 1e-14);
  EXPECT_NE(text_.find("rotate: {axis: x, angle_rad: pi / 2}"), text_.npos) << text_;
}

// A builder's words match the tags of a pair and the name of its structure.
TEST_F(NtrtYaml, PairsHaveTheNameOfTheirStructure) {
  Write("part.yaml", kTwoRods);
  const RobotSpec robot = Robot(
      "substructures: {p/q: {path: part.yaml, offset: [0, 0, 10]}}\n"
      "bond_groups: {string: {p/q/node_node: [[a, a]]}}\n"
      "builders: {q rod: {class: tgRodInfo, parameters: {radius: 0.3}}}\n");
  ASSERT_EQ(robot.def.capsules.size(), 4u);
  int thick = 0;
  for (const CapsuleDef& rod : robot.def.capsules) {
    EXPECT_EQ(rod.radius_m > 0.04, rod.name.find("q.") == rod.name.npos) << rod.name;
    thick += rod.radius_m > 0.04 ? 1 : 0;
  }
  EXPECT_EQ(thick, 2);
}

// If NTRT's tags alone would match several of taut's builders, the import adds tags.
TEST_F(NtrtYaml, TagsThatDoNotTellGetOthersBeside) {
  std::string yaml = kTwoRods;
  yaml.replace(yaml.find("rod: [[a, b], [c, d]]"), 21, "rod: [[a, b]]\n  rod thick: [[c, d]]");
  const RobotSpec robot =
      Robot(yaml + "builders: {thick: {class: tgRodInfo, parameters: {radius: 1}}}\n");
  EXPECT_EQ(robot.def.capsules[0].radius_m, 0.05);
  EXPECT_EQ(robot.def.capsules[1].radius_m, 0.1);
  EXPECT_NE(text_.find("match: rod_1"), text_.npos) << text_;
  EXPECT_NE(text_.find("match: thick"), text_.npos) << text_;
}

TEST_F(NtrtYaml, ItsOwnSumsAreThoseOfTheModel) {
  const RobotSpec robot = Robot(
      "nodes: {a: [0, 0, 0], b: [0, 4, 0], ball: [0, 4, 0], c: [3, 0, 0], d: [3, 5, 0]}\n"
      "pair_groups: {rod: [[a, b]], box: [[c, d]], string: [[b, c]]}\n"
      "builders:\n"
      "  ball: {class: tgSphereInfo, parameters: {radius: 1.5, density: 3}}\n"
      "  box: {class: tgBoxInfo, parameters: {width: 0.5, height: 0.25, density: 7}}\n"
      "  string: {class: tgBasicActuatorInfo, parameters: {moveCablePointBToEdge: off}}\n");
  double mass_kg = 0.0;
  for (const BodyDef& body : robot.def.bodies) mass_kg += body.mass_kg;
  EXPECT_NEAR(counts_.mass_kg, mass_kg, 1e-12 * mass_kg);
  EXPECT_NEAR(counts_.size_m, 0.5, 1e-15);
  EXPECT_EQ(counts_.bodies, 2);
}

// NTRT treats normals within 1e-5 of each other as equal: a smaller tilt is preserved.
TEST_F(NtrtYaml, BondsLeaveSmallTiltsAlone) {
  const auto part = [](const std::string& height) {
    return "nodes: {a: [0, 0, 0], b: [4, " + height +
           ", 0], c: [0, 0, 4], d: [0, 3, 0], e: [4, 3, 0], f: [0, 3, 4]}\n"
           "pair_groups: {rod: [[a, d], [b, e], [c, f]], string: [[a, b], [b, c], [c, a]]}\n";
  };
  const std::string top =
      "substructures: {p: {path: p.yaml}, q: {path: q.yaml}}\n"
      "bond_groups: {string: {p/q/node_edge: [[d, a/b], [e, b/c], [f, c/a]]}}\n";
  Write("p.yaml", part("0"));
  for (const auto& [height, leans] : {std::pair("3.9e-5", true), std::pair("4.1e-5", false)}) {
    Write("q.yaml", part(height));
    const RobotSpec robot = Robot(top);
    const Vec3 a = robot.def.nodes[6].position_m, b = robot.def.nodes[7].position_m;
    ASSERT_EQ(robot.def.nodes[7].name, "q.b");
    EXPECT_EQ(std::fabs(b.z - a.z) > 1e-6, leans) << height;
  }
}

// The normals are opposite, along x: half a turn about the line through the first two points.
TEST_F(NtrtYaml, BondsTurnPlanesOver) {
  Write("part.yaml",
        "nodes: {a: [0, 0, 0], b: [0, 4, 0], c: [0, 0, 4], d: [3, 0, 0], e: [3, 4, 0], f: [3, 0, "
        "4]}\n"
        "pair_groups: {rod: [[a, d], [b, e], [c, f]], string: [[a, b], [b, c], [c, a], [d, e]]}\n");
  const RobotSpec robot = Robot(
      "substructures: {p/q: {path: part.yaml}}\n"
      "bond_groups: {string: {p/q/node_edge: [[d, a/b], [e, c/a], [f, b/c]]}}\n");
  const auto rod = [&](const std::string& name) {
    for (const CapsuleDef& is : robot.def.capsules) {
      if (is.name == name) return is.to_m.y - is.from_m.y;  // NTRT's x
    }
    return 0.0;
  };
  EXPECT_NEAR(rod("p.a-d"), 0.3, 1e-12);
  EXPECT_NEAR(rod("q.a-d"), -0.3, 1e-12);
}

// At a node of a short box and a long rod, a cable ends on the box.
TEST_F(NtrtYaml, CablesEndOnWhatHasTheNearestCentre) {
  const RobotSpec robot = Robot(
      "nodes: {a: [0, 0, 0], b: [0, 2, 0], c: [0, 0, 4], d: [3, 0, 0], e: [3, 4, 0]}\n"
      "pair_groups: {box: [[a, b]], rod: [[a, c], [d, e]], string: [[a, d]]}\n"
      "builders: {box: {class: tgBoxInfo, parameters: {width: 0.25}}}\n");
  EXPECT_NEAR(CableLength(robot.def.cables[0]), 0.3 - 0.025 - 0.05, 1e-12);
}

TEST_F(NtrtYaml, CablesMayEndAtNodesOnOneSideOnly) {
  const RobotSpec both = Robot(kTwoRods + kBuilders.substr(0, kBuilders.size() - 3) +
                               ", moveCablePointAToEdge: false, moveCablePointBToEdge: no}}\n");
  EXPECT_NEAR(CableLength(both.def.cables[0]), 0.3, 1e-15);
  const RobotSpec one = Robot(kTwoRods + kBuilders.substr(0, kBuilders.size() - 3) +
                              ", moveCablePointAToEdge: false}}\n");
  EXPECT_NEAR(CableLength(one.def.cables[0]), 0.28, 1e-15);
  EXPECT_EQ(one.def.cables[0].attachments[0].position_m.y, 0.0);
  EXPECT_NEAR(one.def.cables[0].attachments[1].position_m.y, 0.28, 1e-15);
}

TEST_F(NtrtYaml, ARotationTurnsTheEndsAboutTheirRods) {
  const RobotSpec robot = Robot(kTwoRods + kBuilders.substr(0, kBuilders.size() - 3) +
                                ", rotation: 1.5707963267948966}}\n");
  // About NTRT's y, from x to -z at a, from -x to z at c.
  const CableDef& cable = robot.def.cables[0];
  EXPECT_NEAR(cable.attachments[0].position_m.x, -0.02, 1e-14);
  EXPECT_NEAR(cable.attachments[0].position_m.y, 0.0, 1e-14);
  EXPECT_NEAR(cable.attachments[1].position_m.x, 0.02, 1e-14);
  EXPECT_NEAR(cable.attachments[1].position_m.y, 0.3, 1e-14);
}

TEST_F(NtrtYaml, BoxesHaveHalfExtentsAndTheirOwnTurn) {
  const auto box = [](const std::string& to) {
    return "nodes: {a: [0, 0, 0], b: " + to +
           "}\npair_groups: {box: [[a, b]]}\nbuilders:\n"
           "  box: {class: tgBoxInfo, parameters: {width: 0.5, height: 1, density: 3}}\n";
  };
  // Vertical: the width is along NTRT's x, taut's y.
  const RobotSpec up = Robot(box("[0, 4, 0]"));
  EXPECT_NEAR(up.def.bodies[0].mass_kg, 3 * 4 * 1 * 2, 1e-12);
  const double m = up.def.bodies[0].mass_kg;
  EXPECT_NEAR(up.def.bodies[0].inertia_kg_m2.zz, m / 12 * (0.1 * 0.1 + 0.2 * 0.2), 1e-14);
  EXPECT_NEAR(up.def.bodies[0].inertia_kg_m2.yy, m / 12 * (0.4 * 0.4 + 0.2 * 0.2), 1e-14);
  // Along NTRT's x, taut's y: rotated from vertical about NTRT's -z, so that the width points down.
  const RobotSpec level = Robot(box("[4, 0, 0]"));
  EXPECT_NEAR(level.def.bodies[0].inertia_kg_m2.zz, m / 12 * (0.4 * 0.4 + 0.2 * 0.2), 1e-14);
  EXPECT_NEAR(level.def.bodies[0].inertia_kg_m2.xx, m / 12 * (0.4 * 0.4 + 0.1 * 0.1), 1e-14);
  // Oblique: only a convex shape with corners represents it. Its inertia about the axis is the
  // same.
  const RobotSpec tilted = Robot(box("[2, 2, 2.8284271247461903]"));
  EXPECT_EQ(tilted.def.hulls.size(), 1u) << text_;
  EXPECT_NEAR(tilted.def.bodies[0].mass_kg, m, 1e-10);
  const Vec3 moments = PrincipalMoments(tilted.def.bodies[0].inertia_kg_m2);
  EXPECT_NEAR(moments.x + moments.y + moments.z, m / 6 * (0.4 * 0.4 + 0.1 * 0.1 + 0.2 * 0.2),
              1e-12);
}

TEST_F(NtrtYaml, SolidsInOnePlaceAreOneBody) {
  const RobotSpec robot = Robot(
      "nodes: {a: [0, 0, 0], b: [0, 4, 0], ball: [0, 4, 0], c: [0, 4, 0], d: [4, 4, 0]}\n"
      "pair_groups: {rod: [[a, b], [c, d]]}\n"
      "builders: {ball: {class: tgSphereInfo, parameters: {radius: 1}}}\n");
  ASSERT_EQ(robot.def.bodies.size(), 1u);
  EXPECT_EQ(robot.def.spheres.size(), 1u);
  EXPECT_EQ(counts_.nodes, 5);
  EXPECT_EQ(counts_.spheres, 1);
}

TEST_F(NtrtYaml, WhatAlmostMeetsIsNotOneBody) {
  for (const auto& [height, bodies] : {std::pair("4.000001", 2u), std::pair("4.000000001", 1u)}) {
    const std::string c = height;
    const RobotSpec robot = Robot("nodes: {a: [0, 0, 0], b: [0, 4, 0], c: [0, " + c +
                                  ", 0], d: [4, 4, 0]}\npair_groups: {rod: [[a, b], [c, d]]}\n");
    EXPECT_EQ(robot.def.bodies.size(), bodies) << c;
  }
}

TEST_F(NtrtYaml, CablesThatAreLeftAwayAreNotCounted) {
  std::string yaml = kTwoRods;
  yaml.replace(yaml.find("[b, d]]"), 7, "[b, d], [a, b]]");
  const RobotSpec robot = Robot(yaml + kBuilders);
  EXPECT_EQ(robot.def.cables.size(), 2u);
  EXPECT_EQ(counts_.cables, 2);
  EXPECT_EQ(warnings_,
            "s.yaml:8:28: warning: another pair already joins these two nodes; both are built, as "
            "in NTRT (leave out one of them)\n"
            "s.yaml:8:28: warning: both ends of the cable are on the same body, so it has no "
            "effect and is left out (remove the pair)\n");
}

TEST_F(NtrtYaml, ABodyWithoutMassStandsStill) {
  std::string yaml = kTwoRods;
  yaml.replace(yaml.find("rod: [[a, b], [c, d]]"), 21, "rod: [[a, b]]\n  fixed: [[c, d]]");
  const RobotSpec robot =
      Robot(yaml + "builders: {fixed: {class: tgRodInfo, parameters: {density: 0}}}\n");
  ASSERT_EQ(robot.def.bodies.size(), 2u);
  EXPECT_FALSE(robot.def.bodies[0].fixed);
  EXPECT_TRUE(robot.def.bodies[1].fixed);
}

TEST_F(NtrtYaml, ALineWithPercentEndsTheFileForNtrtAlone) {
  const std::string yaml = kTwoRods + "% a remark\n" + kBuilders;
  EXPECT_EQ(Robot(yaml).def.capsules[0].radius_m, 0.02);
  EXPECT_EQ(
      warnings_,
      "s.yaml:9:1: warning: a line that begins with % is read as a comment; NTRT ends the file "
      "there and ignores the rest (begin comments with #; --like_ntrt ignores the rest, too)\n");
  const RobotSpec lost = Robot(yaml, {0.1, true, ""});
  EXPECT_EQ(lost.def.capsules[0].radius_m, 0.05);
  EXPECT_EQ(lost.def.friction_law, FrictionLaw::kAlongSlip);
  EXPECT_EQ(warnings_,
            "s.yaml:9:1: warning: a line that begins with % ends the file, as in NTRT: the rest is "
            "ignored (begin comments with #)\n");
}

TEST_F(NtrtYaml, ADirectiveAtTheHeadOfAFileIsOne) {
  for (const bool like_ntrt : {false, true}) {
    const RobotSpec robot = Robot("\n# YAML\n%YAML 1.2\n---\n" + kTwoRods, {0.1, like_ntrt, ""});
    EXPECT_EQ(robot.def.bodies.size(), 2u);
    EXPECT_EQ(warnings_, "");
  }
}

TEST_F(NtrtYaml, WhatNtrtPassesOverIsSaid) {
  std::string yaml = kTwoRods + kBuilders;
  yaml.replace(yaml.find("[[a, c], [b, d]]"), 16, "[[a, c], [b, d], [c, a]]\n  tendon: [[a, d]]");
  const RobotSpec robot = Robot(yaml);
  EXPECT_EQ(robot.def.cables.size(), 3u);
  EXPECT_EQ(counts_.duplicate_pairs, 1);
  EXPECT_EQ(counts_.ignored_pairs, 1);
  EXPECT_EQ(warnings_,
            "s.yaml:8:28: warning: another pair already joins these two nodes; both are built, as "
            "in NTRT (leave out one of them)\n"
            "s.yaml:9:12: warning: no builder has the tag \"tendon\", so the pair is left out, as "
            "in NTRT "
            "(the tags rod, string, box and sphere have default builders)\n");
}

TEST_F(NtrtYaml, WhatModelsDoNotHaveIsListed) {
  Robot(kTwoRods +
        "builders:\n"
        "  rod: {class: tgRodInfo, parameters: {roll_friction: 0.1}}\n"
        "  string: {class: tgKinematicContactCableInfo, parameters: {history: 1, radius: 2, "
        "motor_friction: 3, motor_inertia: 4, back_drivable: 1}}\n");
  ASSERT_EQ(dropped_.size(), 4u);
  EXPECT_EQ(dropped_[0], "history of string: a run records every cable");
  EXPECT_EQ(dropped_[1], "roll_friction of rod: rolling friction is not modeled");
  EXPECT_EQ(dropped_[2].find("radius, motor_friction, motor_inertia and back_drivable of string"),
            0u);
  EXPECT_EQ(dropped_[3].find("contact of string"), 0u);
}

TEST_F(NtrtYaml, LeastRestLengthsAboveTheStartAreLowered) {
  const RobotSpec robot = Robot(kTwoRods +
                                "builders: {string: {class: tgBasicActuatorInfo, parameters: "
                                "{pretension: 1950, min_rest_length: 0.2}}}\n");
  const double rest_m = robot.def.cables[0].rest_length_m;
  EXPECT_NEAR(rest_m, 0.005, 1e-12);
  EXPECT_LE(robot.def.cables[0].actuator.min_rest_length_m, rest_m);
  EXPECT_NEAR(robot.def.cables[0].actuator.min_rest_length_m, rest_m, 1e-4);
  EXPECT_NE(warnings_.find("below min_rest_length, which is 0.2"), warnings_.npos) << warnings_;
}

}  // namespace
}  // namespace taut
