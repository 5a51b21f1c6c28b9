// Joints against closed forms (docs/theory/joints.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/physics/joint_scenes.h"

namespace taut::test {
namespace {

/// Returns the time [s] of the n-th passage of the pendulum through the vertical, from rest; linear
/// between steps.
double CrossingTime(WorldBatch& world, double step_s, int crossings) {
  double before = world.Body(0, 0).position_m.x;
  for (int n = 1, found = 0; n < 100000; ++n) {
    world.Step(step_s);
    const double now = world.Body(0, 0).position_m.x;
    if (before * now < 0 && ++found == crossings) {
      return step_s * (n - now / (now - before));
    }
    before = now;
  }
  return 0;
}

TEST(Joint, APinnedRodSwingsWithThePeriodOfItsLength) {
  // For a rod about its end, w^2 = 3 g / 2 L. From 90 degrees the period is 2 K(1/sqrt 2) / pi
  // times as long.
  const double small = 2 * std::numbers::pi * std::sqrt(2.0 / (3 * kG)),
               wide = 1.180340599016096 * small;
  EXPECT_NEAR(small, 1.63795, 1e-5);
  for (const JointKind kind : {JointKind::kBall, JointKind::kHinge}) {
    WorldBatch slow = MakeBatch(Pendulum(1e-3, kind)),
               far = MakeBatch(Pendulum(std::numbers::pi / 2, kind));
    EXPECT_NEAR(CrossingTime(slow, 1e-3, 5) / 2.25, small, 1e-5 * small);
    EXPECT_NEAR(CrossingTime(far, 1e-3, 5) / 2.25, wide, 1e-5 * wide);
  }
}

TEST(Joint, ASwingingRodKeepsItsEnergyAndItsPin) {
  // The energy oscillates with the rod by O(h^2). The velocity projection at the end of a step is
  // of third order and accumulates at most in proportion to time.
  double worst[3] = {}, last[3] = {};
  for (int k = 0; k < 3; ++k) {
    const double h = kThreeStepsS[k];
    WorldBatch world = MakeBatch(Pendulum(2.5));
    const double start = EnergyOf(world);
    const int steps = StepsIn(60, h);
    for (int n = 1; n <= steps; ++n) {
      world.Step(h);
      const double off = std::fabs(EnergyOf(world) - start);
      double& most = n > steps - StepsIn(5, h) ? last[k] : worst[k];
      most = std::max(most, off);
      ASSERT_LT(world.Joint(0, 0).gap_m, 1e-11);
    }
    EXPECT_EQ(world.Status(0).bits, kStatusOk);
    EXPECT_LT(last[k], 60.0 / 55 * worst[k]);
  }
  EXPECT_LT(worst[1], 1e-5);
  for (const double ratio : {worst[1] / worst[0], worst[2] / worst[1]}) {
    EXPECT_GT(ratio, 15);
    EXPECT_LT(ratio, 64);
  }
}

TEST(Joint, AChainWithAThousandfoldMassAtItsEndCarriesItsWeight) {
  const ModelDef def = Chain(64, {0, 0, -0.1}, 1000);
  WorldBatch world = MakeBatch(def);
  int solves = 0;
  for (int n = 0; n < 1000; ++n) {
    world.Step(1e-3);
    solves = std::max(solves, world.Status(0).linear_solves);
  }
  EXPECT_LT(WorstGap(world, def), 1e-12);
  EXPECT_NEAR(world.Joint(0, 0).force_n.z, 1063 * kG, 1e-9 * 1063 * kG);
  EXPECT_NEAR(world.Joint(0, 63).force_n.z, 1000 * kG, 1e-9 * 1000 * kG);
  EXPECT_LE(solves, 5);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
}

TEST(Joint, AChainThatSwingsWithAHeavyEndStaysTogether) {
  // Ten times the mass of a rod: a rod of 1 kg under 400 N oscillates across at 200 Hz. A
  // thousandfold mass would make that 1.5 kHz, beyond the resolution of steps of 1 ms.
  const ModelDef def = Chain(64, {0.1, 0, 0}, 10);
  WorldBatch world = MakeBatch(def);
  const double start = EnergyOf(world);
  for (int n = 0; n < 3000; ++n) {
    world.Step(1e-3);
    ASSERT_LT(WorstGap(world, def), 1e-9) << n;
    ASSERT_LE(world.Status(0).linear_solves, 5) << n;
  }
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
  EXPECT_NEAR(EnergyOf(world), start, 1e-3 * 73 * kG * 6.4);
}

TEST(Joint, AChainThatCarriesTooMuchForTheStepSaysSo) {
  // Transverse vibration of rods that carry F at both ends: w^2 = 12 F / (m l), so 2 / w is 1.2 ms
  // at 14 kN.
  const auto status = [](double last_kg, const Vec3& along, double step_s) {
    const ModelDef def = Chain(16, along, last_kg);
    WorldBatch world = MakeBatch(def);
    for (int n = 0; n < StepsIn(1.5, step_s) && world.Status(0).bits == kStatusOk; ++n) {
      world.Step(step_s);
    }
    return world.Status(0);
  };
  const WorldStatus heavy = status(1000, {0.1, 0, 0}, 1e-3);
  EXPECT_EQ(heavy.bits, kStatusStepTooLong);
  EXPECT_GE(heavy.body, 0);
  EXPECT_EQ(heavy.cable, -1);
  EXPECT_EQ(status(1000, {0.1, 0, 0}, 2.5e-4).bits, kStatusOk);
  EXPECT_EQ(status(1000, {0, 0, -0.1}, 1e-3).bits, kStatusOk);
  EXPECT_EQ(status(10, {0.1, 0, 0}, 1e-3).bits, kStatusOk);
}

TEST(Joint, ALightRodThatCarriesAHeavyEndIsNoFastOscillator) {
  // It is pinned and rotates only together with its load (limits: joint_steps.cpp).
  for (const double last_kg : {3450.0, 3550.0, 35000.0}) {
    ModelDef def = Chain(2, {0, 0, -0.1}, last_kg);
    def.bodies[0].velocity_m_per_s.x = 1e-3;
    WorldBatch world = MakeBatch(def);
    for (int n = 0; n < 2000; ++n) {
      world.Step(1e-3);
      ASSERT_LT(std::fabs(world.Body(0, 0).position_m.x), 1e-3) << last_kg;
    }
    EXPECT_EQ(world.Status(0).bits, kStatusOk) << last_kg;
  }
}

TEST(Joint, AFreeChainKeepsItsMomenta) {
  ModelDef def = Chain(5, {0.06, 0.08, 0}, 2);
  def.gravity_m_per_s2 = {};
  def.joints.erase(def.joints.begin());
  for (int i = 0; i < 5; ++i) {
    BodyDef& body = def.bodies[static_cast<std::size_t>(i)];
    body.angular_velocity_rad_per_s = {1.0 + i, 2, 3 - i * 2.0};
    body.velocity_m_per_s = {0.1 * i, 0, 0.3};
  }
  WorldBatch world = MakeBatch(def);
  const Vec3 p = world.Momentum(0), l = world.AngularMomentum(0);
  for (int n = 0; n < 10000; ++n) world.Step(1e-3);
  EXPECT_LT(Distance(world.Momentum(0), p), 1e-11);
  EXPECT_LT(Distance(world.AngularMomentum(0), l), 1e-11);
  EXPECT_LT(WorstGap(world, def), 1e-9);
}

/// Returns a box of 1 kg and 0.1 m, its center at `at`, on a joint with the world there.
ModelDef BoxOn(JointKind kind, const Vec3& axis, const Vec3& at = {}) {
  ModelDef def;
  scenes::AddRod(def, "body", 1.0, 0.05, at - Vec3{0.1, 0, 0}, at + Vec3{0.1, 0, 0}, {});
  JointDef joint;
  joint.name = "joint", joint.kind = kind, joint.axis = axis;
  joint.from_m = joint.to_m = at;
  def.joints.push_back(joint);
  return def;
}
double InertiaAlongY(const ModelDef& def) { return def.bodies[0].inertia_kg_m2.yy; }

TEST(Joint, WhatAKindLeavesFreeIsFreeAndTheRestIsHeld) {
  // Pushed along and rotated about every axis of a skew frame: only the free coordinates move.
  const Vec3 n{2.0 / 7, 3.0 / 7, 6.0 / 7}, s{6.0 / 7, 2.0 / 7, -3.0 / 7}, t = Cross(n, s);
  const struct {
    JointKind kind;
    int slides, turns;  // bits: along or about n, s, t
  } kinds[] = {{JointKind::kBall, 0, 7},        {JointKind::kHinge, 0, 1},
               {JointKind::kWeld, 0, 0},        {JointKind::kPrismatic, 1, 0},
               {JointKind::kCylindrical, 1, 1}, {JointKind::kPlanar, 6, 1},
               {JointKind::kLine, 1, 7},        {JointKind::kPlane, 6, 7}};
  const Vec3 axes[] = {n, s, t};
  for (const auto& kind : kinds) {
    for (int i = 0; i < 3; ++i) {
      for (const bool turn : {false, true}) {
        ModelDef def = BoxOn(kind.kind, n);
        def.gravity_m_per_s2 = {};
        BodyDef& body = def.bodies[0];
        body.inertia_kg_m2 = {0.01, 0.01, 0.01, 0, 0, 0};
        (turn ? body.angular_velocity_rad_per_s : body.velocity_m_per_s) = axes[i];
        WorldBatch world = MakeBatch(def);
        for (int k = 0; k < 100; ++k) world.Step(1e-3);
        const BodyState now = world.Body(0, 0);
        const Vec3 v = turn ? now.angular_velocity_rad_per_s : now.velocity_m_per_s;
        const bool is_free = ((turn ? kind.turns : kind.slides) >> i & 1) != 0;
        EXPECT_LT(Distance(v, is_free ? axes[i] : Vec3{}), 1e-9)
            << static_cast<int>(kind.kind) << " " << i << turn;
        EXPECT_LT(world.Joint(0, 0).gap_m, 1e-12);
      }
    }
  }
}

TEST(Joint, AWeldCarriesForceAndTorqueLikeAClampedBeam) {
  // A rod of 1 m that sticks out of a wall: the force is its weight, the torque its weight times
  // half its length.
  ModelDef def;
  scenes::AddRod(def, "rod", 2.0, 0.01, {}, {1, 0, 0}, {});
  JointDef joint;
  joint.name = "wall", joint.kind = JointKind::kWeld;
  def.joints.push_back(joint);
  WorldBatch world = MakeBatch(def);
  for (int n = 0; n < 10; ++n) world.Step(1e-3);
  const JointState wall = world.Joint(0, 0);
  EXPECT_LT(Distance(wall.force_n, {0, 0, 2 * kG}), 1e-9);
  EXPECT_LT(Distance(wall.torque_n_m, {0, -2 * kG * 0.5, 0}), 1e-9);
  EXPECT_LT(Norm(world.Body(0, 0).velocity_m_per_s), 1e-12);
}

TEST(Joint, AHingesSpringTurnsWithTheFrequencyOfItsStiffness) {
  ModelDef def = BoxOn(JointKind::kHinge, {0, 1, 0});
  def.joints[0].stiffness = 5, def.joints[0].rest = 0.3;
  const double w = std::sqrt(5 / InertiaAlongY(def)), h = 1e-3;
  WorldBatch world = MakeBatch(def);
  const double start = EnergyOf(world);
  // The mean of start and end makes it tan(w h / 2): a slightly lower frequency.
  const double seen = 2 / h * std::atan(w * h / 2);
  for (int n = 1; n <= 2000; ++n) {
    world.Step(h);
    const double wanted = 0.3 - 0.3 * std::cos(seen * n * h);
    ASSERT_NEAR(world.Joint(0, 0).coordinate, wanted, 2e-5) << n;
    ASSERT_NEAR(EnergyOf(world), start, 1e-5 * start) << n;
  }
}

TEST(Joint, AHeavilyDampedStiffSpringIsStable) {
  ModelDef def = BoxOn(JointKind::kPrismatic, {0, 0, 1});
  def.joints[0].stiffness = 1e9, def.joints[0].damping = 1e5;
  WorldBatch world = MakeBatch(def);
  for (int n = 0; n < 10000; ++n) {
    world.Step(4e-3);
    ASSERT_LT(std::fabs(world.Joint(0, 0).coordinate), 1e-3);
  }
  EXPECT_NEAR(world.Joint(0, 0).coordinate, -kG / 1e9, 1e-12);
  EXPECT_LT(Norm(world.Body(0, 0).velocity_m_per_s), 1e-9);
}

TEST(Joint, FrictionHoldsUpToItsLimitAndSlowsBeyondIt) {
  for (const double limit : {9.82, 9.80}) {
    ModelDef def = BoxOn(JointKind::kPrismatic, {0, 0, 1});
    def.joints[0].friction = limit;
    WorldBatch world = MakeBatch(def);
    for (int n = 0; n < 1000; ++n) world.Step(1e-3);
    const double wanted = limit > kG ? 0 : limit - kG;
    EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.z, wanted, 1e-10);
  }
  // Friction of a hinge: a spinning body stops after w J / F, and stays at rest.
  ModelDef def = BoxOn(JointKind::kHinge, {0, 1, 0});
  def.bodies[0].angular_velocity_rad_per_s = {0, 10, 0};
  def.joints[0].friction = 0.1;
  const double stops_s = 10 * InertiaAlongY(def) / 0.1, angle = 0.5 * 10 * stops_s;
  WorldBatch world = MakeBatch(def);
  for (int n = 0; n < StepsIn(2 * stops_s, 1e-3); ++n) world.Step(1e-3);
  EXPECT_NEAR(world.Joint(0, 0).coordinate, angle, 1e-2 * angle);
  EXPECT_LT(std::fabs(world.Joint(0, 0).rate), 1e-10);
}

TEST(Joint, AHingeCountsItsTurns) {
  ModelDef def = BoxOn(JointKind::kHinge, {0, 1, 0});
  def.bodies[0].angular_velocity_rad_per_s = {0, -20, 0};
  WorldBatch world = MakeBatch(def);
  for (int n = 0; n < 3000; ++n) world.Step(1e-3);
  // A drift rotates by h w (1 - (h w)^4 / 120).
  EXPECT_NEAR(world.Joint(0, 0).coordinate, -60 * (1 - std::pow(0.01, 4) / 120), 1e-11);
}

TEST(Joint, StopsHoldAndSendBack) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    ModelDef def = BoxOn(JointKind::kPrismatic, {1, 0, 0});
    def.gravity_m_per_s2 = {};
    def.bodies[0].velocity_m_per_s = {1, 0, 0};
    def.joints[0].least = -0.2, def.joints[0].most = 0.1, def.joints[0].restitution = restitution;
    WorldBatch world = MakeBatch(def);
    double far = 0;
    for (int n = 0; n < 200; ++n)
      world.Step(1e-3), far = std::max(far, world.Joint(0, 0).coordinate);
    EXPECT_LT(far, 0.1 + 1e-9);
    EXPECT_GT(far, 0.1 - 2e-3);
    EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.x, -restitution, 1e-6);
  }
  // Pressed against its limit by its weight, the body rests there, and the limit carries the
  // weight.
  ModelDef def = BoxOn(JointKind::kPrismatic, {0, 0, 1});
  def.joints[0].least = -0.05;
  WorldBatch world = MakeBatch(def);
  for (int n = 0; n < 1000; ++n) world.Step(1e-3);
  EXPECT_NEAR(world.Joint(0, 0).coordinate, -0.05, 1e-12);
  EXPECT_NEAR(world.Joint(0, 0).force_n.z, kG, 1e-9);
  EXPECT_LT(Norm(world.Body(0, 0).velocity_m_per_s), 1e-9);
}

