// Robots written as model files, and read back
#include <cmath>

#include "math/vec.h"
#include "taut/start.h"
#include "taut/world_batch.h"
#include "unit/description/experiment_fixture.h"
#include "unit/scenes/heap_models.h"

namespace taut::test {
namespace {

double Distance(const Vec3& a, const Vec3& b) { return std::sqrt(Dot(a - b, a - b)); }

class ModelWrite : public ExperimentFolder {
 protected:
  ModelWrite() {
    Write("prism.yaml", kPrism);
    Write("stands.yaml", kSettledPrism);
  }

  RobotSpec Robot(const std::string& path, const Overrides& overrides = {}) const {
    Diagnostics out;
    const auto robot = LoadRobot(path, overrides, out);
    EXPECT_TRUE(robot) << out.Format();
    return robot.value_or(RobotSpec{});
  }
  RobotSpec Described(const std::string& yaml) const {
    Write("robot.yaml", "taut: 1\nkind: model\nname: robot\n" + yaml);
    return Robot(Path("robot.yaml"));
  }

  /// Returns the robot in another pose with individually rotated bodies.
  static RobotSpec Moved(const RobotSpec& robot) {
    Pose pose;
    for (std::size_t b = 0; b < robot.def.bodies.size(); ++b) {
      const double i = 1.0 + static_cast<double>(b);
      Quat q{1.0, 0.1 * i, -0.2, 0.05 * i};
      const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
      q = {q.w / length, q.x / length, q.y / length, q.z / length};
      const Vec3 by{0.01 * i, -0.02, 0.03 * i};
      pose.bodies.push_back({robot.def.bodies[b].com_m + by, q, {1, 2, 3}, {}});
    }
    for (const CableDef& cable : robot.def.cables) {
      pose.rest_lengths_m.push_back(0.9 * cable.rest_length_m);
    }
    return RobotAt(robot, pose);
  }

  /// Writes the robot's model file and reads it back.
  RobotSpec Back(const RobotSpec& robot) const {
    Diagnostics out;
    const auto text = ModelYaml(robot, "Two lines\nof heading.", out);
    EXPECT_TRUE(text) << out.Format();
    if (!text) return {};
    EXPECT_TRUE(text->starts_with("# Two lines\n# of heading.\ntaut: 1\nkind: model\n")) << *text;
    Write("written.yaml", *text);
    return Robot(Path("written.yaml"));
  }

