// Joint loads at the start (taut/statics.h) against statics by hand and against the first step.
#include <numbers>

#include <gtest/gtest.h>

#include "taut/statics.h"
#include "tests/physics/joint_scenes.h"

namespace taut::test {
namespace {

JointDef Pin(int a, int b, const Vec3& at, JointKind kind = JointKind::kBall) {
  JointDef joint;
  joint.name = "joint " + std::to_string(a) + " " + std::to_string(b);
  joint.kind = kind, joint.body_a = a, joint.body_b = b, joint.from_m = joint.to_m = at;
  return joint;
}
double MostLeft(const ModelDef& def, const std::vector<JointLoad>& loads) {
  double most = 0;
  for (const LeftLoad& left : LeftAtStart(def, loads)) {
    most = std::max({most, Norm(left.force_n), Norm(left.torque_n_m)});
  }
  return most;
}

TEST(JointLoads, APinnedRodOnACableIsHeldAsByHand) {
  // A level rod of 3 kg and 2 m; a cable from its end to the wall, 1.5 m above the pin: T 0.6 2 = m
  // g 1.
  for (const JointKind kind : {JointKind::kBall, JointKind::kHinge}) {
    ModelDef def;
    scenes::AddRod(def, "rod", 3.0, 0.01, {}, {2, 0, 0}, {});
    def.joints.push_back(Pin(kWorld, 0, {}, kind));
    def.joints[0].axis = {0, 1, 0};
    const double tension = 3 * kG / 1.2, k = 1e4;
    def.cables.push_back(
        {"stay", {{0, {2, 0, 0}}, {kWorld, {0, 0, 1.5}}}, k, 0.0, 2.5 - tension / k, {}, {}});
    const auto loads = StartJointLoads(def);
    ASSERT_EQ(loads.size(), 1u);
    EXPECT_LT(Distance(loads[0].force_n, {0.8 * tension, 0, 3 * kG / 2}), 1e-9);
    EXPECT_LT(Norm(loads[0].torque_n_m), 1e-9);
    EXPECT_LT(MostLeft(def, loads), 1e-9);
  }
}

TEST(JointLoads, AnArchOfTwoRodsThrustsOutwards) {
  // Span 2 a, rise h: a thrust of w a / 2 h and the weight w of a rod at each foot.
  const double a = 1.2, h = 0.5, w = 2 * kG, thrust = w * a / (2 * h);
  ModelDef def;
  scenes::AddRod(def, "left", 2.0, 0.01, {-a, 0, 0}, {0, 0, h}, {});
  scenes::AddRod(def, "right", 2.0, 0.01, {0, 0, h}, {a, 0, 0}, {});
  def.joints = {Pin(kWorld, 0, {-a, 0, 0}), Pin(0, 1, {0, 0, h}), Pin(kWorld, 1, {a, 0, 0})};
  const auto loads = StartJointLoads(def);
  EXPECT_LT(Distance(loads[0].force_n, {thrust, 0, w}), 1e-9);
  EXPECT_LT(Distance(loads[1].force_n, {thrust, 0, 0}), 1e-9);
  EXPECT_LT(Distance(loads[2].force_n, {-thrust, 0, w}), 1e-9);
  EXPECT_LT(MostLeft(def, loads), 1e-9);
}

TEST(JointLoads, WhatTwoSupportsMayShareTheyShare) {
  // Between two ball joints the force along the rod is indeterminate: the result is zero.
  ModelDef def;
  scenes::AddRod(def, "beam", 4.0, 0.01, {-1, 0, 0}, {1, 0, 0}, {});
  def.joints = {Pin(kWorld, 0, {-1, 0, 0}), Pin(kWorld, 0, {1, 0, 0})};
  for (const JointLoad& load : StartJointLoads(def)) {
    EXPECT_LT(Distance(load.force_n, {0, 0, 2 * kG}), 1e-9);
  }
}

TEST(JointLoads, AClampedBeamTurnsItsWall) {
  ModelDef def;
  scenes::AddRod(def, "beam", 2.0, 0.01, {}, {1, 0, 0}, {});
  def.joints.push_back(Pin(kWorld, 0, {}, JointKind::kWeld));
  const auto loads = StartJointLoads(def);
  EXPECT_LT(Distance(loads[0].force_n, {0, 0, 2 * kG}), 1e-9);
  EXPECT_LT(Distance(loads[0].torque_n_m, {0, -kG, 0}), 1e-9);
  EXPECT_LT(MostLeft(def, loads), 1e-9);
}

TEST(JointLoads, ARodThatIsLetGoLevelPullsWithAQuarterOfItsWeight) {
  const ModelDef def = Pendulum(std::numbers::pi / 2);
  const auto loads = StartJointLoads(def);
  EXPECT_LT(Distance(loads[0].force_n, {0, 0, kG / 4}), 1e-5);  // the rod has a radius of 1 mm
  EXPECT_NEAR(LeftAtStart(def, loads)[0].force_n.z, -0.75 * kG, 1e-5);
}

TEST(JointLoads, ASpringHoldsWhatItIsWoundUpFor) {
  // The weight of a level rod exerts the torque m g / 2 about y.
  for (const JointKind kind : {JointKind::kHinge, JointKind::kBall}) {
    ModelDef def = Pendulum(std::numbers::pi / 2, kind);
    JointDef& j = def.joints[0];
    j.stiffness = 10;
    const double angle = 0.05 * kG;
    if (kind == JointKind::kHinge) {
      j.rest = -angle;
    } else {
      j.turned = {std::cos(angle / 2), 0, std::sin(angle / 2), 0};
    }
    const auto loads = StartJointLoads(def);
    EXPECT_LT(Distance(loads[0].torque_n_m, {0, -kG / 2, 0}), 1e-9);
    EXPECT_LT(MostLeft(def, loads), 1e-9);
  }
}

TEST(JointLoads, ThoseOfEveryKindAreThoseOfTheFirstMoment) {
  const Vec3 n{2.0 / 7, 3.0 / 7, 6.0 / 7};
  for (const JointKind kind : {JointKind::kBall, JointKind::kHinge, JointKind::kWeld,
                               JointKind::kPrismatic, JointKind::kCylindrical, JointKind::kPlanar,
                               JointKind::kLine, JointKind::kPlane, JointKind::kDistance}) {
    // Three rods in a row from the world, the middle one on the joint; a cable pulls at the last
    // rod.
    ModelDef def = Chain(3, {0.1, 0.2, 0.05}, 2);
    def.bodies[1].inertia_kg_m2 = {0.01, 0.02, 0.015, 1e-3, 2e-3, -1e-3};
    JointDef& j = def.joints[1];
    j.kind = kind, j.axis = n, j.stiffness = HasCoordinate(kind) ? 3 : 0;
    if (kind == JointKind::kDistance) j.from_m = j.from_m + Vec3{0.1, 0, 0}, j.stiffness = 0;
    if (kind == JointKind::kHinge || kind == JointKind::kLine) j.rest = 0.2;
    def.cables.push_back(
        {"pull", {{2, {0.3, 0.6, 0.15}}, {kWorld, {1, 0, 2}}}, 100, 0.0, 1.5, {}, {}});
    const auto loads = StartJointLoads(def);
    WorldBatch world = MakeBatch(def);
    world.Step(1e-6);
    for (int i = 0; i < 3; ++i) {
      const JointState now = world.Joint(0, i);
      EXPECT_LT(Distance(loads[static_cast<std::size_t>(i)].force_n, now.force_n), 1e-4)
          << static_cast<int>(kind) << " " << i;
      EXPECT_LT(Distance(loads[static_cast<std::size_t>(i)].torque_n_m, now.torque_n_m), 1e-4)
          << static_cast<int>(kind) << " " << i;
    }
  }
}

TEST(JointLoads, TooManyAreNotWorkedOut) {
  EXPECT_EQ(StartJointLoads(Chain(64, {0, 0, -0.1}, 1000)).size(), 64u);
  EXPECT_NEAR(StartJointLoads(Chain(64, {0, 0, -0.1}, 1000))[0].force_n.z, 1063 * kG, 1e-6);
  EXPECT_TRUE(StartJointLoads(Chain(667, {0, 0, -0.1}, 1)).empty());
}

}  // namespace
}  // namespace taut::test
