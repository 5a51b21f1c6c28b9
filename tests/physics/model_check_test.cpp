/// Diagnostics of Model::Compile: every invalid number is reported with the name of its element.

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "taut/world_batch.h"
#include "tests/constants.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/block_on_slope.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns a valid model with one element of each kind.
ModelDef Good() {
  ModelDef def = scenes::BlockOnSlope().Def();
  scenes::AddRod(def, "rod", 0.1, 0.01, {0, 0, 1}, {1, 0, 1}, {});
  def.spheres.push_back({"ball", 1, {0, 0, 1}, 0.02, {}});
  def.terrain_boxes.push_back({"wall", {5, 0, 0}, {}, {1, 1, 1}, {}});
  CableDef cable;
  cable.name = "stay";
  cable.attachments = {{kWorld, {0, 0, 2}}, {1, {0, 0, 1}}};
  cable.stiffness_n_per_m = 100;
  cable.rest_length_m = 0.9;
  cable.actuator.kind = ActuatorDef::Kind::kLimited;
  cable.actuator.max_speed_m_per_s = kInfinity;
  cable.actuator.max_acceleration_m_per_s2 = kInfinity;
  cable.actuator.max_force_n = kInfinity;
  def.cables.push_back(cable);
  return def;
}

struct Mistake {
  const char* complaint;
  std::function<void(ModelDef&)> make;
};

