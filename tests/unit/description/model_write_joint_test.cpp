// Robots with joints and supports written as model files, and read back
#include <gmock/gmock.h>

#include <cmath>

#include "math/vec.h"
#include "taut/start.h"
#include "taut/world_batch.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

using testing::HasSubstr;

double NodeDistance(const Vec3& a, const Vec3& b) { return std::sqrt(Dot(a - b, a - b)); }

/// A leg in an oblique part: a knee with all properties of a hinge, and a hip in the world
constexpr const char* kLeg = R"(
parts:
  leg:
    nodes: {hip: [0, 0, 0], a: [0.3, 0, 0], b: [0.3, 0, 0], foot: [0.6, 0.1, 0], heel: {at_m: [0.6, 0, 0], fixed_to: foot}}
    pairs:
      - {name: upper, nodes: [hip, a], tags: [bone]}
      - {name: lower, nodes: [b, foot], tags: [bone]}
      - {name: knee, nodes: [a, b]}
structure:
  - {part: leg, at_m: [0.1, 0.2, 1], rotate: [{axis: [1, 2, 3], angle_rad: 0.7}, {axis: z, angle_rad: 0.4}]}
nodes: {hook: [0, 0.3, 1.5]}
pairs:
  - {name: muscle, nodes: [hook, leg.foot]}
builders:
  - {match: bone, rod: {radius_m: 0.01, mass_kg: 0.3, collides: false}}
  - {match: hook, anchor: {}}
  - {match: knee, joint: {kind: hinge, axis: [0.1, 1, 0.2], least_rad: -0.5, most_rad: 1.2, restitution: 0.3, friction_n_m: 0.01,
     stiffness_n_m_per_rad: 2, damping_n_m_s_per_rad: 0.1, rest_rad: 0.2, collides: true}}
  - {match: hip, support: {kind: HIP, axis: [0, 1, 0]}}
  - {match: muscle, cable: {stiffness_n_per_m: 100, damping_n_s_per_m: 2, rest_length_ratio: 0.9}}
)";

/// Four rods of class k, three of which meet in a and two in b, and one welded to a beam
constexpr const char* kPinned = R"(
nodes: {a: [0, 0, 1], b: [1, 0, 1], c: [0, 1, 1.1], d: [0, 0, 2], e: [1, 0.5, 1], m: {at_m: [0, 0.1, 1], fixed_to: a}}
pairs:
  - {tags: [rod], each: [[a, b], [b, c], [c, a], [a, d]]}
  - {name: beam, nodes: [b, e]}
  - {name: rope, nodes: [d, e]}
builders:
  - {match: rod, rod: {radius_m: 0.01, mass_kg: 0.5, class_k: true}}
  - {match: beam, rod: {radius_m: 0.02, density_kg_per_m3: 800}}
  - {match: d, support: {kind: ball}}
  - {match: rope, cable: {stiffness_n_per_m: 200, damping_n_s_per_m: 2, prestress_n: 3}}
apart: [[b-c, beam, a-d]]
)";

bool Same(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/// Compares the order of parts and the bodies, which determine the bits of a step in addition to
/// the state.
void ExpectTheSameInTheSameOrder(const ModelDef& a, const ModelDef& b) {
  ASSERT_EQ(a.bodies.size(), b.bodies.size());
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    const BodyDef &x = a.bodies[i], &y = b.bodies[i];
    EXPECT_EQ(x.mass_kg, y.mass_kg) << x.name;
    EXPECT_TRUE(Same(x.com_m, y.com_m)) << x.name;
    EXPECT_EQ(x.inertia_kg_m2.xx, y.inertia_kg_m2.xx) << x.name;
  }
  const auto order = [](const auto& parts) {
    std::vector<std::string> names;
    for (const auto& part : parts) names.push_back(part.name);
    return names;
  };
  EXPECT_EQ(order(a.bodies), order(b.bodies));
  EXPECT_EQ(order(a.capsules), order(b.capsules));
  EXPECT_EQ(order(a.spheres), order(b.spheres));
  EXPECT_EQ(order(a.nodes), order(b.nodes));
  EXPECT_EQ(order(a.cables), order(b.cables));
  EXPECT_EQ(order(a.joints), order(b.joints));
}

