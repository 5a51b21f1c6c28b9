// Friction, springs and dampers of ball joints against closed forms (docs/theory/joints.md, section
// 5). They act equally about all axes, for any direction of the joint's axis.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/physics/joint_scenes.h"

namespace taut::test {
namespace {

constexpr double kInertia = 0.01;                ///< [kg m^2]
const Vec3 kSkew{2.0 / 7, 3.0 / 7, 6.0 / 7};     ///< Unit vector that is oblique to the coordinate
                                                 ///< axes.
const Vec3 kAcross{6.0 / 7, 2.0 / 7, -3.0 / 7};  ///< Unit vector at right angles to `kSkew`.

/// Returns a ball of 1 kg that rotates about its center in zero gravity, on a joint with a skew
/// axis.
ModelDef BallOnBall(const Vec3& spin_rad_per_s) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  scenes::AddRod(def, "body", 1.0, 0.05, {-0.1, 0, 0}, {0.1, 0, 0}, {});
  def.bodies[0].inertia_kg_m2 = {kInertia, kInertia, kInertia, 0, 0, 0};
  def.bodies[0].angular_velocity_rad_per_s = spin_rad_per_s;
  JointDef joint;
  joint.name = "joint", joint.axis = {0.6, 0, 0.8};
  def.joints.push_back(joint);
  return def;
}
Vec3 Spin(const WorldBatch& world, int body = 0) {
  return world.Body(0, body).angular_velocity_rad_per_s;
}

TEST(BallTurn, ADamperSlowsASpinAboutAnyAxisLikeAnExponential) {
  for (const Vec3& axis : {Vec3{1, 0, 0}, kSkew}) {
    ModelDef def = BallOnBall(5.0 * axis);
    def.joints[0].damping = 0.02;
    WorldBatch world = MakeBatch(def);
    const double h = 1e-3, a = h * 0.02 / (2 * kInertia);
    world.Step(h, 500);
    const double mean_of_ends = 5 * std::pow((1 - a) / (1 + a), 500);
    EXPECT_LT(Distance(Spin(world), mean_of_ends * axis), 1e-12);
    EXPECT_NEAR(mean_of_ends, 5 * std::exp(-0.02 * 0.5 / kInertia), 1e-6);
    EXPECT_LT(world.Joint(0, 0).gap_m, 1e-12);
  }
}

TEST(BallTurn, ASpringSwingsWithTheFrequencyOfItsStiffness) {
  for (const Vec3& axis : {Vec3{0, 0, 1}, kSkew}) {
    ModelDef def = BallOnBall(8.0 * axis);
    def.joints[0].stiffness = 2;
    const double w = std::sqrt(2 / kInertia), h = 1e-3, seen = 2 / h * std::atan(w * h / 2);
    WorldBatch world = MakeBatch(def);
    const double start = EnergyOf(world);
    for (int n = 1; n <= 2000; ++n) {
      world.Step(h);
      const double wanted = 8 / w * std::sin(seen * n * h);
      ASSERT_NEAR(world.Joint(0, 0).turned_rad, std::fabs(wanted), 2e-5) << n;
      ASSERT_NEAR(EnergyOf(world), start, 1e-4 * start) << n;
    }
  }
}

TEST(BallTurn, ASpringTurnsBackByTheTurnVector) {
  // Released at 2.5 rad about a skew axis: the torque is along that axis, k times the angle.
  ModelDef def = BallOnBall({});
  def.joints[0].stiffness = 2;
  const double half = 0.5 * 2.5;
  def.joints[0].turned = {std::cos(half), std::sin(half) * kSkew.x, std::sin(half) * kSkew.y,
                          std::sin(half) * kSkew.z};
  WorldBatch world = MakeBatch(def);
  EXPECT_NEAR(world.Joint(0, 0).turned_rad, 2.5, 1e-14);
  EXPECT_NEAR(EnergyOf(world), 0.5 * 2 * 2.5 * 2.5, 1e-13);
  world.Step(1e-5);
  EXPECT_LT(Distance(world.Joint(0, 0).torque_n_m, -5.0 * kSkew), 1e-6);
}

TEST(BallTurn, ASpringsTorqueFollowsFromItsEnergyAtAnyTurn) {
  // At a rotation r, the work of a small rotation d against the spring equals the growth of its
  // energy.
  const auto turned = [](double angle_rad, const Vec3& axis) {
    const double s = std::sin(0.5 * angle_rad);
    return Quat{std::cos(0.5 * angle_rad), s * axis.x, s * axis.y, s * axis.z};
  };
  for (const double angle : {0.0, 1e-9, 0.3, 1.7, 3.0, 3.1415}) {
    ModelDef def = BallOnBall({});
    def.joints[0].stiffness = 2;
    const auto start = [&](double more_rad, const Vec3& about) {
      WorldBatch world = MakeBatch(def);
      BodyState body = world.Body(0, 0);
      body.orientation = turned(more_rad, about) * turned(angle, kSkew);
      world.SetBodyState(0, 0, body);
      return world;
    };
    WorldBatch there = start(0, kSkew);
    EXPECT_NEAR(there.Joint(0, 0).turned_rad, angle, 1e-13);
    there.Step(1e-6);
    const Vec3 torque = there.Joint(0, 0).torque_n_m;
    EXPECT_LT(Distance(torque, -2.0 * angle * kSkew), 1e-8) << angle;
    const double d = 1e-6;
    for (const Vec3& about : {kSkew, kAcross, Cross(kSkew, kAcross)}) {
      if (angle > 3.1) break;  // beyond half a turn the spring acts the other way
      const double more = EnergyOf(start(d, about)) - EnergyOf(start(-d, about));
      EXPECT_NEAR(more / (2 * d), -Dot(torque, about), 1e-8) << angle;
    }
  }
}

TEST(BallTurn, ASpringThatSwingsAboutChangingAxesKeepsItsEnergy) {
  // The energy error is of second order, also where the axes of rotation and of the angular
  // velocity differ.
  double off[2] = {};
  for (int k = 0; k < 2; ++k) {
    const double h = k == 0 ? 1e-3 : 5e-4;
    ModelDef def = BallOnBall(15.0 * kSkew + 30.0 * kAcross);
    def.bodies[0].inertia_kg_m2 = {0.004, 0.01, 0.012, 0, 0, 0};
    def.joints[0].stiffness = 2;
    WorldBatch world = MakeBatch(def);
    const double start = EnergyOf(world);
    double furthest = 0;
    for (int n = 0; n < StepsIn(10, h); ++n) {
      world.Step(h);
      off[k] = std::max(off[k], std::fabs(EnergyOf(world) - start));
      furthest = std::max(furthest, world.Joint(0, 0).turned_rad);
    }
    EXPECT_GT(furthest, 1.5);
    EXPECT_LT(off[k], 2e-5 * start);
  }
  EXPECT_NEAR(off[0] / off[1], 4, 0.5);
}

TEST(BallTurn, AHeavilyDampedStiffSpringIsStable) {
  ModelDef def = Pendulum(1.0);
  def.joints[0].stiffness = 1e7, def.joints[0].damping = 1e3;
  WorldBatch world = MakeBatch(def);
  for (int n = 0; n < 5000; ++n) {
    world.Step(4e-3);
    ASSERT_LT(world.Joint(0, 0).turned_rad, 1e-2) << n;
  }
  EXPECT_NEAR(world.Joint(0, 0).turned_rad, 0.5 * kG * std::sin(1.0) / 1e7, 1e-12);
  EXPECT_LT(Norm(Spin(world)), 1e-9);
}

TEST(BallTurn, FrictionStopsASpinAboutAnyAxisAndThenHoldsIt) {
  for (const Vec3& axis : {Vec3{1, 0, 0}, kSkew, kAcross}) {
    ModelDef def = BallOnBall(10.0 * axis);
    def.joints[0].friction = 0.1;  // stops after I w / tau = 1 s
    WorldBatch world = MakeBatch(def);
    for (int n = 1; n <= 1100; ++n) {
      world.Step(1e-3);
      const double wanted = std::max(0.0, 10 - 0.1 / kInertia * n * 1e-3);
      ASSERT_LT(Distance(Spin(world), wanted * axis), 1e-11) << n;
      ASSERT_LE(world.Status(0).linear_solves, 4);
    }
    EXPECT_EQ(world.Status(0).bits, kStatusOk);
    EXPECT_LT(Norm(world.Joint(0, 0).torque_n_m), 1e-9);
  }
}

TEST(BallTurn, FrictionsLimitIsTheSameAboutEveryAxis) {
  // A rod of 1 m held level: its weight exerts the torque m g / 2, about an axis whose heading
  // varies.
  for (int i = 0; i < 24; ++i) {
    const double heading = i * std::numbers::pi / 12 + 0.05;
    const double torque = 0.5 * kG;
    for (const double share : {1.0001, 0.9999}) {
      ModelDef def;
      scenes::AddRod(def, "rod", 1.0, 1e-3, {}, {std::cos(heading), std::sin(heading), 0}, {});
      JointDef pin;
      pin.name = "pin", pin.friction = share * torque, pin.axis = {0.6, 0, 0.8};
      def.joints.push_back(pin);
      WorldBatch world = MakeBatch(def);
      world.Step(1e-3, 1000);
      const double turns = Norm(Spin(world));
      if (share > 1) {
        EXPECT_LT(turns, 1e-9) << i;
        EXPECT_NEAR(Norm(world.Joint(0, 0).torque_n_m), torque, 1e-9);
      } else {
        // m g / 2 (1 - share) / (m / 3), for one second
        EXPECT_NEAR(turns, 1e-4 * torque * 3, 1e-6) << i;
        EXPECT_NEAR(Norm(world.Joint(0, 0).torque_n_m), share * torque, 1e-9);
      }
      EXPECT_EQ(world.Status(0).bits, kStatusOk);
    }
  }
}

TEST(BallTurn, WhatFrictionTakesIsItsTorqueTimesTheTurn) {
  // A thin rod that swings in space: the energy loss is tau |w|, integrated over time.
  double off[2] = {};
  for (int k = 0; k < 2; ++k) {
    const double h = k == 0 ? 1e-3 : 5e-4;
    ModelDef def = Pendulum(2.0);
    def.bodies[0].velocity_m_per_s = {0, 1, 0};
    def.bodies[0].angular_velocity_rad_per_s =
        Cross(Vec3{-std::sin(2.0), 0, std::cos(2.0)}, Vec3{0, -2, 0});
    def.joints[0].friction = 0.3;
    WorldBatch world = MakeBatch(def);
    double taken = 0;
    const double start = EnergyOf(world);
    for (int n = 0; n < StepsIn(3, h); ++n) {
      const Vec3 before = Spin(world);
      world.Step(h);
      taken -= h * Dot(world.Joint(0, 0).torque_n_m, 0.5 * (before + Spin(world)));
      ASSERT_LE(world.Status(0).linear_solves, 8);
    }
    EXPECT_EQ(world.Status(0).bits, kStatusOk);
    EXPECT_GT(taken, 2);
    off[k] = std::fabs(EnergyOf(world) - start + taken);
    // Closing the joint's gap moves the rod by h^2 / 8 times the change of its centripetal
    // acceleration. This change is below 3 g, the value at the bottom of a free fall from upright.
    EXPECT_LT(off[k], h * h / 8 * 3 * kG * kG);
  }
  EXPECT_NEAR(off[0] / off[1], 4, 0.5);
}

TEST(BallTurn, AChainWithFrictionSpringsAndDampersFreezesOrSwingsAndStaysTogether) {
  for (const bool holds : {true, false}) {
    ModelDef def = Chain(16, {0.06, 0.08, 0}, 1);
    for (std::size_t i = 0; i < def.joints.size(); ++i) {
      // The first joint carries 16 kg at 0.8 m: 125.6 N m
      const double load =
          kG * 0.05 * (16.0 - static_cast<double>(i)) * (16.0 - static_cast<double>(i));
      def.joints[i].friction = (holds ? 1.01 : 0.3) * load;
      def.joints[i].stiffness = holds ? 0 : 5, def.joints[i].damping = holds ? 0 : 0.01;
    }
    WorldBatch world = MakeBatch(def);
    for (int n = 0; n < 2000; ++n) {
      world.Step(1e-3);
      ASSERT_LT(WorstGap(world, def), 1e-9);
      ASSERT_EQ(world.Status(0).bits, kStatusOk) << n;
      if (!holds) continue;
      for (int b = 0; b < 16; ++b) ASSERT_LT(Norm(Spin(world, b)), 1e-9) << n;
    }
    EXPECT_EQ(Norm(world.Body(0, 15).velocity_m_per_s) < 1e-9, holds);
  }
}

TEST(BallTurn, AFreePairKeepsItsMomenta) {
  ModelDef def = Chain(2, {0.06, 0.08, 0}, 2);
  def.gravity_m_per_s2 = {};
  def.joints.erase(def.joints.begin());
  def.joints[0].friction = 0.05, def.joints[0].stiffness = 1, def.joints[0].damping = 0.001;
  def.bodies[0].angular_velocity_rad_per_s = {1, 2, 3};
  def.bodies[1].angular_velocity_rad_per_s = {-10, 3, 8};
  WorldBatch world = MakeBatch(def);
  const Vec3 p = world.Momentum(0), l = world.AngularMomentum(0);
  world.Step(1e-3, 3000);
  EXPECT_LT(Distance(world.Momentum(0), p), 1e-12);
  EXPECT_LT(Distance(world.AngularMomentum(0), l), 1e-12);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
}

}  // namespace
}  // namespace taut::test
