/// Terrain of boxes, walls and several planes.

#include <gtest/gtest.h>

#include "tests/constants.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/block_on_slope.h"
#include "tests/scenes/chance.h"
#include "tests/scenes/single_rod.h"

namespace taut::test {
namespace {

TEST(Terrain, ABallRollsOffAStepAndFallsAsAParabola) {
  // The ball rolls without slipping on a terrain box, leaves the edge, lands on the plane below and
  // continues to roll: it keeps its spin after the edge and its horizontal speed in flight.
  const double v = 3, r = 0.1, top = 0.5;
  ModelDef def;
  const Material material{0.5, 0.5, 0};
  scenes::AddGround(def, material);
  def.terrain_boxes.push_back({"step", {-1, 0, top / 2}, {}, {1, 1, top / 2}, material});
  scenes::AddBall(def, "ball", 0.2, r, {-1, 0, top + r}, material);
  def.bodies[0].velocity_m_per_s = {v, 0, 0};
  def.bodies[0].angular_velocity_rad_per_s = {0, v / r, 0};
  WorldBatch world = MakeBatch(def);
  const double h = 1e-3;
  // On the box: no force but its weight.
  const int on_box = 330;
  for (int n = 1; n <= on_box; ++n) {
    world.Step(h);
    ASSERT_NEAR(world.Body(0, 0).velocity_m_per_s.x, v, SolverError(n));
    ASSERT_NEAR(world.Body(0, 0).position_m.z, top + r, SolverError(n));
  }
  // v^2 > g r: the ball loses contact right at the edge. The box supports it until the first step
  // after the edge.
  int steps = on_box;
  while (world.Body(0, 0).velocity_m_per_s.z > -kG * h / 2) {
    world.Step(h);
    ASSERT_LT(++steps, 400);
  }
  EXPECT_NEAR(world.Body(0, 0).position_m.x, 0, 2 * v * h);
  const BodyState off = world.Body(0, 0);
  while (world.Body(0, 0).position_m.z > r + 0.02) {
    world.Step(h);
    ASSERT_LT(++steps, 1000);
    const BodyState ball = world.Body(0, 0);
    ASSERT_NEAR(ball.velocity_m_per_s.x, off.velocity_m_per_s.x, SolverError(1));
    ASSERT_NEAR(ball.angular_velocity_rad_per_s.y, off.angular_velocity_rad_per_s.y, 1e-9);
  }
  const double fall = off.position_m.z - world.Body(0, 0).position_m.z;
  const double u = off.velocity_m_per_s.z;
  const double time = (std::sqrt(u * u + 2 * kG * fall) + u) / kG;
  EXPECT_NEAR(world.Body(0, 0).position_m.x - off.position_m.x, off.velocity_m_per_s.x * time,
              SolverError(1) + RoundOff(1000, 3));
  world.Step(h, 1000);
  // Landing needs hardly any change of spin: the contact point has no initial slip, except from the
  // edge.
  EXPECT_NEAR(world.Body(0, 0).position_m.z, r, 1e-9);
  const BodyState end = world.Body(0, 0);
  EXPECT_NEAR(end.velocity_m_per_s.x, r * end.angular_velocity_rad_per_s.y, SolverError(1));
}

TEST(Terrain, ABoxRestsOnATerrainBoxAndCarriesItsWeight) {
  ModelDef def;
  const Material material{0.5, 0.5, 0};
  const Vec3 half{0.1, 0.06, 0.03};
  def.terrain_boxes.push_back({"table", {0, 0, -0.5}, {}, {1, 1, 0.5}, material});
  BodyDef body;
  body.name = "box";
  body.mass_kg = 1.5;
  body.com_m = {0.1, 0.2, half.z};
  body.inertia_kg_m2 = scenes::BoxInertia(1.5, half);
  def.bodies.push_back(body);
  def.boxes.push_back({"box", 0, body.com_m, {}, half, material});
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 2000);
  EXPECT_LE(Distance(world.Body(0, 0).position_m, body.com_m), 1e-9);
  Vec3 force;
  for (const ContactState& contact : world.Contacts(0)) {
    EXPECT_EQ(contact.body_a, 0);
    EXPECT_EQ(contact.body_b, kWorld);
    EXPECT_LE(Distance(contact.normal, {0, 0, 1}), RoundOff(1, 1));
    EXPECT_NEAR(contact.point_m.z, 0, 1e-9);
    force = force + contact.force_n;
  }
  EXPECT_LE(Distance(force, {0, 0, 1.5 * kG}), 1.5 * SolverError(1) / 1e-3);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
}

TEST(Terrain, ABoxOnABoxStandsStillAndSticksOnASlope) {
  // Two movable boxes on a terrain box that is tilted by less than the friction angle.
  const double angle = std::atan(0.4);
  const scenes::Slope slope{angle, {}};
  const Material material{0.5, 0.5, 0};
  const Quat q = slope.orientation();
  ModelDef def;
  const auto at = [&](double height) { return scenes::Scaled(height, slope.normal()); };
  def.terrain_boxes.push_back({"ramp", at(-0.5), q, {1, 1, 0.5}, material});
  const Vec3 half[2] = {{0.15, 0.12, 0.03}, {0.1, 0.06, 0.02}};
  for (int i = 0; i < 2; ++i) {
    BodyDef body;
    body.name = i == 0 ? "lower" : "upper";
    body.mass_kg = i == 0 ? 1 : 0.7;
    body.com_m = at(i == 0 ? half[0].z : 2 * half[0].z + half[1].z);
    body.inertia_kg_m2 = scenes::TurnedInertia(scenes::BoxInertia(body.mass_kg, half[i]), q);
    def.bodies.push_back(body);
    def.boxes.push_back({body.name, i, body.com_m, q, half[i], material});
  }
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 500);
  const Vec3 before[2] = {world.Body(0, 0).position_m, world.Body(0, 1).position_m};
  world.Step(1e-3, 5000);
  for (int i = 0; i < 2; ++i) {
    EXPECT_LT(Distance(world.Body(0, i).position_m, before[i]), 5e-9) << i;
    EXPECT_LT(Distance(world.Body(0, i).position_m, def.bodies[static_cast<std::size_t>(i)].com_m),
              1e-6)
        << i;
  }
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
}