  static std::string Refused(const RobotSpec& robot) {
    Diagnostics out;
    EXPECT_FALSE(ModelYaml(robot, "", out));
    return out.Format();
  }
};

/// Compares properties to 1e-12; cables and nodes by name.
void ExpectSame(const RobotSpec& a, const RobotSpec& b) {
  ASSERT_EQ(a.def.bodies.size(), b.def.bodies.size());
  for (std::size_t i = 0; i < a.def.bodies.size(); ++i) {
    const BodyDef &x = a.def.bodies[i], &y = b.def.bodies[i];
    EXPECT_EQ(x.name, y.name);
    EXPECT_NEAR(x.mass_kg, y.mass_kg, 1e-12);
    EXPECT_LT(Distance(x.com_m, y.com_m), 1e-12) << x.name;
    const Inertia &p = x.inertia_kg_m2, &q = y.inertia_kg_m2;
    for (const double off :
         {p.xx - q.xx, p.yy - q.yy, p.zz - q.zz, p.xy - q.xy, p.xz - q.xz, p.yz - q.yz}) {
      EXPECT_NEAR(off, 0, 1e-12 * (p.xx + p.yy + p.zz)) << x.name;
    }
  }
  for (std::size_t i = 0; i < a.def.nodes.size(); ++i) {
    const NodeDef& x = a.def.nodes[i];
    bool found = false;
    for (std::size_t k = 0; k < b.def.nodes.size(); ++k) {
      if (b.def.nodes[k].name != x.name) continue;
      found = true;
      EXPECT_LT(Distance(x.position_m, b.def.nodes[k].position_m), 1e-12) << x.name;
      EXPECT_EQ(x.body, b.def.nodes[k].body) << x.name;
      EXPECT_EQ(std::set<std::string>(a.node_tags[i].begin(), a.node_tags[i].end()),
                std::set<std::string>(b.node_tags[k].begin(), b.node_tags[k].end()));
    }
    EXPECT_TRUE(found) << x.name;
  }
  ASSERT_EQ(a.def.cables.size(), b.def.cables.size());
  for (std::size_t i = 0; i < a.def.cables.size(); ++i) {
    const CableDef &x = a.def.cables[i], &y = b.def.cables[i];
    EXPECT_EQ(x.name, y.name);
    EXPECT_NEAR(x.rest_length_m, y.rest_length_m, 1e-12) << x.name;
    EXPECT_EQ(x.stiffness_n_per_m, y.stiffness_n_per_m);
    EXPECT_EQ(x.damping_n_s_per_m, y.damping_n_s_per_m);
    EXPECT_EQ(x.actuator.kind, y.actuator.kind);
    EXPECT_EQ(x.actuator.max_speed_m_per_s, y.actuator.max_speed_m_per_s);
    ASSERT_EQ(x.attachments.size(), y.attachments.size());
    for (std::size_t k = 0; k < x.attachments.size(); ++k) {
      EXPECT_LT(Distance(x.attachments[k].position_m, y.attachments[k].position_m), 1e-12);
      EXPECT_EQ(x.attachments[k].body, y.attachments[k].body);
    }
  }
  EXPECT_EQ(a.def.capsules.size(), b.def.capsules.size());
  EXPECT_EQ(a.def.spheres.size(), b.def.spheres.size());
  EXPECT_EQ(a.def.boxes.size(), b.def.boxes.size());
  EXPECT_EQ(a.def.friction_combine, b.def.friction_combine);
  EXPECT_EQ(a.def.restitution_combine, b.def.restitution_combine);
}

TEST_F(ModelWrite, EveryModelOfOursComesBackInAnotherPose) {
  for (const char* name : {"prism3", "six_strut", "tetraspine3", "tetraspine12", "hanging_mass"}) {
    SCOPED_TRACE(name);
    const RobotSpec moved =
        Moved(Robot(std::string(TAUT_SOURCE_DIR "/share/models/") + name + ".yaml"));
    ExpectSame(moved, Back(moved));
  }
}

TEST_F(ModelWrite, TheSettledRobotIsAtRestWhenItIsLoaded) {
  Diagnostics out;
  ExperimentSpec experiment = Load("stands.yaml");
  const auto settled = FindSettledStart(experiment, out);
  ASSERT_TRUE(settled) << out.Format();
  const RobotSpec robot = RobotAt(experiment.robot, settled->pose);
  ExperimentSpec again = experiment;
  again.robot.def = Back(robot).def;
  again.robot.def.planes = experiment.robot.def.planes;
  const auto model = Model::Compile(again.robot.def, out);
  ASSERT_TRUE(model) << out.Format();
  WorldBatch batch(model, {});
  batch.Step(0.001, 1000);
  for (std::size_t n = 0; n < again.robot.def.nodes.size(); ++n) {
    const int node = static_cast<int>(n);
    EXPECT_LT(Distance(batch.NodeVelocity(0, node), {}), 1e-6);
    EXPECT_LT(Distance(batch.NodePosition(0, node), robot.def.nodes[n].position_m), 1e-6);
  }
}

TEST_F(ModelWrite, BoxesTurnWithTheirPart) {
  const RobotSpec robot = Described(R"(
parts:
  cart:
    nodes: {middle: [0, 0, 1], hook: {at_m: [0.5, 0, 1], fixed_to: middle}}
  bar:
    nodes: {back: [0, 1, 1], front: [1, 1, 1.5]}
    pairs: [{name: beam, nodes: [back, front]}]
structure: [{part: cart}, {part: bar, rotate: {axis: z, angle_rad: 0.5}}]
pairs: [{name: rope, nodes: [cart.hook, bar.back]}]
builders:
  - {match: middle, box: {size_m: [0.3, 0.2, 0.1], density_kg_per_m3: 500, static_friction: 0.7, kinetic_friction: 0.4}}
  - {match: beam, box: {width_m: 0.04, height_m: 0.02, mass_kg_per_m: 2, collides: false}}
  - {match: rope, cable: {stiffness_n_per_m: 100, rest_length_ratio: 0.9, damping_law: clamped, actuator: {ideal: true}}}
)");
  const RobotSpec moved = Moved(robot);
  const RobotSpec back = Back(moved);
  ExpectSame(moved, back);
  for (std::size_t i = 0; i < moved.def.boxes.size() && i < back.def.boxes.size(); ++i) {
    const Vec3 x{1, 0, 0}, y{0, 1, 0};
    const Quat &p = moved.def.boxes[i].orientation, &q = back.def.boxes[i].orientation;
    EXPECT_LT(Distance(Rotate(p, x), Rotate(q, x)), 1e-12);
    EXPECT_LT(Distance(Rotate(p, y), Rotate(q, y)), 1e-12);
    EXPECT_EQ(moved.def.boxes[i].collides, back.def.boxes[i].collides);
  }
}

TEST_F(ModelWrite, RobotsOfOneRodABodyComeBackFromAResolvedExperiment) {
  Write("inputs.yaml", ResolvedYaml(Load("stands.yaml")));
  const RobotSpec moved = Moved(Load("inputs.yaml").robot);
  ExpectSame(moved, Back(moved));
}

TEST_F(ModelWrite, WhatAModelFileCannotSayIsRefusedByName) {
  RobotSpec robot = Robot(TAUT_SOURCE_DIR "/share/models/tetraspine3.yaml");
  robot.solids.reset();
  EXPECT_NE(
      Refused(robot).find("error: a model file cannot describe this robot completely: the masses "
                          "of the parts of the body \"segment_0\" are not known (use the original "
                          "experiment: inputs.yaml has only masses of whole bodies"),
      std::string::npos)
      << Refused(robot);

  robot = Robot(Path("prism.yaml"));
  robot.solids->bounding_box_inertia = true;
  EXPECT_NE(Refused(robot).find("(`inertia: bounding_box`)"), std::string::npos);

  robot = Robot(Path("prism.yaml"));
  robot.def.capsules[0].from_m.x += 0.01;
  EXPECT_NE(Refused(robot).find("the rod \"strut_0.bottom-top\" does not end at nodes"),
            std::string::npos)
      << Refused(robot);

  robot = Robot(Path("prism.yaml"));
  robot.def.bodies[1].mass_kg *= 1.001;  // differs from its shapes' mass
  EXPECT_NE(Refused(robot).find("the body \"strut_1\" would have a different mass"),
            std::string::npos)
      << Refused(robot);

  const RobotSpec box = Described(R"(
nodes: {a: [0, 0, 0], b: [1, 0, 0]}
pairs: [{nodes: [a, b]}]
builders:
  - {match: a, box: {size_m: [0.1, 0.1, 0.2], mass_kg: 1}}
  - {match: b, sphere: {radius_m: 0.1, mass_kg: 1}}
  - {match: [a-b], cable: {stiffness_n_per_m: 100, prestress_n: 1}}
)");
  ExpectSame(Moved(box), Back(Moved(box)));  // a box at a node may be rotated
}

}  // namespace
}  // namespace taut::test
