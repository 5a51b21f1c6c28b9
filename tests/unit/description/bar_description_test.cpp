// Elastic bars, and members with a section, in model files; and the motion of a bar
#include <gmock/gmock.h>

#include <cmath>

#include "math/vec.h"
#include "taut/world_batch.h"
#include "unit/description/model_fixture.h"

namespace taut {
namespace {

using testing::HasSubstr;

/// A bar of 2 m from an anchor at the origin to a point
std::string OneBar(const std::string& bar, const std::string& more = "") {
  return "nodes: {foot: [0, 0, 0], top: [0, 0, 2]}\n"    // line 4
         "pairs: [{name: strut, nodes: [foot, top]}]\n"  // line 5
         "builders:\n"                                   // line 6
         "  - {match: foot, anchor: {}}\n"               // line 7
         "  - {match: strut, bar: {" +
         bar + "}}\n" + more;  // line 8
}

TEST(Bar, IsADistanceWithASpringBetweenPoints) {
  const RobotSpec robot = Good(OneBar("stiffness_n_per_m: 500, damping_n_s_per_m: 3, mass_kg: 4"));
  ASSERT_EQ(robot.def.joints.size(), 1u);
  const JointDef& bar = robot.def.joints[0];
  EXPECT_TRUE(IsBar(bar));
  EXPECT_EQ(bar.name, "strut");
  EXPECT_EQ(bar.stiffness, 500);
  EXPECT_EQ(bar.damping, 3);
  EXPECT_EQ(bar.rest, 2);
  EXPECT_TRUE(bar.collides);
  EXPECT_EQ(bar.body_a, kWorld);
  ASSERT_EQ(robot.def.bodies.size(), 1u);  // the anchor takes the other half
  EXPECT_EQ(robot.def.bodies[0].name, "robot");
  EXPECT_EQ(robot.def.bodies[0].mass_kg, 2);
  EXPECT_EQ(robot.def.bodies[0].com_m.z, 2);
  EXPECT_TRUE(Has(robot.joint_tags[0], "strut"));
}

TEST(Bar, ItsStiffnessFollowsFromItsSectionAndItsLengthWithoutStress) {
  const auto bar = [](const std::string& more) {
    return Good(OneBar("young_pa: 70e9, area_m2: 1e-6, mass_kg: 1" + more)).def.joints.at(0);
  };
  const double ea_n = 70e3;
  EXPECT_NEAR(bar("").stiffness, ea_n / 2, 1e-9);
  EXPECT_NEAR(bar(", rest_length_m: 1.9").stiffness, ea_n / 1.9, 1e-9);
  EXPECT_NEAR(bar(", rest_length_ratio: 1.1").stiffness, ea_n / 2.2, 1e-9);
  for (const double force_n : {-5000.0, 9000.0}) {
    const JointDef stressed = bar(", prestress_n: " + std::to_string(force_n));
    EXPECT_NEAR(stressed.stiffness * stressed.rest, ea_n, 1e-9);
    EXPECT_NEAR(stressed.stiffness * (2 - stressed.rest), force_n, 1e-8);
  }
}

TEST(Bar, OfAGivenStiffnessPushesWhereItIsPressed) {
  const JointDef bar =
      Good(OneBar("stiffness_n_per_m: 100, prestress_n: -30, mass_kg: 1, young_pa: 1e9"))
          .def.joints.at(0);
  EXPECT_NEAR(bar.rest, 2.3, 1e-15);
  EXPECT_EQ(bar.stiffness, 100);  // the given stiffness overrides E
}

/// A triangle of bars of 1 kg/m on two supports, its tip held by a rope of 2 kg/m
constexpr const char* kTruss =
    "nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [0.5, 0, 1], hook: [0.5, 0, 2]}\n"
    "pairs:\n"
    "  - {tags: [bar], each: [[a, b], [b, c], [c, a]]}\n"
    "  - {name: rope, nodes: [c, hook]}\n"
    "builders:\n"
    "  - {match: bar, bar: {young_pa: 1e6, area_m2: 1e-3, density_kg_per_m3: 1000, "
    "second_moment_m4: 1e-7, yield_pa: 2e5, strength_n: 150, expansion_per_k: 12e-6, "
    "mass: consistent}}\n"
    "  - {match: rope, cable: {young_pa: 2e5, area_m2: 1e-2, density_kg_per_m3: 200, "
    "prestress_n: 500, strength_n: 900, expansion_per_k: 1e-5}}\n"
    "  - {match: hook, anchor: {}}\n"
    "  - {match: a, support: {kind: ball}}\n"
    "  - {match: b, support: {kind: line, axis: [1, 0, 0]}}\n";

TEST(Bar, MembersAreLumpedHalfAtEachEndByTheirLengthsWithoutStress) {
  const RobotSpec robot =
      Good(std::string(kTruss) + "  - {match: c, point_mass: {mass_kg: 0.25}}\n");
  const double side = std::sqrt(1.25), rope = 1 / (1 + 500 / 2e3);
  ASSERT_EQ(robot.def.bodies.size(), 3u);
  EXPECT_NEAR(robot.def.bodies[0].mass_kg, 0.5 * (1 + side), 1e-15);
  EXPECT_NEAR(robot.def.bodies[1].mass_kg, 0.5 * (1 + side), 1e-15);
  EXPECT_NEAR(robot.def.bodies[2].mass_kg, side + 0.5 * 2 * rope + 0.25, 1e-15);
  const CableDef& cable = robot.def.cables.at(0);
  EXPECT_NEAR(cable.rest_length_m, rope, 1e-15);
  EXPECT_NEAR(cable.stiffness_n_per_m, 2e3 / rope, 1e-9);
  EXPECT_NEAR(cable.member.mass_kg, 2 * rope, 1e-15);
  EXPECT_EQ(cable.member.strength_n, 900);
  const MemberDef& bar = robot.def.joints.at(1).member;
  EXPECT_NEAR(bar.mass_kg, side, 1e-15);
  EXPECT_EQ(bar.mass, MemberMass::kConsistent);
  EXPECT_NEAR(bar.buckling_length_m, side, 1e-15);  // default: the bar's length
  EXPECT_EQ(bar.yield_pa, 2e5);
  EXPECT_EQ(bar.expansion_per_k, 12e-6);
}

TEST(Bar, WhatEndsOnARodJoinsItsBody) {
  const RobotSpec robot = Good(
      "nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [1, 0, 1]}\n"
      "pairs:\n"
      "  - {name: rod, nodes: [a, b]}\n"
      "  - {name: bar, nodes: [b, c]}\n"
      "builders:\n"
      "  - {match: rod, rod: {radius_m: 0.02, mass_kg: 1, area_m2: 1e-4, young_pa: 7e10, "
      "second_moment_m4: 1e-9, yield_pa: 2e8, strength_n: 2e4}}\n"
      "  - {match: bar, bar: {stiffness_n_per_m: 1000, mass_kg: 2}}\n");
  ASSERT_EQ(robot.def.bodies.size(), 2u);
  const BodyDef& rod = robot.def.bodies[0];
  EXPECT_EQ(rod.name, "rod");
  EXPECT_NEAR(rod.mass_kg, 2, 1e-15);
  EXPECT_NEAR(rod.com_m.x, 0.75, 1e-15);
  // Steiner: a cylinder of 1 kg and a point of 1 kg, each 0.25 m off
  EXPECT_NEAR(rod.inertia_kg_m2.yy, 1.0 / 12 + 0.25 * 0.02 * 0.02 + 2 * 0.0625, 1e-15);
  EXPECT_NEAR(rod.inertia_kg_m2.xx, 0.5 * 0.02 * 0.02, 1e-15);
  const MemberDef& strut = robot.def.capsules.at(0).member;
  EXPECT_EQ(strut.buckling_length_m, 1);
  EXPECT_EQ(strut.yield_pa, 2e8);
  EXPECT_EQ(strut.mass_kg, 0);
  EXPECT_EQ(robot.def.joints.at(0).body_a, 0);
}

TEST(Bar, ItsMistakesAreNamed) {
  const auto with = [](const std::string& bar) { return Errors(OneBar(bar)); };
  EXPECT_EQ(
      with("stiffness_n_per_m: 500"),
      "robot.yaml:4:26: error: the node \"top\" has no mass (give a bar or a cable at this node "
      "density_kg_per_m3 and area_m2, or mass_kg; or give the node a point_mass or an anchor)\n");
  EXPECT_EQ(with("mass_kg: 1"),
            "robot.yaml:8:25: error: bar needs the key \"stiffness_n_per_m\" (or give `young_pa` "
            "and `area_m2`: k = E A / L)\n");
  EXPECT_EQ(with("young_pa: 1e9, mass_kg: 1"),
            "robot.yaml:8:26: error: bar.young_pa needs the key \"area_m2\" as well (or give "
            "stiffness_n_per_m instead: k = E A / L)\n");
  EXPECT_EQ(
      with("stiffness_n_per_m: 5, mass_kg: 1, density_kg_per_m3: 2, rest_length_m: 1, "
           "prestress_n: 3"),
      "robot.yaml:8:60: error: bar has both mass_kg and density_kg_per_m3 (give only one of them)\n"
      "robot.yaml:8:82: error: bar has both prestress_n and rest_length_m (give only one of "
      "them)\n");
  EXPECT_THAT(with("stiffness_n_per_m: 5, density_kg_per_m3: 2, yield_pa: 1, second_moment_m4: 1"),
              HasSubstr("robot.yaml:8:48: error: bar.density_kg_per_m3 needs the key \"area_m2\" "
                        "as well (the mass is density times area times length)\n"
                        "robot.yaml:8:70: error: bar.yield_pa needs the key \"area_m2\" as well "
                        "(the yield force is yield stress times area)\n"
                        "robot.yaml:8:83: error: bar.second_moment_m4 needs the key \"young_pa\" "
                        "as well (Euler's buckling load is pi^2 E I / l^2)\n"));
  EXPECT_EQ(with("stiffness_n_per_m: 5, mass_kg: 1, buckling_length_m: 1"),
            "robot.yaml:8:60: error: bar.buckling_length_m needs the key \"second_moment_m4\" as "
            "well (Euler's buckling load is pi^2 E I / l^2)\n");
  EXPECT_EQ(with("stiffness_n_per_m: 5, mass_kg: 1, prestress_n: 11"),
            "robot.yaml:8:73: error: bar.prestress_n: 11 N would stretch the bar \"strut\" by its "
            "whole length of 2 m or more (check its stiffness)\n");
  for (const char* force : {"-1", "-1.5"}) {
    EXPECT_EQ(with("young_pa: 1, area_m2: 1, mass_kg: 1, prestress_n: " + std::string(force)),
              "robot.yaml:8:76: error: bar.prestress_n: " + std::string(force) +
                  " N would compress the bar \"strut\" to zero length (check its stiffness)\n");
  }
  EXPECT_EQ(with("stiffness_n_per_m: -5, mass_kg: -1, area_m2: 0, mass: heavy"),
            "robot.yaml:8:45: error: bar.stiffness_n_per_m must be positive, got -5\n"
            "robot.yaml:8:58: error: bar.mass_kg must not be negative, got -1\n"
            "robot.yaml:8:71: error: bar.area_m2 must be positive, got 0\n"
            "robot.yaml:8:80: error: bar.mass cannot be \"heavy\" (one of: lumped, "
            "consistent)\n");
  EXPECT_THAT(with("stiffness_n_per_m: 5, mass: consistent"),
              HasSubstr("robot.yaml:8:48: error: bar.mass has no effect: the member has no mass "
                        "(give mass_kg or density_kg_per_m3)\n"));
  EXPECT_EQ(Errors("nodes: {a: [0, 0, 0], b: [0, 0, 0], c: [1, 0, 0]}\n"
                   "pairs: [{nodes: [a, b], tags: [bar]}, {nodes: [a, b, c], tags: [bar]}]\n"
                   "builders: [{match: bar, bar: {stiffness_n_per_m: 5, mass_kg: 1}}]\n"),
            "robot.yaml:5:9: error: the nodes of the bar \"a-b\" are at the same position (move "
            "one of them: a bar needs a length)\n"
            "robot.yaml:5:39: error: a bar needs two nodes, but \"a-b-c\" has 3\n");
}

TEST(Bar, CablesAndRodsSayWhatTheirSectionsNeed) {
  const auto cable = [](const std::string& keys) {
    std::string text = TwoRods("rest_length_m: 0.05");
    const std::string given = "stiffness_n_per_m: 100, rest_length_m: 0.05";
    return Errors(text.replace(text.find(given), given.size(), keys));
  };
  EXPECT_EQ(cable("rest_length_m: 0.05, young_pa: 1e9"),
            "robot.yaml:11:49: error: cable.young_pa needs the key \"area_m2\" as well (or give "
            "stiffness_n_per_m instead: k = E A / L)\n");
  EXPECT_EQ(cable("rest_length_m: 0.05"),
            "robot.yaml:11:27: error: cable needs the key \"stiffness_n_per_m\" (or give "
            "`young_pa` and `area_m2`: k = E A / L)\n");
  EXPECT_EQ(Errors(OneRod("{radius_m: 0.01, mass_kg: 1, buckling_length_m: 2, yield_pa: 3}")),
            "robot.yaml:6:59: error: rod.buckling_length_m needs the key \"second_moment_m4\" as "
            "well (Euler's buckling load is pi^2 E I / l^2)\n"
            "robot.yaml:6:81: error: rod.yield_pa needs the key \"area_m2\" as well (the yield "
            "force is yield stress times area)\n");
}

// Motion

TEST(Bar, PushesAndPullsAsASpringOfItsStiffness) {
  const double k = 500, m = 2, h = 1e-3, w = std::sqrt(k / m), seen = 2 / h * std::atan(w * h / 2);
  for (const double stretch_m : {0.1, -0.1}) {
    const RobotSpec robot = Good(OneBar(
        "stiffness_n_per_m: 500, mass_kg: 4, rest_length_m: " + std::to_string(2 - stretch_m),
        "gravity_m_per_s2: [0, 0, 0]\n"));
    Diagnostics out;
    WorldBatch world(Model::Compile(robot.def, out), {});
    double least = 1e9, most = -1e9;
    for (int n = 1; n <= 2000; ++n) {
      world.Step(h);
      const double wanted = stretch_m * std::cos(seen * n * h);
      const double now = world.Body(0, 0).position_m.z - (2 - stretch_m);
      ASSERT_NEAR(now, wanted, 1e-9) << n;
      least = std::min(least, now), most = std::max(most, now);
    }
    EXPECT_NEAR(most, 0.1, 1e-4);    // the bar pulls it back
    EXPECT_NEAR(least, -0.1, 1e-4);  // and pushes it back
  }
}

TEST(Bar, CarriesAWeightStandingAndHanging) {
  for (const double z : {2.0, -2.0}) {
    const RobotSpec robot =
        Good("nodes: {foot: [0, 0, 0], end: [0, 0, " + std::to_string(z) +
             "]}\n"
             "pairs: [{name: bar, nodes: [foot, end]}]\n"
             "builders:\n"
             "  - {match: foot, anchor: {}}\n"
             "  - {match: end, support: {kind: line, axis: [0, 0, 1]}}\n"
             "  - {match: bar, bar: {young_pa: 1e6, area_m2: 1e-3, damping_n_s_per_m: 60, mass_kg: "
             "4}}\n");
    Diagnostics out;
    WorldBatch world(Model::Compile(robot.def, out), {});
    world.Step(1e-3, 4000);
    const double sag_m = 2 * 9.81 / 500;  // k = E A / L = 1000 N / 2 m
    EXPECT_NEAR(world.Body(0, 0).position_m.z, z - sag_m, 1e-9);
  }
}

}  // namespace
}  // namespace taut
