/// Collisions of two bodies: impulses, momentum, kinetic friction and continuous collision
/// detection.

#include <gtest/gtest.h>

#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

ModelDef Weightless() {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  return def;
}

/// Steps until after the collision and checks that linear and angular momentum are kept.
void Collide(WorldBatch& world, double h, double time_s) {
  const double momentum = 1;  // above all momenta in these tests [kg m/s]
  const Vec3 p0 = world.Momentum(0), l0 = world.AngularMomentum(0);
  bool touched = false;
  for (int n = 1; n <= StepsIn(time_s, h); ++n) {
    world.Step(h);
    touched = touched || !world.Contacts(0).empty();
    ASSERT_LE(Distance(world.Momentum(0), p0), RoundOff(n, momentum)) << n;
    ASSERT_LE(Distance(world.AngularMomentum(0), l0), RoundOff(n, momentum)) << n;
  }
  EXPECT_TRUE(touched);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
}

TEST(BodyContact, BallsInLineExchangeMomentumByNewtonsLaw) {
  // v1' = v1 - (1 + e) m2 / (m1 + m2) (v1 - v2), and the other way round.
  const double m1 = 0.2, m2 = 0.5, v1 = 1.5, v2 = -0.4;
  for (const double e : {0.0, 0.5, 1.0}) {
    for (const double h : kThreeStepsS) {
      ModelDef def = Weightless();
      const Material material{0.5, 0.5, e};
      scenes::AddBall(def, "one", m1, 0.1, {0, 0, 0}, material);
      scenes::AddBall(def, "two", m2, 0.15, {0.5, 0, 0}, material);
      def.bodies[0].velocity_m_per_s = {v1, 0, 0};
      def.bodies[1].velocity_m_per_s = {v2, 0, 0};
      WorldBatch world = MakeBatch(def);
      const Vec3 p0 = world.Momentum(0);
      world.Step(h, StepsIn(0.4, h));
      const double change = (1 + e) * (v1 - v2) / (m1 + m2);
      EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.x, v1 - m2 * change, SolverError(2)) << e << h;
      EXPECT_NEAR(world.Body(0, 1).velocity_m_per_s.x, v2 + m1 * change, SolverError(2)) << e << h;
      EXPECT_LE(Distance(world.Momentum(0), p0), RoundOff(StepsIn(0.4, h), 1));
      EXPECT_EQ(world.Status(0).bits, kStatusOk);
    }
  }
}

TEST(BodyContact, BallsThatMeetAskewKeepLinearAndAngularMomentum) {
  for (const double h : kThreeStepsS) {
    ModelDef def = Weightless();
    const Material material{0.6, 0.4, 0.5};
    scenes::AddBall(def, "one", 0.2, 0.1, {0, 0, 0}, material);
    scenes::AddBall(def, "two", 0.5, 0.15, {0.5, 0.08, -0.06}, material);
    def.bodies[0].velocity_m_per_s = {1.5, 0, 0};
    def.bodies[0].angular_velocity_rad_per_s = {3, -7, 11};
    def.bodies[1].velocity_m_per_s = {-0.4, 0.1, 0};
    WorldBatch world = MakeBatch(def);
    Collide(world, h, 0.6);
    EXPECT_TRUE(world.Contacts(0).empty());
    EXPECT_GT(Norm(world.Body(0, 1).angular_velocity_rad_per_s), 0.1);  // friction has rotated it
  }
}

TEST(BodyContact, CrossingRodsKeepLinearAndAngularMomentum) {
  for (const double e : {0.0, 0.5, 1.0}) {
    for (const double h : kThreeStepsS) {
      ModelDef def = Weightless();
      const Material material{0.6, 0.4, e};
      scenes::AddRod(def, "one", 0.1, 0.02, {-0.5, 0, 0}, {0.5, 0, 0}, material);
      scenes::AddRod(def, "two", 0.3, 0.02, {0.1, -0.5, 0.2}, {0.3, 0.5, 0.2}, material);
      def.bodies[1].velocity_m_per_s = {-0.05, 0.3, -1};
      WorldBatch world = MakeBatch(def);
      Collide(world, h, 0.5);
      EXPECT_GT(Norm(world.Body(0, 0).angular_velocity_rad_per_s), 1);
    }
  }
}

TEST(BodyContact, RodsThatCrossInTheirMiddlesReboundByNewtonsLaw) {
  // As for two point masses in line: the impulse is along the common normal z.
  for (const double e : {0.0, 0.5, 1.0}) {
    for (const double h : kThreeStepsS) {
      ModelDef def = Weightless();
      const Material material{0.5, 0.5, e};
      scenes::AddRod(def, "one", 0.1, 0.02, {-0.5, 0, 0}, {0.5, 0, 0}, material);
      scenes::AddRod(def, "two", 0.3, 0.02, {0, -0.5, 0.2}, {0, 0.5, 0.2}, material);
      def.bodies[1].velocity_m_per_s = {0, 0, -1};
      WorldBatch world = MakeBatch(def);
      world.Step(h, StepsIn(0.4, h));
      EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.z, -(1 + e) * 0.75, SolverError(2)) << e;
      EXPECT_NEAR(world.Body(0, 1).velocity_m_per_s.z, -1 + (1 + e) * 0.25, SolverError(2)) << e;
    }
  }
}