const std::vector<Mistake>& Mistakes() {
  static const std::vector<Mistake> mistakes{
      {"gravity must be finite", [](ModelDef& d) { d.gravity_m_per_s2.x = kNan; }},
      {"rod rod: area must be zero or a positive number",
       [](ModelDef& d) { d.capsules[0].member.area_m2 = kNan; }},
      {"rod rod: thermal expansion must be finite",
       [](ModelDef& d) { d.capsules[0].member.expansion_per_k = kInfinity; }},
      {"cable stay: Young's modulus must be zero or a positive number",
       [](ModelDef& d) { d.cables[0].member.young_pa = -1; }},
      {"cable stay: strength must be zero or a positive number",
       [](ModelDef& d) { d.cables[0].member.strength_n = kInfinity; }},
      {"cable stay: member mass must be zero or a positive number",
       [](ModelDef& d) { d.cables[0].member.mass_kg = -1e-9; }},
      {"rod rod: yield stress must be zero or a positive number",
       [](ModelDef& d) { d.capsules[0].member.yield_pa = -1; }},
      {"rod rod: second moment of area must be zero or a positive number",
       [](ModelDef& d) { d.capsules[0].member.second_moment_m4 = -1; }},
      {"rod rod: buckling length must be zero or a positive number",
       [](ModelDef& d) { d.capsules[0].member.buckling_length_m = -1; }},
      {"body block: mass must be a positive number", [](ModelDef& d) { d.bodies[0].mass_kg = 0; }},
      {"body rod: mass must be a positive number", [](ModelDef& d) { d.bodies[1].mass_kg = -1; }},
      {"body rod: mass must be a positive number", [](ModelDef& d) { d.bodies[1].mass_kg = kNan; }},
      {"body rod: mass must be a positive number",
       [](ModelDef& d) { d.bodies[1].mass_kg = kInfinity; }},
      {"body block: center of mass must be finite",
       [](ModelDef& d) { d.bodies[0].com_m.z = kNan; }},
      {"body block: velocity must be finite",
       [](ModelDef& d) { d.bodies[0].velocity_m_per_s.y = kInfinity; }},
      {"body block: angular velocity must be finite",
       [](ModelDef& d) { d.bodies[0].angular_velocity_rad_per_s.x = kNan; }},
      {"body block: each principal moment of inertia must be a positive number",
       [](ModelDef& d) { d.bodies[0].inertia_kg_m2 = {}; }},
      {"body block: each principal moment of inertia must be a positive number",
       [](ModelDef& d) { d.bodies[0].inertia_kg_m2 = {1, 1, 1, 2, 0, 0}; }},  // 1 - 2 < 0
      {"body block: each principal moment of inertia must be a positive number",
       [](ModelDef& d) { d.bodies[0].inertia_kg_m2.xy = kNan; }},
      {"sphere ball refers to a body that does not exist",
       [](ModelDef& d) { d.spheres[0].body = 2; }},
      {"sphere ball refers to a body that does not exist",
       [](ModelDef& d) { d.spheres[0].body = -2; }},
      {"sphere ball: center must be finite", [](ModelDef& d) { d.spheres[0].center_m.x = kNan; }},
      {"sphere ball: radius must be a positive number",
       [](ModelDef& d) { d.spheres[0].radius_m = 0; }},
      {"sphere ball: kinetic friction must be zero or a positive number",
       [](ModelDef& d) { d.spheres[0].material.kinetic_friction = -0.1; }},
      {"sphere ball: static friction must be zero or a positive number",
       [](ModelDef& d) { d.spheres[0].material.static_friction = kNan; }},
      {"sphere ball: static friction must not be below kinetic friction",
       [](ModelDef& d) { d.spheres[0].material.static_friction = 0.4; }},
      {"sphere ball: restitution must be within 0..1",
       [](ModelDef& d) { d.spheres[0].material.restitution = 1.1; }},
      {"sphere ball: restitution must be within 0..1",
       [](ModelDef& d) { d.spheres[0].material.restitution = -0.1; }},
      {"rod rod refers to a body that does not exist", [](ModelDef& d) { d.capsules[0].body = 7; }},
      {"rod rod: end must be finite", [](ModelDef& d) { d.capsules[0].from_m.y = kNan; }},
      {"rod rod: end must be finite", [](ModelDef& d) { d.capsules[0].to_m.y = kInfinity; }},
      {"rod rod: radius must be a positive number",
       [](ModelDef& d) { d.capsules[0].radius_m = -1; }},
      {"rod rod: restitution must be within 0..1",
       [](ModelDef& d) { d.capsules[0].material.restitution = kNan; }},
      {"box block refers to a body that does not exist", [](ModelDef& d) { d.boxes[0].body = 2; }},
      {"box block: center must be finite", [](ModelDef& d) { d.boxes[0].center_m.x = kNan; }},
      {"box block: the orientation must be a unit quaternion",
       [](ModelDef& d) {
         d.boxes[0].orientation = {0, 0, 0, 0};
       }},
      {"box block: the orientation must be a unit quaternion",
       [](ModelDef& d) { d.boxes[0].orientation.x = kNan; }},
      {"box block: half extent must be a positive number",
       [](ModelDef& d) { d.boxes[0].half_extents_m.y = 0; }},
      {"box block: static friction must not be below kinetic friction",
       [](ModelDef& d) { d.boxes[0].material.kinetic_friction = 0.6; }},
      {"terrain box wall: center must be finite",
       [](ModelDef& d) { d.terrain_boxes[0].center_m.x = kNan; }},
      {"terrain box wall: the orientation must be a unit quaternion",
       [](ModelDef& d) {
         d.terrain_boxes[0].orientation = {2, 0, 0, 0};
       }},
      {"terrain box wall: half extent must be a positive number",
       [](ModelDef& d) { d.terrain_boxes[0].half_extents_m.z = -1; }},
      {"terrain box wall: restitution must be within 0..1",
       [](ModelDef& d) { d.terrain_boxes[0].material.restitution = 2; }},
      {"the model has more than 8 planes", [](ModelDef& d) { d.planes.resize(9, d.planes[0]); }},
      {"plane slope: point must be finite", [](ModelDef& d) { d.planes[0].point_m.x = kNan; }},
      {"plane slope: the normal must be a unit vector",
       [](ModelDef& d) {
         d.planes[0].normal = {0, 0, 2};
       }},
      {"plane slope: the normal must be a unit vector",
       [](ModelDef& d) { d.planes[0].normal.x = kNan; }},
      {"plane slope: kinetic friction must be zero or a positive number",
       [](ModelDef& d) { d.planes[0].material.kinetic_friction = kInfinity; }},
      {"node block refers to a body that does not exist", [](ModelDef& d) { d.nodes[0].body = 9; }},
      {"node block: position must be finite", [](ModelDef& d) { d.nodes[0].position_m.x = kNan; }},
      {"cable stay needs two attachments or more",
       [](ModelDef& d) { d.cables[0].attachments.resize(1); }},
      {"cable stay refers to a body that does not exist",
       [](ModelDef& d) { d.cables[0].attachments[1].body = 2; }},
      {"cable stay: attachment must be finite",
       [](ModelDef& d) { d.cables[0].attachments[0].position_m.z = kNan; }},
      {"cable stay: stiffness must be a positive number",
       [](ModelDef& d) { d.cables[0].stiffness_n_per_m = 0; }},
      {"cable stay: damping must be zero or a positive number",
       [](ModelDef& d) { d.cables[0].damping_n_s_per_m = -1; }},
      {"cable stay: rest length must be a positive number",
       [](ModelDef& d) { d.cables[0].rest_length_m = 0; }},
      {"cable stay: largest speed must be positive",
       [](ModelDef& d) { d.cables[0].actuator.max_speed_m_per_s = 0; }},
      {"cable stay: largest acceleration must be positive",
       [](ModelDef& d) { d.cables[0].actuator.max_acceleration_m_per_s2 = kNan; }},
      {"cable stay: largest force must be positive",
       [](ModelDef& d) { d.cables[0].actuator.max_force_n = -5; }},
      {"cable stay: smallest rest length must be zero or a positive number",
       [](ModelDef& d) { d.cables[0].actuator.min_rest_length_m = -1; }},
      {"cable stay: smallest length must be zero or a positive number",
       [](ModelDef& d) { d.cables[0].actuator.min_length_m = kNan; }},
  };
  return mistakes;
}