class ModelWriteJoints : public ExperimentFolder {
 protected:
  RobotSpec Robot(const std::string& path) const {
    Diagnostics out;
    const auto robot = LoadRobot(path, {}, out);
    EXPECT_TRUE(robot) << out.Format();
    return robot.value_or(RobotSpec{});
  }
  RobotSpec Described(const std::string& yaml) const {
    Write("robot.yaml", "taut: 1\nkind: model\nname: robot\n" + yaml);
    return Robot(Path("robot.yaml"));
  }
  static std::string Leg(const std::string& hip) {
    std::string yaml = kLeg;
    return yaml.replace(yaml.find("HIP"), 3, hip);
  }
  static std::string TextOf(const RobotSpec& robot) {
    Diagnostics out;
    const auto text = ModelYaml(robot, "", out);
    EXPECT_TRUE(text) << out.Format();
    return text.value_or("");
  }
  RobotSpec Back(const RobotSpec& robot) const {
    Write("written.yaml", TextOf(robot));
    return Robot(Path("written.yaml"));
  }

  static std::unique_ptr<WorldBatch> Run(const RobotSpec& robot, int steps) {
    Diagnostics out;
    const auto model = Model::Compile(robot.def, out);
    EXPECT_NE(model, nullptr) << out.Format();
    auto batch = std::make_unique<WorldBatch>(model, WorldBatchOptions{});
    batch->Step(1e-3, steps);
    EXPECT_EQ(batch->Status(0).bits, 0u);
    return batch;
  }
  static std::uint64_t Hash(const RobotSpec& robot) { return Run(robot, 400)->Hash(0); }

  /// Returns the robot in its pose after some steps.
  static RobotSpec Moved(const RobotSpec& robot, int steps) {
    const auto batch = Run(robot, steps);
    Pose pose;
    for (std::size_t b = 0; b < robot.def.bodies.size(); ++b) {
      pose.bodies.push_back(batch->Body(0, static_cast<int>(b)));
    }
    for (std::size_t c = 0; c < robot.def.cables.size(); ++c) {
      pose.rest_lengths_m.push_back(robot.def.cables[c].rest_length_m);
    }
    return RobotAt(robot, pose);
  }
};

TEST_F(ModelWriteJoints, AsDescribedARunOfEitherFileEndsInTheSameState) {
  for (const std::string& yaml : {Leg("hinge"), Leg("ball"), Leg("planar"), std::string(kPinned)}) {
    const RobotSpec robot = Described(yaml);
    const RobotSpec back = Back(robot);
    ExpectTheSameInTheSameOrder(robot.def, back.def);
    EXPECT_EQ(Hash(robot), Hash(back)) << TextOf(robot);
    EXPECT_EQ(TextOf(robot), TextOf(back));
  }
}

/// In the written file the cables between copies follow all others, so that forces are summed in
/// another order; writing again preserves the order.
TEST_F(ModelWriteJoints, ThePuppyComesBack) {
  const RobotSpec puppy = Robot(TAUT_SOURCE_DIR "/share/models/puppy.yaml");
  const RobotSpec back = Back(puppy);
  const auto a = Run(puppy, 200), b = Run(back, 200);
  for (int n = 0; n < static_cast<int>(puppy.def.nodes.size()); ++n) {
    EXPECT_LT(NodeDistance(a->NodePosition(0, n), b->NodePosition(0, n)), 1e-9);
  }
  const RobotSpec again = Back(back);
  ExpectTheSameInTheSameOrder(back.def, again.def);
  EXPECT_EQ(Hash(back), Hash(again));
}

