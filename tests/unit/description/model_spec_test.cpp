// Model files: values read
#include <gtest/gtest.h>

#include <cmath>

#include "math/vec.h"
#include "taut/statics.h"
#include "unit/description/model_fixture.h"

namespace taut {
namespace {

TEST(Model, PartsThatShareNodesAreOneBody) {
  const RobotSpec robot = Good(
      "nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [1, 1, 0], d: [0, 0, 2], tip: {at_m: [0, 0, 3], "
      "fixed_to: d}}\n"
      "pairs: [{nodes: [a, b], tags: [rod]}, {nodes: [b, c], tags: [rod]}, {nodes: [a, d], tags: "
      "[cable]}]\n"
      "builders:\n"
      "  - {match: rod, rod: {radius_m: 0.01, density_kg_per_m3: 1000}}\n"
      "  - {match: c, sphere: {radius_m: 0.1, density_kg_per_m3: 1000}}\n"
      "  - {match: c, point_mass: {mass_kg: 3}}\n"
      "  - {match: d, box: {size_m: [0.2, 0.4, 0.6], mass_kg: 2}}\n"
      "  - {match: cable, cable: {stiffness_n_per_m: 10, rest_length_m: 1}}\n");
  ASSERT_EQ(robot.def.bodies.size(), 2u);
  const double pi = std::acos(-1.0);
  EXPECT_NEAR(robot.def.bodies[0].mass_kg, 2 * pi * 1e-4 * 1000 + 4.0 / 3 * pi * 1e-3 * 1000 + 3,
              1e-12);
  EXPECT_EQ(robot.def.bodies[0].name, "a-b");  // the first rod's name
  EXPECT_EQ(robot.def.bodies[1].name, "d");
  EXPECT_NEAR(robot.def.bodies[1].inertia_kg_m2.xx, 2.0 / 12 * (0.16 + 0.36), 1e-15);
  EXPECT_EQ(robot.def.nodes[4].body, 1);  // tip is fixed to d
  EXPECT_EQ(robot.def.boxes[0].half_extents_m.z, 0.3);
  EXPECT_EQ(robot.def.cables[0].attachments[1].body, 1);
}

TEST(Model, AnchorsFixNodesOrWholeBodies) {
  const RobotSpec robot = Good(TwoRods("rest_length_m: 0.05", "  - {match: d, anchor: {}}\n"));
  EXPECT_FALSE(robot.def.bodies[0].fixed);
  EXPECT_TRUE(robot.def.bodies[1].fixed);
  const RobotSpec hanging = Good(
      "nodes: {hook: [0, 0, 1], ball: [0, 0, 0]}\npairs: [{nodes: [hook, ball], tags: [cable]}]\n"
      "builders:\n  - {match: hook, anchor: {}}\n  - {match: ball, sphere: {radius_m: 0.1, "
      "mass_kg: 1}}\n"
      "  - {match: cable, cable: {stiffness_n_per_m: 10, rest_length_m: 0.5, ends: surface}}\n");
  EXPECT_EQ(hanging.def.nodes[0].body, kWorld);
  EXPECT_EQ(hanging.def.cables[0].attachments[0].position_m.z,
            1.0);  // an end in the world has no surface
  EXPECT_DOUBLE_EQ(hanging.def.cables[0].attachments[1].position_m.z, 0.1);
}

// As in NTRT: perpendicular to the rod with the nearest center.
TEST(Model, CablesEndOnTheSurfaceOfRods) {
  const std::string more = "  - {match: d, sphere: {radius_m: 0.02, mass_kg: 1}}\n";
  const auto end = [&](const std::string& cable, std::size_t i, const std::string& spheres) {
    std::string yaml =
        "nodes: {a: [0, 0, 0], b: [0, 0, 1], e: [0, 0.4, 0], c: [1, 0, 0.5], d: [1, 0, 2]}\n"
        "pairs:\n"
        "  - {nodes: [a, b], tags: [long]}\n"
        "  - {nodes: [e, a], tags: [short]}\n"
        "  - {nodes: [c, d], tags: [long]}\n"
        "  - {nodes: " +
        cable +
        ", tags: [cable]}\n"
        "builders:\n"
        "  - {match: long, rod: {radius_m: 0.1, mass_kg: 1}}\n"
        "  - {match: short, rod: {radius_m: 0.05, mass_kg: 1}}\n"
        "  - {match: cable, cable: {stiffness_n_per_m: 10, prestress_n: 1, ends: surface}}\n";
    return Good(yaml + spheres).def.cables[0].attachments[i].position_m;
  };
  const double s = 1 / std::sqrt(1.25);
  const Vec3 a = end("[a, c]", 0, "");  // e-a is shorter than a-b, and along y
  EXPECT_NEAR(a.x, 0.05 * s, 1e-15);
  EXPECT_EQ(a.y, 0.0);
  EXPECT_NEAR(a.z, 0.05 * 0.5 * s, 1e-15);
  const Vec3 c = end("[a, c]", 1, "");
  EXPECT_NEAR(c.x, 0.9, 1e-15);
  EXPECT_NEAR(c.z, 0.5, 1e-15);
  // A sphere has priority over rods; the end is then on the straight line to the next node.
  const Vec3 d = end("[d, a]", 0, more);
  EXPECT_NEAR(d.x, 1 - 0.02 / std::sqrt(5.0), 1e-15);
  EXPECT_NEAR(d.z, 2 - 0.04 / std::sqrt(5.0), 1e-15);
}

// A cable along its rod has no side on which to leave it.
TEST(Model, ACableAlongItsRodEndsAtTheNode) {
  const RobotSpec robot = Good(
      "nodes: {a: [0, 0, 0], b: [0, 0, 1], c: [0, 0, 2], d: [0, 1, 2]}\n"
      "pairs: [{each: [[a, b], [c, d]], tags: [rod]}, {nodes: [b, c], tags: [cable]}]\n"
      "builders:\n"
      "  - {match: rod, rod: {radius_m: 0.1, mass_kg: 1}}\n"
      "  - {match: cable, cable: {stiffness_n_per_m: 10, prestress_n: 1, ends: surface}}\n");
  EXPECT_EQ(robot.def.cables[0].attachments[0].position_m.z, 1.0);
  EXPECT_NEAR(robot.def.cables[0].attachments[1].position_m.z, 1.9, 1e-15);
}

// Bullet uses the bounding box for a compound, and the exact inertia for a single cylinder.
TEST(Model, BoundingBoxesAreForBodiesOfSeveralParts) {
  const std::string rod =
      "nodes: {a: [0, 0, 0], b: [1, 1, 0]}\npairs: [{nodes: [a, b], tags: [rod]}]\n"
      "builders: [{match: rod, rod: {radius_m: 0.1, mass_kg: 1}}";
  const Inertia one = Good(rod + "]\ninertia: bounding_box\n").def.bodies[0].inertia_kg_m2;
  EXPECT_EQ(one.xy, Good(rod + "]\n").def.bodies[0].inertia_kg_m2.xy);
  EXPECT_LT(one.xy, -0.01);
  const RobotSpec two = Good(rod +
                             ", {match: b, sphere: {radius_m: 0.1, mass_kg: 1}}]\n"
                             "inertia: bounding_box\n");
  EXPECT_EQ(two.def.bodies[0].inertia_kg_m2.xy, 0.0);
}

TEST(Model, RestLengthFollowsFromPrestressLengthOrRatio) {
  EXPECT_DOUBLE_EQ(Good(TwoRods("prestress_n: 2")).def.cables[0].rest_length_m, 0.08);
  EXPECT_DOUBLE_EQ(Good(TwoRods("rest_length_m: 0.2")).def.cables[0].rest_length_m, 0.2);
  EXPECT_DOUBLE_EQ(Good(TwoRods("rest_length_ratio: 0.9")).def.cables[0].rest_length_m, 0.09);
}

TEST(Model, CablesRunThroughViaPoints) {
  const RobotSpec robot = Good(TwoRods("prestress_n: 2", "") + "allow_disconnected: false\n");
  EXPECT_EQ(robot.def.cables[0].attachments.size(), 2u);
  std::string yaml = TwoRods("prestress_n: 2");
  yaml.replace(yaml.find("[a, c]"), 6, "[a, c, b, d]");
  const CableDef cable = Good(yaml).def.cables[0];
  ASSERT_EQ(cable.attachments.size(), 4u);
  EXPECT_EQ(cable.name, "a-c-b-d");
  EXPECT_EQ(cable.attachments[2].body, 0);
  EXPECT_DOUBLE_EQ(CableLength(cable), 0.2 + std::sqrt(1.01));
  EXPECT_DOUBLE_EQ(CableTension(cable), 2.0);
}

TEST(Model, ActuatorsAreNoneIdealOrLimited) {
  EXPECT_EQ(Good(TwoRods()).def.cables[0].actuator.kind, ActuatorDef::Kind::kNone);
  EXPECT_EQ(Good(TwoRods("prestress_n: 1, actuator: {ideal: true}")).def.cables[0].actuator.kind,
            ActuatorDef::Kind::kIdeal);
  const ActuatorDef limited =
      Good(TwoRods("prestress_n: 1, actuator: {max_acceleration_m_per_s2: 3}"))
          .def.cables[0]
          .actuator;
  EXPECT_EQ(limited.kind, ActuatorDef::Kind::kLimited);
  EXPECT_EQ(limited.max_acceleration_m_per_s2, 3.0);
  EXPECT_TRUE(std::isinf(limited.max_speed_m_per_s));
  EXPECT_TRUE(std::isinf(limited.max_force_n));
}

TEST(Model, DampingLawIsTheFilesUnlessTheCableHasItsOwn) {
  EXPECT_EQ(Good(TwoRods()).def.cables[0].damping_law, DampingLaw::kExact);
  EXPECT_EQ(Good(TwoRods() + "damping_law: clamped\n").def.cables[0].damping_law,
            DampingLaw::kClamped);
  EXPECT_EQ(Good(TwoRods("prestress_n: 1, damping_law: exact") + "damping_law: clamped\n")
                .def.cables[0]
                .damping_law,
            DampingLaw::kExact);
}

TEST(Model, ContactGravityAndMaterialAreRead) {
  const RobotSpec robot = Good(OneRod("{radius_m: 0.1, mass_kg: 1, static_friction: 0.6, "
                                      "kinetic_friction: 0.4, restitution: 0.3, collides: false}") +
                               "gravity_m_per_s2: [0, 0, -1.62]\n"
                               "contact: {friction_combine: minimum, restitution_combine: "
                               "geometric_mean, friction_law: along_slip}\n");
  EXPECT_EQ(robot.def.gravity_m_per_s2.z, -1.62);
  EXPECT_EQ(robot.def.friction_combine, CombineRule::kMinimum);
  EXPECT_EQ(robot.def.restitution_combine, CombineRule::kGeometricMean);
  EXPECT_EQ(robot.def.friction_law, FrictionLaw::kAlongSlip);
  EXPECT_EQ(robot.def.capsules[0].material.static_friction, 0.6);
  EXPECT_EQ(robot.def.capsules[0].material.kinetic_friction, 0.4);
  EXPECT_EQ(robot.def.capsules[0].material.restitution, 0.3);
  EXPECT_FALSE(robot.def.capsules[0].collides);
}

TEST(Model, CopiesAreNumberedTaggedStepped) {
  const RobotSpec robot =
      Good(std::string(kBars) +
           "  - {match: link, cable: {stiffness_n_per_m: 10, rest_length_m: 0.1}}\n"
           "structure:\n"
           "  - part: bar\n    name: rung\n    copies: 4\n    at_m: [1, 2, 3]\n    step_m: [0, 0, "
           "0.5]\n    tags: [ladder]\n"
           "    step_rotate: {axis: z, angle_rad: pi / 2}\n"
           "    connect: [{name: link, nodes: [a, a], tags: [link]}, {name: long, nodes: [b, b, "
           "b], tags: [link]}]\n");
  ASSERT_EQ(robot.def.bodies.size(), 4u);
  EXPECT_EQ(robot.def.bodies[3].name, "rung_3");
  EXPECT_EQ(robot.def.nodes[3].name, "rung_1.b");
  EXPECT_NEAR(robot.def.nodes[3].position_m.x, 1.0, 1e-15);
  EXPECT_NEAR(robot.def.nodes[3].position_m.y, 3.0, 1e-15);
  EXPECT_NEAR(robot.def.nodes[3].position_m.z, 3.5, 1e-15);
  for (const char* tag : {"far", "b", "rung_1.b", "ladder", "middle", "1"})
    EXPECT_TRUE(Has(robot.node_tags[3], tag)) << tag;
  EXPECT_TRUE(Has(robot.node_tags[0], "first"));
  EXPECT_TRUE(Has(robot.node_tags[7], "last"));
  // Ordered by copies; a pair of three nodes spans three copies, so that there are two of it.
  std::vector<std::string> names;
  for (const CableDef& cable : robot.def.cables) names.push_back(cable.name);
  EXPECT_EQ(names, (std::vector<std::string>{"link_1", "long_1", "link_2", "long_2", "link_3"}));
  EXPECT_EQ(robot.def.cables[1].attachments[2].body, 2);
  EXPECT_TRUE(Has(robot.cable_tags[4], "last"));
  EXPECT_TRUE(Has(robot.cable_tags[4], "3"));
  EXPECT_TRUE(Has(robot.cable_tags[4], "ladder"));
}

TEST(Model, ARingConnectsTheLastToTheFirst) {
  const RobotSpec robot =
      Good(std::string(kBars) +
           "  - {match: link, cable: {stiffness_n_per_m: 10, rest_length_m: 0.1}}\n"
           "structure:\n  - {part: bar, copies: 3, ring: true, step_m: [0, 0, 1], connect: [{name: "
           "link, nodes: [a, b]}]}\n");
  ASSERT_EQ(robot.def.cables.size(), 3u);
  EXPECT_EQ(robot.def.cables[2].name, "link_3");
  EXPECT_EQ(robot.def.cables[2].attachments[0].body, 2);
  EXPECT_EQ(robot.def.cables[2].attachments[1].body, 0);
}

TEST(Model, WithoutCopiesAPlacementKeepsItsName) {
  const RobotSpec robot = Good(std::string(kBars) +
                               "  - {match: bar.a, anchor: {}}\n"
                               "structure: [{part: bar, rotate: [{axis: [0, 0, 2], angle_rad: pi / "
                               "2}, {quaternion: [1, 1, 0, 0]}]}]\n");
  EXPECT_EQ(robot.def.bodies[0].name, "bar");
  EXPECT_EQ(robot.def.nodes[1].name, "bar.b");
  EXPECT_NEAR(robot.def.nodes[1].position_m.z, 1.0,
              1e-15);  // x to y by the first, y to z by the second
  EXPECT_TRUE(robot.def.bodies[0].fixed);
  EXPECT_FALSE(Has(robot.node_tags[0], "first"));
  const RobotSpec numbered = Good(std::string(kBars) + "structure: [{part: bar, copies: 1}]\n");
  EXPECT_EQ(numbered.def.bodies[0].name, "bar_0");
  EXPECT_TRUE(Has(numbered.node_tags[0], "first") && Has(numbered.node_tags[0], "last"));
}

TEST(Model, PairsAtTheTopJoinPlacedNodes) {
  const RobotSpec robot =
      Good(std::string(kBars) +
           "  - {match: hook, anchor: {}}\n"
           "  - {match: cable, cable: {stiffness_n_per_m: 10, rest_length_m: 0.1}}\n"
           "structure: [{part: bar, copies: 2, step_m: [0, 0, 1]}]\n"
           "nodes: {hook: [0, 0, 5]}\n"
           "pairs:\n  - {tags: [cable], each: [[bar_0.a, bar_1.a], [bar_1.b, hook]]}\n");
  ASSERT_EQ(robot.def.cables.size(), 2u);
  EXPECT_EQ(robot.def.cables[0].name, "bar_0.a-bar_1.a");
  EXPECT_EQ(robot.def.cables[1].attachments[1].body, kWorld);
}

TEST(Model, ARodBetweenPlacementsWeldsThem) {
  const RobotSpec robot = Good(std::string(kBars) +
                               "structure: [{part: bar, copies: 2, step_m: [0, 0, 1]}]\n"
                               "pairs: [{name: post, nodes: [bar_0.a, bar_1.a], tags: [rod]}]\n");
  ASSERT_EQ(robot.def.bodies.size(), 1u);
  EXPECT_EQ(robot.def.bodies[0].mass_kg, 3.0);
}

TEST(Model, PlacementsMoveAsOne) {
  const RobotSpec robot = Good(
      "parts: {two: {nodes: {a: [-1, 0, 0], b: [1, 0, 0]}, pairs: [{nodes: [a, b], tags: "
      "[cable]}]}}\n"
      "builders:\n  - {match: [[a], [b]], sphere: {radius_m: 0.1, mass_kg: 1}}\n"
      "  - {match: cable, cable: {stiffness_n_per_m: 10, rest_length_m: 1}}\n"
      "structure: [{part: two, at_m: [5, 5, 5], velocity_m_per_s: [0, 0, 1], "
      "angular_velocity_rad_per_s: [0, 0, 2]}]\n");
  EXPECT_DOUBLE_EQ(robot.def.bodies[0].velocity_m_per_s.y, -2.0);
  EXPECT_DOUBLE_EQ(robot.def.bodies[1].velocity_m_per_s.y, 2.0);
  EXPECT_DOUBLE_EQ(robot.def.bodies[1].velocity_m_per_s.z, 1.0);
  EXPECT_DOUBLE_EQ(robot.def.bodies[1].angular_velocity_rad_per_s.z, 2.0);
}

TEST(Model, ABoxAlongAPairIsLevelAndTurnsWithItsPart) {
  const char* const model =
      "parts: {beam: {nodes: {a: [0, 0, 0], b: [3, 4, 12]}, pairs: [{nodes: [a, b], tags: "
      "[beam]}]}}\n"
      "builders:\n  - {match: beam, box: {width_m: 0.2, height_m: 0.1, mass_kg_per_m: 2}}\n";
  const RobotSpec robot = Good(std::string(model) + "structure: [{part: beam}]\n");
  const BoxDef& box = robot.def.boxes[0];
  EXPECT_NEAR(robot.def.bodies[0].mass_kg, 26.0, 1e-12);
  EXPECT_DOUBLE_EQ(box.half_extents_m.x, 6.5);
  EXPECT_DOUBLE_EQ(box.half_extents_m.y, 0.1);
  EXPECT_DOUBLE_EQ(box.half_extents_m.z, 0.05);
  const Vec3 along = Rotate(box.orientation, {1, 0, 0}), side = Rotate(box.orientation, {0, 1, 0});
  EXPECT_NEAR(along.x, 3.0 / 13, 1e-15);
  EXPECT_NEAR(along.y, 4.0 / 13, 1e-15);
  EXPECT_NEAR(along.z, 12.0 / 13, 1e-15);
  EXPECT_NEAR(side.z, 0.0, 1e-15);
  EXPECT_GT(Rotate(box.orientation, {0, 0, 1}).z, 0.0);
  const RobotSpec turned = Good(
      std::string(model) + "structure: [{part: beam, rotate: {axis: x, angle_rad: pi / 2}}]\n");
  EXPECT_NEAR(Rotate(turned.def.boxes[0].orientation, {0, 1, 0}).y, 0.0, 1e-15);
}

TEST(Model, ALonePointMassCanBeSimulated) {
  const RobotSpec robot = Good(
      "nodes: {hook: [0, 0, 1], ball: [0, 0, 0]}\npairs: [{nodes: [hook, ball], tags: [cable]}]\n"
      "builders:\n  - {match: hook, anchor: {}}\n  - {match: ball, point_mass: {mass_kg: 2}}\n"
      "  - {match: cable, cable: {stiffness_n_per_m: 10, rest_length_m: 0.5}}\n");
  EXPECT_DOUBLE_EQ(robot.def.bodies[0].inertia_kg_m2.xx, 0.4 * 2 * 0.01 * 0.01);
  EXPECT_TRUE(robot.def.spheres.empty());
}

TEST(Model, DisconnectedBodiesAreAllowedOnRequest) {
  EXPECT_EQ(
      Good(std::string(kBars) +
           "structure: [{part: bar, copies: 2, step_m: [0, 1, 0]}]\nallow_disconnected: true\n")
          .def.bodies.size(),
      2u);
}

TEST(Model, TwoPendulumsOnOneCeilingAreConnected) {
  Good(
      "nodes: {h: [0, 0, 1], i: [1, 0, 1], p: [0, 0, 0], q: [1, 0, 0]}\n"
      "pairs: [{tags: [cable], each: [[h, p], [i, q]]}]\n"
      "builders:\n  - {match: [[h], [i]], anchor: {}}\n  - {match: [[p], [q]], point_mass: "
      "{mass_kg: 2}}\n"
      "  - {match: cable, cable: {stiffness_n_per_m: 10, rest_length_m: 0.5}}\n");
}

// Bit-identical on every machine, because libm is not used. The exact values, computed to 80 digits
// and rounded, end in 466 and 095.
TEST(Model, TurnedPlacementsHaveTheseBits) {
  const RobotSpec robot =
      Good(std::string(kBars) +
           "structure: [{part: bar, rotate: {axis: [1, 2, 3], angle_rad: exp(0.1)}}]\n");
  EXPECT_EQ(robot.def.nodes[1].position_m.x, 0x1.f40f71cdab464p-2);
  EXPECT_EQ(robot.def.nodes[1].position_m.y, 0x1.971d0bf7c2096p-1);
}

}  // namespace
}  // namespace taut