TEST(Terrain, AWallStopsABall) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  const Material material{0, 0, 0.5};
  def.terrain_boxes.push_back(
      {"wall", {1, 0, 0}, scenes::Turn({0, 0, 1}, 0.3), {0.1, 2, 1}, material});
  scenes::AddBall(def, "ball", 0.2, 0.1, {0, 0, 0}, material);
  def.bodies[0].velocity_m_per_s = {2, 0, 0};
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 800);
  // v' = v - (1 + e) (v . n) n
  const Vec3 n{-std::cos(0.3), -std::sin(0.3), 0};
  const Vec3 expected = Vec3{2, 0, 0} - (1.5 * 2 * n.x) * n;
  EXPECT_LE(Distance(world.Body(0, 0).velocity_m_per_s, expected), SolverError(2) + 1e-12);
}

TEST(Terrain, AWedgeOfTwoPlanesHoldsABall) {
  // Without friction, each plane carries m g / (2 cos a).
  const double a = 0.7, r = 0.1;
  ModelDef def;
  for (const double side : {-1.0, 1.0}) {
    PlaneDef plane;
    plane.name = side < 0 ? "left" : "right";
    plane.normal = {-side * std::sin(a), 0, std::cos(a)};
    plane.material = {0, 0, 0};
    def.planes.push_back(plane);
  }
  scenes::AddBall(def, "ball", 0.2, r, {0, 0, r / std::cos(a)}, {0, 0, 0});
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 2000);
  EXPECT_LE(Distance(world.Body(0, 0).position_m, {0, 0, r / std::cos(a)}), 1e-9);
  const auto contacts = world.Contacts(0);
  ASSERT_EQ(contacts.size(), 2u);
  for (const ContactState& contact : contacts) {
    EXPECT_NEAR(Norm(contact.force_n), 0.2 * kG / (2 * std::cos(a)), 0.2 * SolverError(1) / 1e-3);
    EXPECT_NEAR(Dot(contact.force_n, contact.normal), Norm(contact.force_n), 1e-12);
  }
}

TEST(Terrain, ARodJammedAcrossAGrooveStaysAndItsForcesDoNotGrow) {
  // The rod is held by friction, with an indeterminate force along it: two sticking points have six
  // rows, of which one is redundant. Gaps that differ by 1e-11 m make them inconsistent contacts.
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    scenes::Chance chance(seed);
    scenes::RodInWedge rod;
    rod.tilt_rad = chance.Within(-0.4, 0.4);
    ModelDef def = rod.Def();
    def.bodies[0].velocity_m_per_s = chance.Jolt(0.01);
    WorldBatch world = MakeBatch(def);
    double jammed_n = 0;
    Vec3 jammed_m;
    for (int step = 0; step < 1000; ++step) {
      world.Step(1e-3);
      ASSERT_EQ(world.Status(0).bits, 0u) << seed << ", step " << step;
      const auto contacts = world.Contacts(0);
      if (step != 300 && step != 999) continue;
      ASSERT_EQ(contacts.size(), 2u) << seed;
      const Vec3 sum = contacts[0].force_n + contacts[1].force_n;
      EXPECT_NEAR(sum.z, rod.mass_kg * kG, 1e-4) << seed;
      const double size = Norm(contacts[0].force_n);
      if (step == 300) {
        jammed_n = size, jammed_m = world.Body(0, 0).position_m;
        continue;
      }
      EXPECT_NEAR(size, jammed_n, 0.01 * jammed_n) << seed;
      EXPECT_NEAR(world.Body(0, 0).position_m.z, jammed_m.z, 1e-7) << seed;
    }
  }
}

TEST(Terrain, ABallThatFallsBesideAPlaneOrABoxDoesNotTouchIt) {
  ModelDef def;
  const Material material{0.5, 0.5, 0};
  def.terrain_boxes.push_back({"post", {0, 0, 0}, {}, {0.5, 0.5, 0.5}, material});
  scenes::AddBall(def, "ball", 0.2, 0.1, {0.61, 0, 1}, material);  // 10 mm from the post
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 1000);
  EXPECT_NEAR(world.Body(0, 0).position_m.z, 1 - kG / 2, RoundOff(1000, 10));
  EXPECT_EQ(world.Body(0, 0).position_m.x, 0.61);
}

}  // namespace
}  // namespace taut::test