TEST_F(ModelWriteJoints, InAnotherPoseAnglesAndSlidesGoOn) {
  for (const std::string& yaml : {Leg("hinge"), Leg("ball"), Leg("line"), Leg("cylindrical"),
                                  Leg("plane"), Leg("weld"), std::string(kPinned)}) {
    const RobotSpec robot = Described(yaml);
    const RobotSpec moved = Moved(robot, 300);
    const RobotSpec back = Back(moved);
    ASSERT_EQ(back.def.joints.size(), moved.def.joints.size());
    const auto a = Run(moved, 200), b = Run(back, 200), start = Run(back, 0), end = Run(robot, 300);
    for (std::size_t i = 0; i < moved.def.joints.size(); ++i) {
      std::size_t k = 0;
      while (back.def.joints[k].name != moved.def.joints[i].name) ++k;
      const int there = static_cast<int>(i), here = static_cast<int>(k);
      const bool is_pin = yaml == kPinned && moved.def.joints[i].name != "d";
      if (is_pin) continue;  // their angles restart at 0
      EXPECT_NEAR(start->Joint(0, here).coordinate, end->Joint(0, there).coordinate, 1e-10);
      EXPECT_NEAR(b->Joint(0, here).coordinate, a->Joint(0, there).coordinate, 1e-8)
          << moved.def.joints[i].name;
    }
    for (int n = 0; n < static_cast<int>(moved.def.nodes.size()); ++n) {
      int k = 0;
      while (back.def.nodes[static_cast<std::size_t>(k)].name !=
             moved.def.nodes[static_cast<std::size_t>(n)].name) {
        ++k;
      }
      EXPECT_LT(NodeDistance(a->NodePosition(0, n), b->NodePosition(0, k)), 1e-8);
    }
    // written once more it is the same robot to the last bit
    const RobotSpec again = Back(back);
    EXPECT_EQ(TextOf(back), TextOf(again));
    EXPECT_EQ(Hash(back), Hash(again));
  }
}

/// A part with a box has the box's orientation, and so have the axes of its joints.
TEST_F(ModelWriteJoints, AxesTurnWithAPartThatHasABox) {
  for (const char* hip : {"hinge", "cylindrical"}) {
    const RobotSpec robot =
        Described(Leg(hip) + "  - {match: heel, box: {size_m: [0.1, 0.05, 0.02], mass_kg: 0.1}}\n");
    const RobotSpec moved = Moved(robot, 300);
    const std::string text = TextOf(moved);
    EXPECT_THAT(text, HasSubstr("{part: leg, rotate: {quaternion: ["));
    EXPECT_THAT(text, HasSubstr("turned: {quaternion: ["));
    const RobotSpec back = Back(moved);
    ASSERT_EQ(back.def.joints.size(), 2u);
    const auto a = Run(moved, 200), b = Run(back, 200), start = Run(back, 0), end = Run(robot, 300);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t k = back.def.joints[i].name == moved.def.joints[i].name ? i : 1 - i;
      const int there = static_cast<int>(i), here = static_cast<int>(k);
      EXPECT_GT(std::fabs(end->Joint(0, there).coordinate), 1e-3);
      EXPECT_NEAR(start->Joint(0, here).coordinate, end->Joint(0, there).coordinate, 1e-10);
      EXPECT_NEAR(b->Joint(0, here).coordinate, a->Joint(0, there).coordinate, 1e-8);
    }
  }
}

TEST_F(ModelWriteJoints, ItSaysWhatPeopleWouldWrite) {
  const std::string leg = TextOf(Described(Leg("ball")));
  EXPECT_THAT(leg, HasSubstr("{name: knee, nodes: [a, b], tags: [joint_2]}"));
  EXPECT_THAT(leg, HasSubstr("{match: joint_2, joint: {kind: hinge, axis: ["));
  EXPECT_THAT(leg,
              HasSubstr("least_rad: -0.5, most_rad: 1.2, restitution: 0.3, friction_n_m: 0.01, "
                        "stiffness_n_m_per_rad: 2, damping_n_m_s_per_rad: 0.1, rest_rad: 0.2, "
                        "collides: true}}"));
  EXPECT_THAT(leg, HasSubstr("support: {kind: ball, axis: ["));
  EXPECT_THAT(leg, testing::Not(HasSubstr("turned")));
  const std::string pinned = TextOf(Described(kPinned));
  EXPECT_THAT(pinned, HasSubstr("rod: {radius_m: 0.01, class_k: true, mass_kg: 0.5"));
  EXPECT_THAT(pinned, HasSubstr(R"(apart: [["b-c", beam], ["b-c", "a-d"], [beam, "a-d"]])"));
}

TEST_F(ModelWriteJoints, ASupportThatHasSlidGetsANodeOfTheWorldWhereItWas) {
  const RobotSpec robot = Described(Leg("line"));
  const std::string text = TextOf(Moved(robot, 300));
  EXPECT_THAT(text, HasSubstr("hip_from: ["));
  EXPECT_THAT(text, HasSubstr("{name: hip, nodes: [hip_from, hip]"));
  EXPECT_THAT(text, testing::Not(HasSubstr("support")));
  EXPECT_THAT(TextOf(robot), HasSubstr("support: {kind: line"));
}