TEST(Joint, AStopThatIsPassedAtTheStartLetsItsBodyReturnSlowly) {
  // The body starts 1 cm beyond the limit, pressed by its weight. It returns no faster than the
  // weight would move it further, h g / 2.
  ModelDef def = BoxOn(JointKind::kPrismatic, {0, 0, 1});
  def.joints[0].least = 0.01;
  WorldBatch world = MakeBatch(def);
  double fastest = 0;
  for (int n = 0; n < 3000; ++n) {
    world.Step(1e-3);
    fastest = std::max(fastest, world.Body(0, 0).velocity_m_per_s.z);
  }
  EXPECT_LT(fastest, 1.01e-3 * kG / 2);
  EXPECT_NEAR(world.Joint(0, 0).coordinate, 0.01, 1e-12);
  EXPECT_NEAR(world.Joint(0, 0).force_n.z, kG, 1e-9);
}

TEST(Joint, ABallsConeStopsASwing) {
  ModelDef def = Pendulum(0.0);
  def.joints[0].axis = {0, 0, -1}, def.joints[0].most = 0.4;
  def.gravity_m_per_s2 = {3, 2, 0};
  WorldBatch world = MakeBatch(def);
  for (int n = 0; n < 4000; ++n) {
    world.Step(1e-3);
    ASSERT_LT(world.Joint(0, 0).coordinate, 0.4 + 1e-12) << n;
  }
  EXPECT_NEAR(world.Joint(0, 0).coordinate, 0.4, 1e-12);
}

TEST(Joint, ADistanceHoldsOrPullsOrStops) {
  const auto hung = [](auto&& change) {
    ModelDef def;
    scenes::AddRod(def, "rod", 1.0, 0.01, {0, 0, -0.5}, {0, 0, -0.7}, {});
    JointDef j;
    j.name = "line", j.kind = JointKind::kDistance, j.from_m = {}, j.to_m = {0, 0, -0.5};
    change(j);
    def.joints.push_back(j);
    WorldBatch world = MakeBatch(def);
    for (int n = 0; n < 2000; ++n) world.Step(1e-3);
    return world.Joint(0, 0);
  };
  EXPECT_NEAR(hung([](JointDef&) {}).coordinate, 0.5, 1e-12);
  EXPECT_NEAR(hung([](JointDef&) {}).force_n.z, kG, 1e-9);
  const JointState rope = hung([](JointDef& j) { j.most = 0.6; });
  EXPECT_NEAR(rope.coordinate, 0.6, 1e-12);
  const JointState spring =
      hung([](JointDef& j) { j.stiffness = 100, j.damping = 20, j.rest = 0.5; });
  EXPECT_NEAR(spring.coordinate, 0.5 + kG / 100, 1e-6);
}

}  // namespace
}  // namespace taut::test
