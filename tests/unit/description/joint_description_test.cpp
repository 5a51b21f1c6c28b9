// Joints, supports and rods pinned at their nodes (class k) in model files
#include <gmock/gmock.h>

#include "plant/find_start.h"
#include "taut/run.h"
#include "taut/start.h"
#include "taut/world_batch.h"
#include "unit/description/experiment_fixture.h"
#include "unit/description/model_fixture.h"

namespace taut {
namespace {

using testing::HasSubstr;

/// Two rods, end to end at x = 1, with a node each there
std::string Leg(const std::string& joint, const std::string& more = "",
                const std::string& lower = "[1, 0, 0]") {
  return "nodes: {hip: [0, 0, 0], a: [1, 0, 0], b: " + lower +
         ", foot: [2, 0, 0]}\n"
         "pairs:\n"
         "  - {name: upper, nodes: [hip, a], tags: [rod]}\n"
         "  - {name: lower, nodes: [b, foot], tags: [rod]}\n"
         "  - {name: knee, nodes: [a, b]}\n"
         "builders:\n"
         "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"
         "  - {match: knee, joint: {" +
         joint + "}}\n" + more;
}

TEST(JointText, APairBecomesAJointAndANodeASupport) {
  const RobotSpec robot = Good(
      Leg("kind: hinge, axis: [0, 2, 0], least_rad: -0.5, most_rad: 1.2, restitution: 0.3, "
          "friction_n_m: 0.01, stiffness_n_m_per_rad: 2, damping_n_m_s_per_rad: 0.1, rest_rad: 0.2",
          "  - {match: hip, support: {kind: ball}}\n"));
  ASSERT_EQ(robot.def.joints.size(), 2u);
  const JointDef& knee = robot.def.joints[0];
  EXPECT_EQ(knee.name, "knee");
  EXPECT_EQ(knee.kind, JointKind::kHinge);
  EXPECT_EQ(robot.def.bodies[static_cast<std::size_t>(knee.body_a)].name, "upper");
  EXPECT_EQ(robot.def.bodies[static_cast<std::size_t>(knee.body_b)].name, "lower");
  EXPECT_EQ(knee.axis.y, 1);
  EXPECT_EQ(knee.from_m.x, 1);
  EXPECT_EQ(knee.least, -0.5);
  EXPECT_EQ(knee.most, 1.2);
  EXPECT_EQ(knee.restitution, 0.3);
  EXPECT_EQ(knee.friction, 0.01);
  EXPECT_EQ(knee.stiffness, 2);
  EXPECT_EQ(knee.damping, 0.1);
  EXPECT_EQ(knee.rest, 0.2);
  const JointDef& hip = robot.def.joints[1];
  EXPECT_EQ(hip.body_a, kWorld);
  EXPECT_EQ(hip.name, "hip");
  Diagnostics out;
  EXPECT_NE(Model::Compile(robot.def, out), nullptr) << out.Format();
}

TEST(JointText, TheAxisTurnsWithThePart) {
  const RobotSpec robot = Good(
      "parts:\n"
      "  leg:\n"
      "    nodes: {hip: [0, 0, 0], a: [1, 0, 0], b: [1, 0, 0], foot: [2, 0, 0]}\n"
      "    pairs:\n"
      "      - {nodes: [hip, a], tags: [rod]}\n"
      "      - {nodes: [b, foot], tags: [rod]}\n"
      "      - {name: knee, nodes: [a, b], tags: [knee]}\n"
      "structure:\n"
      "  - {part: leg, copies: 2, step_m: [0, 0, 1], rotate: {axis: [0, 0, 1], angle_rad: pi / "
      "2}}\n"
      "builders:\n"
      "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"
      "  - {match: knee, joint: {kind: hinge, axis: [0, 1, 0]}}\n"
      "allow_disconnected: true\n");
  ASSERT_EQ(robot.def.joints.size(), 2u);
  EXPECT_NEAR(robot.def.joints[1].axis.x, -1, 1e-15);
  EXPECT_NEAR(robot.def.joints[1].axis.y, 0, 1e-15);
  EXPECT_EQ(robot.def.joints[1].name, "leg_1.knee");
}

TEST(JointText, RodsOfClassKArePinnedInTheirNodes) {
  // A triangle and a fourth rod at one corner: three rods meet in a.
  const RobotSpec robot = Good(
      "nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [0, 1, 0], d: [0, 0, 1]}\n"
      "pairs:\n"
      "  - {tags: [rod], each: [[a, b], [b, c], [c, a], [a, d]]}\n"
      "builders:\n"
      "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1, class_k: true}}\n");
  EXPECT_EQ(robot.def.bodies.size(), 4u);
  ASSERT_EQ(robot.def.joints.size(), 4u);  // a: two for the rods after the first; b and c: one each
  for (const JointDef& j : robot.def.joints) EXPECT_EQ(j.kind, JointKind::kBall);
  EXPECT_EQ(robot.def.joints[0].name, "b-c.b");
  // At a, each pair of the three rods is apart.
  EXPECT_EQ(KeptApart(robot.def).size(), 5u);
  Diagnostics out;
  EXPECT_NE(Model::Compile(robot.def, out), nullptr) << out.Format();
}

TEST(JointText, WhatActsOnTheTurnsOfABallIsSaidAtIt) {
  const std::string turns =
      "friction_n_m: 0.1, stiffness_n_m_per_rad: 2, damping_n_m_s_per_rad: 0.3";
  const std::string rods =
      "nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [0, 1, 0]}\n"
      "pairs:\n"
      "  - {tags: [rod], each: [[a, b], [a, c]]}\n"
      "builders:\n"
      "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1, ";
  const RobotSpec leg = Good(Leg("kind: ball, most_rad: 0.5, " + turns));
  const RobotSpec net = Good(rods + "class_k: true, pins: {" + turns + "}}}\n");
  for (const RobotSpec* robot : {&leg, &net}) {
    ASSERT_EQ(robot->def.joints.size(), 1u);
    EXPECT_EQ(robot->def.joints[0].friction, 0.1);
    EXPECT_EQ(robot->def.joints[0].stiffness, 2);
    EXPECT_EQ(robot->def.joints[0].damping, 0.3);
    Diagnostics out;
    EXPECT_NE(Model::Compile(robot->def, out), nullptr) << out.Format();
  }
  EXPECT_THAT(Errors(rods + "pins: {friction_n_m: 1}}}\n"),
              HasSubstr("pins has no effect: this rod is welded at its nodes"));
  EXPECT_THAT(Errors(rods + "class_k: true, pins: {friction_n_m: -1}}}\n"),
              HasSubstr("friction_n_m"));
  EXPECT_THAT(Errors(rods + "class_k: true, pins: {rest_rad: 1}}}\n"), HasSubstr("rest_rad"));
}

TEST(JointText, NodesFixedToARodGoWithItAndAnchorsHoldIt) {
  const std::string rods =
      "nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [0, 1, 0], m: {at_m: [0, 0.1, 0], fixed_to: a}}\n"
      "pairs:\n"
      "  - {tags: [rod], each: [[a, b], [a, c]]}\n"
      "builders:\n"
      "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1, class_k: true}}\n";
  const RobotSpec free = Good(rods);
  ASSERT_EQ(free.def.joints.size(), 1u);
  EXPECT_EQ(free.def.bodies[static_cast<std::size_t>(free.def.nodes[3].body)].name, "a-b");
  const RobotSpec held = Good(rods + "  - {match: a, anchor: {}}\n");
  ASSERT_EQ(held.def.joints.size(), 2u);
  for (const JointDef& pin : held.def.joints) EXPECT_EQ(pin.body_a, kWorld);
  for (const BodyDef& body : held.def.bodies) EXPECT_FALSE(body.fixed);
}

TEST(JointText, ASupportMakesNoBody) {
  const std::string errors = Errors(
      "nodes: {a: [0, 0, 0], b: [1, 0, 0], lost: [2, 0, 0]}\n"
      "pairs: [{nodes: [a, b], tags: [rod]}]\n"
      "builders:\n"
      "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"
      "  - {match: lost, support: {kind: ball}}\n");
  EXPECT_THAT(errors, HasSubstr("\"lost\" belongs to no body"));
  EXPECT_THAT(errors, testing::Not(HasSubstr("to itself")));  // one mistake, one error
}

/// The upper rod is rotated about z, the lower one is bent at the knee and has slid.
TEST(JointText, AnotherPoseHasTheSameCoordinates) {
  for (const std::string kind : {"hinge", "cylindrical", "weld", "line"}) {
    const RobotSpec robot = Good(Leg("kind: " + kind + ", axis: [0, 0.6, 0.8]"));
    Diagnostics out;
    const auto model = Model::Compile(robot.def, out);
    ASSERT_NE(model, nullptr) << out.Format();
    WorldBatch batch(model, {});
    batch.SetParameter(0, Parameter::kGravityZ, 0, 0);
    BodyState kicked = batch.Body(0, 1);
    kicked.velocity_m_per_s = {0.3, 1.1, -0.4};
    kicked.angular_velocity_rad_per_s = {2, 0.1, 0.2};
    batch.SetBodyState(0, 1, kicked);
    batch.Step(1e-3, 700);
    const JointState there = batch.Joint(0, 0);
    Pose pose;
    for (int b = 0; b < 2; ++b) pose.bodies.push_back(batch.Body(0, b));
    const RobotSpec moved = RobotAt(robot, pose);
    const auto again = Model::Compile(moved.def, out);
    ASSERT_NE(again, nullptr) << kind << out.Format();
    const JointState here = WorldBatch(again, {}).Joint(0, 0);
    EXPECT_NEAR(here.coordinate, there.coordinate, 1e-12) << kind;
    EXPECT_LT(here.gap_m, 1e-10) << kind;
    if (kind == "hinge") {
      EXPECT_GT(std::fabs(here.coordinate), 0.1);
    }
  }
}

TEST(JointText, WhatIsApartIsNamed) {
  const RobotSpec robot = Good(Leg("kind: ball, collides: true", "apart: [[upper, lower]]\n"));
  ASSERT_EQ(robot.def.apart.size(), 1u);
  EXPECT_THAT(Errors(Leg("kind: ball", "apart: [[upper, lowr]]\n")),
              HasSubstr("apart: there is no body \"lowr\""));
  EXPECT_THAT(Errors(Leg("kind: ball", "apart: [[upper]]\n")),
              HasSubstr("apart: \"upper\" is the only body in its list (list two or more bodies"));
  EXPECT_THAT(Errors(Leg("kind: ball", "apart: [[upper, lower, upper]]\n")),
              HasSubstr("apart: \"upper\" is in one list twice"));
}

TEST(JointText, MistakesAreNamed) {
  EXPECT_THAT(Errors(Leg("kind: ball", "", "[1, 0, 0.02]")),
              HasSubstr("the nodes of the joint \"knee\" are 0.02 m apart"));
  EXPECT_THAT(Errors(Leg("kind: knee")), HasSubstr("kind"));
  EXPECT_THAT(Errors(Leg("axis: [0, 1, 0]")), HasSubstr("kind"));
  EXPECT_THAT(Errors(Leg("kind: hinge, axis: [0, 0, 0]")), HasSubstr("axis"));
  EXPECT_THAT(Errors(Leg("kind: hinge, least_m: 1")), HasSubstr("least_m"));
  EXPECT_THAT(Errors(Leg("kind: prismatic, friction_n_m: 1")), HasSubstr("friction_n_m"));
  EXPECT_THAT(Errors(Leg("kind: hinge, friction_n_m: -1")), HasSubstr("friction_n_m"));
  EXPECT_THAT(Errors(Leg("kind: hinge, restitution: 2")), HasSubstr("restitution"));
  EXPECT_THAT(Errors(Leg("kind: ball", "  - {match: hip, support: {kind: distance}}\n")),
              HasSubstr("has only one point"));
  EXPECT_THAT(Errors("nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [2, 0, 0]}\n"
                     "pairs:\n"
                     "  - {nodes: [a, b], tags: [rod]}\n"
                     "  - {nodes: [b, c], tags: [rod]}\n"
                     "  - {name: knee, nodes: [a, c]}\n"
                     "builders:\n"
                     "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"
                     "  - {match: knee, joint: {kind: weld}}\n"),
              HasSubstr("to itself"));
}

TEST(JointText, LimitsThatMakeNoSenseAreNamed) {
  EXPECT_THAT(Errors(Leg("kind: hinge, least_rad: 1, most_rad: 0.5")),
              HasSubstr("not above the lower limit"));
  EXPECT_THAT(Errors(Leg("kind: ball, least_rad: -1")), HasSubstr("has no lower limit"));
  EXPECT_THAT(Errors(Leg("kind: ball, stiffness_n_m_per_rad: 1, rest_rad: 0.1")),
              HasSubstr("the spring of a ball joint is always at rest in the described pose"));
  EXPECT_THAT(Errors(Leg("kind: ball, friction_n: 1")), HasSubstr("friction_n"));
  EXPECT_THAT(Errors(Leg("kind: planar, friction_n_m: 1")), HasSubstr("has no single coordinate"));
}

TEST(JointText, LimitsOfABallAndOfADistanceAreAboveZero) {
  EXPECT_THAT(
      Errors(Leg("kind: ball, axis: [1, 0, 0], most_rad: -0.5")),
      HasSubstr("11:56: error: builder.joint.most_rad must be positive, got -0.5 (it is the "
                "largest angle of a ball joint's axis"));
  const std::string apart =
      Errors(Leg("kind: distance, least_m: -1, most_m: -0.5", "", "[1.2, 0, 0]"));
  EXPECT_THAT(apart, HasSubstr("least_m must not be negative"));
  EXPECT_THAT(apart, HasSubstr("most_m must be positive, got -0.5 (it is a distance)"));
  EXPECT_THAT(
      Errors(Leg("kind: distance")),
      HasSubstr(
          "the nodes of the joint \"knee\" are at the same position (move one of them, or use"));
}

TEST(JointText, AStopThatIsPassedAsDescribedIsAnError) {
  EXPECT_THAT(Errors(Leg("kind: hinge, axis: [0, 1, 0], least_rad: 0.3, most_rad: 0.5")),
              HasSubstr("the joint \"knee\" is 0.3 rad beyond its limit in the described pose "
                        "(change the described pose"));
  EXPECT_THAT(Errors(Leg("kind: prismatic, axis: [1, 0, 0], most_m: 0.1", "", "[1.15, 0, 0]")),
              HasSubstr("is 0.05 m beyond its limit"));
  EXPECT_THAT(Errors(Leg("kind: distance, most_m: 0.1", "", "[1.2, 0, 0]")),
              HasSubstr("is 0.1 m beyond its limit"));
  EXPECT_THAT(Errors(Leg("kind: ball, most_rad: 0.2, turned: {axis: x, angle_rad: 0.5}")),
              HasSubstr("is 0.3 rad beyond its limit"));
  Good(
      Leg("kind: hinge, axis: [0, 1, 0], least_rad: 0.3, most_rad: 0.5, turned: {axis: y, "
          "angle_rad: 0.4}"));
  Good(Leg("kind: hinge, axis: [0, 1, 0], least_rad: 0.0001, most_rad: 0.5"));
}

TEST(JointText, WhatWeldsHoldNeedsNoOtherJoint) {
  const auto twice = [](const std::string& one, const std::string& other) {
    return "nodes: {hip: [0, 0, 0], a: [1, 0, 0], b: [1, 0, 0], foot: [2, 0, 0]}\n"
           "pairs:\n"
           "  - {name: upper, nodes: [hip, a], tags: [rod]}\n"
           "  - {name: lower, nodes: [b, foot], tags: [rod]}\n"
           "  - {name: one, nodes: [a, b]}\n"
           "  - {name: other, nodes: [a, b]}\n"
           "builders:\n"
           "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"
           "  - {match: one, joint: {kind: " +
           one + "}}\n  - {match: other, joint: {kind: " + other + "}}\n";
  };
  EXPECT_THAT(Errors(twice("weld", "weld")),
              HasSubstr("9:5: error: the weld \"other\" is redundant: other welds hold its bodies "
                        "together (leave it out)"));
  EXPECT_THAT(Errors(twice("hinge", "weld")),
              HasSubstr("8:5: error: the joint \"one\" has no effect: welds hold its bodies"));
  Good(twice("ball", "ball"));  // redundant rows are solved
  EXPECT_THAT(Errors(Leg("kind: ball",
                         "  - {match: hip, support: {kind: weld}}\n"
                         "  - {match: a, support: {kind: weld}}\n")),
              HasSubstr("the weld \"a\" is redundant"));
  // In a triangle of welds the third weld is redundant.
  EXPECT_THAT(Errors("nodes:\n"
                     "  {a: [0, 0, 0], b: [1, 0, 0], c: [1, 0, 0], d: [1, 1, 0], e: [1, 1, 0], "
                     "f: [0, 0, 0]}\n"
                     "pairs:\n"
                     "  - {tags: [rod], each: [[a, b], [c, d], [e, f]]}\n"
                     "  - {tags: [weld], each: [[b, c], [d, e], [f, a]]}\n"
                     "builders:\n"
                     "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"
                     "  - {match: weld, joint: {kind: weld}}\n"),
              HasSubstr("the weld \"f-a\" is redundant"));
}

TEST(JointText, NeitherOfItsBodiesMoves) {
  EXPECT_THAT(
      Errors(Leg("kind: ball", "  - {match: hip, anchor: {}}\n  - {match: foot, anchor: {}}\n")),
      HasSubstr("8:5: error: the joint \"knee\" connects two bodies that are fixed in the world, "
                "so it has no effect (leave it out, or one of the anchors)"));
}

TEST(JointText, TwoOfOneNameAreAnError) {
  EXPECT_THAT(Errors("nodes:\n"
                     "  {knee: {at_m: [0, 0, 0], tags: [held]}, a: [1, 0, 0], b: [1, 0, 0], "
                     "c: [2, 0, 0]}\n"
                     "pairs:\n"
                     "  - {nodes: [knee, a], tags: [rod]}\n"
                     "  - {nodes: [b, c], tags: [rod]}\n"
                     "  - {name: knee, nodes: [a, b], tags: [joint]}\n"
                     "builders:\n"
                     "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"
                     "  - {match: joint, joint: {kind: ball}}\n"
                     "  - {match: held, support: {kind: ball}}\n"),
              HasSubstr("two joints have the name \"knee\""));
}

using JointedStart = test::ExperimentFolder;

TEST_F(JointedStart, NoiseMovesWhatIsJoinedTogether) {
  const std::string model =
      "taut: 1\nkind: model\nname: leg\n" + Leg("kind: ball", "allow_disconnected: true\n");
  const std::string experiment =
      "taut: 1\nkind: experiment\nname: trial\nmodel: leg.yaml\nduration_s: 1\n"
      "start_noise: {position_m: 0.01}\n";
  Write("leg.yaml", model);
  Write("trial.yaml", experiment);
  const auto gap = [&](const ExperimentSpec& e) {
    Diagnostics out;
    WorldBatch batch(Model::Compile(e.robot.def, out), {});
    EXPECT_TRUE(plant::PrepareStart(e, batch, out)) << out.Format();
    EXPECT_NE(batch.Body(0, 0).position_m.x, e.robot.def.bodies[0].com_m.x);
    return batch.Joint(0, 0).gap_m;
  };
  EXPECT_LT(gap(Load()), 1e-15);
  Write("leg.yaml", "taut: 1\nkind: model\nname: leg\n" +
                        Leg("kind: ball", "  - {match: hip, support: {kind: ball}}\n"));
  Write("trial.yaml", experiment + "");
  Diagnostics out;
  const ExperimentSpec held = Load();
  WorldBatch batch(Model::Compile(held.robot.def, out), {});
  ASSERT_TRUE(plant::PrepareStart(held, batch, out));
  EXPECT_EQ(batch.Body(0, 0).position_m.x, held.robot.def.bodies[0].com_m.x);
  Write("trial.yaml",
        "taut: 1\nkind: experiment\nname: trial\nmodel: leg.yaml\nduration_s: 1\n"
        "start_noise: {heading_rad: 0.1}\n");
  EXPECT_THAT(Complaints(), HasSubstr("the joint \"hip\" connects it to the world"));
  Write("trial.yaml",
        "taut: 1\nkind: experiment\nname: trial\nmodel: leg.yaml\nduration_s: 1\n"
        "start_noise: {any_pose: true}\n");
  EXPECT_THAT(Complaints(),
              HasSubstr("start_noise.any_pose cannot move the robot: the joint \"hip\""));
}

}  // namespace
}  // namespace taut