TEST_F(ModelWriteJoints, WhatAnExperimentMovesIsTheExperiments) {
  Write("robot.yaml", std::string("taut: 1\nkind: model\nname: robot\n") + kPinned);
  Write("shaken.yaml",
        "taut: 1\nkind: experiment\nname: shaken\nmodel: robot.yaml\nduration_s: 1\nterrain:\n"
        "  - {name: plate, box: {size_m: [1, 1, 0.1], center_m: [5, 0, 0]}}\nmotion:\n"
        "  - {name: shaker, of: plate, slide: {direction: [1, 0, 0], speed_m_per_s: [[0, 1]]}}\n"
        "  - {name: pull, of: beam, slide: {direction: [0, 1, 0], speed_m_per_s: [[0, 0.2]]}}\n");
  const ExperimentSpec experiment = Load("shaken.yaml");
  const RobotSpec& robot = experiment.robot;
  ASSERT_EQ(robot.def.motions.size(), 2u);
  const RobotSpec moved = Moved(robot, 250);
  const RobotSpec back = Back(moved);
  EXPECT_EQ(back.def.bodies.size() + 1, robot.def.bodies.size());  // the plate is terrain
  for (const BodyDef& body : back.def.bodies) EXPECT_FALSE(body.fixed) << body.name;
  for (std::size_t n = 0; n < back.def.nodes.size(); ++n) {
    EXPECT_LT(NodeDistance(back.def.nodes[n].position_m, moved.def.nodes[n].position_m), 1e-9);
  }
  // the beam was moved by 5 cm, and is written at its new place
  const std::size_t e = 4;
  EXPECT_EQ(back.def.nodes[e].name, "e");
  EXPECT_NEAR(back.def.nodes[e].position_m.y, 0.5 + 0.2 * 0.25, 1e-9);
}

TEST_F(ModelWriteJoints, AJointBesideItsNodesIsRefused) {
  RobotSpec robot = Described(Leg("ball"));
  for (JointDef& joint : robot.def.joints) {
    joint.from_m.z += 0.01, joint.to_m.z += 0.01;
  }
  Diagnostics out;
  EXPECT_FALSE(ModelYaml(robot, "", out));
  EXPECT_THAT(out.Format(), HasSubstr("the joint \"leg.knee\" is not between nodes (give both of "
                                      "its bodies a node at the joint)"));
}

TEST_F(ModelWriteJoints, TurnedIsOfTheKind) {
  const std::string leg = R"(
nodes: {hip: [0, 0, 0], a: [1, 0, 0], b: [1, 0, 0], foot: [2, 0, 0]}
pairs: [{nodes: [hip, a], tags: [rod]}, {nodes: [b, foot], tags: [rod]}, {name: knee, nodes: [a, b]}]
builders:
  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}
)";
  const auto with = [&](const std::string& joint) {
    Write("robot.yaml", "taut: 1\nkind: model\nname: robot\n" + leg + "  - {match: knee, joint: {" +
                            joint + "}}\n");
    Diagnostics out;
    const auto robot = LoadRobot(Path("robot.yaml"), {}, out);
    return std::pair(robot, out.Format());
  };
  const auto [good, none] = with("kind: hinge, axis: [0, 1, 0], turned: {axis: y, angle_rad: 0.3}");
  ASSERT_TRUE(good) << none;
  EXPECT_NEAR(Run(*good, 0)->Joint(0, 0).coordinate, 0.3, 1e-15);
  for (const char* kind : {"hinge, axis: [0, 1, 0]", "weld", "prismatic, axis: [0, 1, 0]"}) {
    const auto [bad, why] =
        with("kind: " + std::string(kind) + ", turned: {axis: x, angle_rad: 0.3}");
    EXPECT_FALSE(bad) << kind;
    EXPECT_THAT(why, HasSubstr("robot.yaml:6:"));
    EXPECT_THAT(why, HasSubstr("does not leave the rotation in `turned` free (hinge"));
  }
}

}  // namespace
}  // namespace taut::test