TEST(ModelCheck, AGoodModelCompilesWithoutComplaints) {
  Diagnostics complaints;
  const auto model = Model::Compile(Good(), complaints);
  ASSERT_NE(model, nullptr);
  EXPECT_TRUE(complaints.ok());
  EXPECT_EQ(model->def().bodies.size(), 2u);
  EXPECT_NE(Model::Compile({}, complaints), nullptr) << "an empty world is a world";
}

TEST(ModelCheck, EveryMistakeHasItsSentence) {
  for (const Mistake& mistake : Mistakes()) {
    ModelDef def = Good();
    mistake.make(def);
    Diagnostics complaints;
    EXPECT_FALSE(Model::Compile(def, complaints)) << mistake.complaint;
    bool found = false;
    for (const Diagnostic& d : complaints.items()) found = found || d.what == mistake.complaint;
    EXPECT_TRUE(found) << "expected: " << mistake.complaint << "\ngot: " << complaints.Format();
  }
}

TEST(ModelCheck, AllMistakesAreToldAtOnce) {
  ModelDef def = Good();
  def.bodies[0].mass_kg = -1;
  def.spheres[0].radius_m = 0;
  def.cables[0].stiffness_n_per_m = kNan;
  Diagnostics complaints;
  EXPECT_EQ(Model::Compile(def, complaints), nullptr);
  EXPECT_EQ(complaints.items().size(), 3u);
}

TEST(ModelCheck, SizesThatGrowWithTheSquareOfAModelHaveLimits) {
  // The limit is 10^7 pairs, between 3162^2 and 3163^2 pairs of cables. The other model has a body
  // of 5000 spheres, which may touch 2000 boxes.
  ModelDef cables = Good();
  cables.cables.resize(3162, cables.cables[0]);
  ModelDef one_more = cables;
  one_more.cables.push_back(one_more.cables[0]);
  ModelDef shapes = Good();
  shapes.spheres.resize(5000, shapes.spheres[0]);
  shapes.boxes.resize(2000, shapes.boxes[0]);
  const auto complaint = [](const ModelDef& def) {
    Diagnostics complaints;
    return Model::Compile(def, complaints) == nullptr ? complaints.Format() : std::string();
  };
  EXPECT_EQ(complaint(one_more), "error: more than 10000000 pairs of cables share a body\n");
  EXPECT_EQ(complaint(shapes),
            "error: more than 10000000 pairs of shapes may collide with static shapes or between "
            "two bodies: exclude shapes that cannot meet\n");
  // 20 000 balls have 199 990 000 pairs, 20 001 have 200 010 000.
  ModelDef balls;
  for (int i = 0; i <= 20'000; ++i) {
    scenes::AddBall(balls, "ball_" + std::to_string(i), 1.0, 0.1, {1.0 * i, 0, 0}, {});
  }
  EXPECT_EQ(complaint(balls),
            "error: more than 200000000 pairs of shapes of moving bodies may collide: exclude "
            "shapes that cannot meet\n");
  balls.spheres.back().collides = false;
  EXPECT_EQ(complaint(balls), "");
  for (BoxDef& box : shapes.boxes) box.collides = false;
  for (SphereDef& sphere : shapes.spheres) sphere.collides = false;
  EXPECT_EQ(complaint(shapes), "");
}

TEST(ModelCheck, AFixedBodyNeedsNeitherMassNorInertia) {
  ModelDef def = Good();
  def.bodies[0].fixed = true;
  def.bodies[0].mass_kg = 0;
  def.bodies[0].inertia_kg_m2 = {};
  Diagnostics complaints;
  EXPECT_NE(Model::Compile(def, complaints), nullptr) << complaints.Format();
}

TEST(ModelCheck, AnActuatorsNumbersCountOnlyIfItHasLimits) {
  ModelDef def = Good();
  def.cables[0].actuator = {};  // no actuator: no limits given
  Diagnostics complaints;
  EXPECT_NE(Model::Compile(def, complaints), nullptr) << complaints.Format();
}

}  // namespace
}  // namespace taut::test