TEST(BodyContact, ARodHitNearItsEndTurnsAsNewtonsLawSays) {
  // A ball hits a rod of 1 m squarely at the distance `a` from its center, where the rod's
  // effective mass is 1 / (1 / M + a^2 / J).
  const double m = 0.2, mass = 0.5, v = 1.2, a = 0.48, h = 1e-3;
  for (const double e : {0.0, 0.7}) {
    ModelDef def = Weightless();
    const Material material{0, 0, e};
    scenes::AddBall(def, "ball", m, 0.05, {a, 0, 0.3}, material);
    scenes::AddRod(def, "rod", mass, 0.02, {-0.5, 0, 0}, {0.5, 0, 0}, material);
    def.bodies[0].velocity_m_per_s = {0, 0, -v};
    const double moment = def.bodies[1].inertia_kg_m2.yy;
    WorldBatch world = MakeBatch(def);
    int steps = 0;
    for (; world.Body(0, 1).velocity_m_per_s.z > -1e-6; ++steps) {
      ASSERT_LT(steps, 250);
      world.Step(h);
    }
    // The ball rebounds in the step that moved the rod; two more steps change nothing.
    world.Step(h, 2);
    const double impulse = (1 + e) * v / (1 / m + 1 / mass + a * a / moment);
    // Meanwhile the rod rotates by 3 h w, and the contact point shifts by that times 0.07 m, the
    // distance of the two centers, which changes `a` by `share`.
    const double w = impulse * a / moment, share = 2 * 3 * h * w * 0.07 / a;
    EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.z, -v + impulse / m, share * v) << e;
    EXPECT_NEAR(world.Body(0, 1).velocity_m_per_s.z, -impulse / mass, share * v) << e;
    // A downward impact at +x rotates the rod about +y.
    EXPECT_NEAR(world.Body(0, 1).angular_velocity_rad_per_s.y, w, share * v / a) << e;
  }
}

TEST(BodyContact, OneRodSlidesAlongAnotherWithKineticFriction) {
  // Rod two lies across two fixed rods and slides along them: v falls by mu g h a step.
  ModelDef def;
  const Material material{0.3, 0.3, 0};
  scenes::AddRod(def, "rail", 1, 0.02, {-1, -0.2, 0}, {2, -0.2, 0}, material);
  scenes::AddRod(def, "rail", 1, 0.02, {-1, 0.2, 0}, {2, 0.2, 0}, material);
  const int rod = scenes::AddRod(def, "rod", 0.1, 0.02, {0, -0.3, 0.04}, {0, 0.3, 0.04}, material);
  def.bodies[0].fixed = def.bodies[1].fixed = true;
  // Friction acts below the rod's axis and would make it roll, which so large a moment of inertia
  // prevents. The remaining acceleration at its underside is mu m g r^2 / J = 1e-9 m/s^2.
  def.bodies[2].inertia_kg_m2 = {1e-3, 1e6, 1e-3, 0, 0, 0};
  def.bodies[2].velocity_m_per_s = {1, 0, 0};
  WorldBatch world = MakeBatch(def);
  const double h = 1e-3;
  for (int n = 1; n <= 300; ++n) {
    world.Step(h);
    ASSERT_NEAR(world.Body(0, rod).velocity_m_per_s.x, 1 - 0.3 * 9.81 * n * h, SolverError(n)) << n;
  }
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
}

TEST(BodyContact, ShapesOfOneBodyAndShapesThatDoNotCollidePassThroughEachOther) {
  ModelDef def = Weightless();
  scenes::AddBall(def, "one", 0.2, 0.1, {0, 0, 0}, {});
  scenes::AddBall(def, "two", 0.2, 0.1, {0.5, 0, 0}, {});
  def.spheres.push_back({"inside", 0, {0.05, 0, 0}, 0.1, {}});  // overlaps the first
  def.spheres[1].collides = false;
  def.bodies[0].velocity_m_per_s = {1, 0, 0};
  WorldBatch world = MakeBatch(def);
  for (int n = 0; n < 1000; ++n) {
    world.Step(1e-3);
    ASSERT_TRUE(world.Contacts(0).empty());
  }
  EXPECT_EQ(world.Body(0, 0).velocity_m_per_s.x, 1);
  EXPECT_EQ(world.Body(0, 1).velocity_m_per_s.x, 0);
}

TEST(BodyContact, AFastBallDoesNotPassThroughAnother) {
  // 0.4 m a step, far more than the balls' size: the search for contacts includes the travel of a
  // step.
  ModelDef def = Weightless();
  const Material material{0.5, 0.5, 1};
  scenes::AddBall(def, "one", 0.2, 0.02, {-1.03, 0, 0}, material);
  scenes::AddBall(def, "two", 0.2, 0.02, {0, 0, 0}, material);
  def.bodies[0].velocity_m_per_s = {100, 0, 0};
  WorldBatch world = MakeBatch(def);
  world.Step(4e-3, 20);
  EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.x, 0, SolverError(1) + RoundOff(1, 100));
  EXPECT_NEAR(world.Body(0, 1).velocity_m_per_s.x, 100, SolverError(1) + RoundOff(1, 100));
}

TEST(BodyContact, ATowerOfEverHeavierBallsStands) {
  // Four balls on top of each other, each ten times as heavy as the one below, kept upright by
  // symmetry: a hard case for Gauss-Seidel sweeps over the contacts.
  ModelDef def;
  const Material material{0.5, 0.5, 0};
  scenes::AddGround(def, material);
  double mass = 0.01, weight = 0;
  for (int i = 0; i < 4; ++i) {
    scenes::AddBall(def, "ball", mass, 0.1, {0, 0, 0.1 + 0.2 * i}, material);
    weight += mass * 9.81;
    mass *= 10;
  }
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 1000);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
  for (int i = 0; i < 4; ++i) {
    EXPECT_LE(Distance(world.Body(0, i).position_m, {0, 0, 0.1 + 0.2 * i}), 1e-7) << i;
  }
  for (const ContactState& contact : world.Contacts(0)) {
    if (contact.body_b != kWorld) continue;
    EXPECT_NEAR(contact.force_n.z, weight, 1e-6 * weight);
  }
}

}  // namespace
}  // namespace taut::test
