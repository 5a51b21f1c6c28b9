/// Stacked bodies: contact forces in closed form, and hard cases for the solver.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/constants.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

int AddBox(ModelDef& def, const std::string& name, double mass_kg, const Vec3& center,
           const Vec3& half, const Material& material) {
  const int index = static_cast<int>(def.bodies.size());
  BodyDef body;
  body.name = name;
  body.mass_kg = mass_kg;
  body.com_m = center;
  body.inertia_kg_m2 = scenes::BoxInertia(mass_kg, half);
  def.bodies.push_back(body);
  def.boxes.push_back({name, index, center, {}, half, material});
  return index;
}

/// Returns the force of body `b` (or the world) on body `a`, over all their contacts [N].
Vec3 ForceOn(const WorldBatch& world, int a, int b) {
  Vec3 sum;
  for (const ContactState& contact : world.Contacts(0)) {
    if (contact.body_a == a && contact.body_b == b) sum = sum + contact.force_n;
    if (contact.body_a == b && contact.body_b == a) sum = sum - contact.force_n;
  }
  return sum;
}

/// Checks that bodies are at their initial positions and at rest.
void ExpectAtRest(const WorldBatch& world, const ModelDef& def, double within_m) {
  for (int i = 0; i < static_cast<int>(def.bodies.size()); ++i) {
    const BodyDef& body = def.bodies[static_cast<std::size_t>(i)];
    EXPECT_LE(Distance(world.Body(0, i).position_m, body.com_m), within_m) << body.name;
    EXPECT_LE(Norm(world.Body(0, i).velocity_m_per_s), 1e-9) << body.name;
  }
}

TEST(Stack, ARodOnTwoRodsWeighsOnThemByTheLawOfTheLever) {
  // Two fixed rods at x = -a and x = b under a rod whose center is at x = 0.
  const Material material{0.5, 0.5, 0};
  for (const double a : {0.1, 0.2, 0.3}) {
    const double b = 0.4 - a;
    ModelDef def;
    for (const double x : {-a, b}) {
      const int rail = scenes::AddRod(def, "rail", 1, 0.02, {x, -0.3, 0}, {x, 0.3, 0}, material);
      def.bodies[static_cast<std::size_t>(rail)].fixed = true;
    }
    scenes::AddRod(def, "rod", 0.5, 0.02, {-0.5, 0, 0.04}, {0.5, 0, 0.04}, material);
    for (const double h : kThreeStepsS) {
      WorldBatch world = MakeBatch(def);
      world.Step(h, StepsIn(5, h));
      const double allowed = 0.5 * SolverError(1) / h;
      EXPECT_NEAR(ForceOn(world, 2, 0).z, 0.5 * kG * b / (a + b), allowed) << a << ' ' << h;
      EXPECT_NEAR(ForceOn(world, 2, 1).z, 0.5 * kG * a / (a + b), allowed) << a << ' ' << h;
      ExpectAtRest(world, def, 1e-8);
      EXPECT_EQ(world.Status(0).bits, kStatusOk);
    }
  }
}

TEST(Stack, ARodOnTwoRodsOnTheGroundStaysThoughAllCouldRoll) {
  // A neutral equilibrium: any numerical disturbance would make the rod roll away.
  const Material material{0.5, 0.5, 0};
  ModelDef def;
  scenes::AddGround(def, material);
  for (const double x : {-0.15, 0.25}) {
    scenes::AddRod(def, "roller", 0.2, 0.02, {x, -0.3, 0.02}, {x, 0.3, 0.02}, material);
  }
  scenes::AddRod(def, "rod", 0.5, 0.02, {-0.5, 0, 0.06}, {0.5, 0, 0.06}, material);
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 10000);
  const double share[] = {0.25 / 0.4, 0.15 / 0.4};
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(ForceOn(world, 2, i).z, 0.5 * kG * share[i], SolverError(1) / 1e-3) << i;
    EXPECT_NEAR(ForceOn(world, i, kWorld).z, (0.2 + 0.5 * share[i]) * kG, SolverError(1) / 1e-3);
  }
  ExpectAtRest(world, def, 1e-7);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
}

TEST(Stack, BoxesOnEachOtherCarryAllThatIsAboveThem) {
  const Material material{0.5, 0.5, 0};
  const std::vector<double> mass_kg{2, 0.5, 1, 0.2, 0.7};
  ModelDef def;
  scenes::AddGround(def, material);
  double top = 0;
  for (std::size_t i = 0; i < mass_kg.size(); ++i) {
    const Vec3 half{0.1 - 0.01 * static_cast<double>(i), 0.08, 0.03};
    AddBox(def, "box_" + std::to_string(i), mass_kg[i],
           {0.005 * static_cast<double>(i), 0, top + half.z}, half, material);
    top += 2 * half.z;
  }
  for (const double h : kThreeStepsS) {
    WorldBatch world = MakeBatch(def);
    world.Step(h, StepsIn(5, h));
    double above = 0;
    for (int i = static_cast<int>(mass_kg.size()) - 1; i >= 0; --i) {
      above += mass_kg[static_cast<std::size_t>(i)] * kG;
      const Vec3 force = ForceOn(world, i, i == 0 ? kWorld : i - 1);
      EXPECT_NEAR(force.z, above, 2 * SolverError(3) / h) << h << ", box " << i;
      EXPECT_LE(std::hypot(force.x, force.y), 2 * SolverError(3) / h) << h << ", box " << i;
    }
    ExpectAtRest(world, def, 1e-8);
    EXPECT_EQ(world.Status(0).bits, kStatusOk) << h;
  }
}

TEST(Stack, ARodInAGrooveSlidesAsItsWalledInFrictionSays) {
  // A groove of two planes, each at an angle b from the vertical plane, tilted by t along x: each
  // wall carries m g cos t / (2 sin b), so that a = g (sin t - mu cos t / sin b).
  const double b = 0.6, t = 0.7, mu = 0.2;
  const double a = kG * (std::sin(t) - mu * std::cos(t) / std::sin(b));
  ASSERT_GT(a, 0.5);
  const Material material{mu, mu, 0};
  ModelDef def;
  // The groove is level and gravity is tilted, so that all directions are simple.
  def.gravity_m_per_s2 = {kG * std::sin(t), 0, -kG * std::cos(t)};
  for (const double side : {-1.0, 1.0}) {
    PlaneDef plane;
    plane.name = side < 0 ? "left" : "right";
    plane.normal = {0, -side * std::cos(b), std::sin(b)};
    plane.material = material;
    def.planes.push_back(plane);
  }
  const double r = 0.02, up = r / std::sin(b);
  scenes::AddRod(def, "rod", 0.4, r, {-0.3, 0, up}, {0.3, 0, up}, material);
  for (const double h : kThreeStepsS) {
    WorldBatch world = MakeBatch(def);
    const int steps = StepsIn(1, h);
    world.Step(h, steps);
    EXPECT_LE(Distance(world.Body(0, 0).velocity_m_per_s, {a, 0, 0}), 0.005 * a) << h;
    EXPECT_LE(Distance(world.Body(0, 0).position_m, {a / 2, 0, up}), 0.005 * a / 2) << h;
    Vec3 force;
    for (const ContactState& contact : world.Contacts(0)) {
      force = force + contact.force_n;
    }
    EXPECT_NEAR(force.z, 0.4 * kG * std::cos(t), 0.4 * SolverError(10) / h) << h;
    EXPECT_EQ(world.Status(0).bits, kStatusOk) << h;
  }
}

TEST(Stack, ABallBetweenAWallAndASlopeWedgesItself) {
  // A ball between a vertical wall and a plane at 45 degrees, without friction: the wall's force is
  // m g tan 45 = m g, the slope's force m g / cos 45.
  const double r = 0.1, s = std::sqrt(0.5);
  ModelDef def;
  PlaneDef slope;
  slope.name = "slope";
  slope.normal = {s, 0, s};
  slope.material = {0, 0, 0};
  def.planes.push_back(slope);
  // The ball touches the slope at (-r s, 0, -r s) from its center at x = 1, z = r sqrt(2) - 1.
  const Vec3 center{1, 0, r / s - 1};
  def.terrain_boxes.push_back({"wall", {1 + r + 0.5, 0, 0}, {}, {0.5, 2, 2}, {0, 0, 0}});
  scenes::AddBall(def, "ball", 0.3, r, center, {0, 0, 0});
  for (const double h : kThreeStepsS) {
    WorldBatch world = MakeBatch(def);
    world.Step(h, StepsIn(3, h));
    EXPECT_LE(Distance(world.Body(0, 0).position_m, center), 1e-8) << h;
    const auto contacts = world.Contacts(0);
    ASSERT_EQ(contacts.size(), 2u);
    for (const ContactState& contact : contacts) {
      const double expected = contact.normal.z > 0.5 ? 0.3 * kG / s : 0.3 * kG;
      EXPECT_NEAR(Norm(contact.force_n), expected, 0.3 * SolverError(10) / h) << h;
    }
  }
}

TEST(Stack, ASlabTenThousandTimesAsHeavyAsThirtyBallsStandsOnThem) {
  // 60 contacts: every ball with the ground and the slab.
  const Material material{0.5, 0.5, 0};
  const double mass = 0.1, r = 0.05, ratio = 1e4;
  ModelDef def;
  scenes::AddGround(def, material);
  for (int i = 0; i < 30; ++i) {
    scenes::AddBall(def, "ball", mass, r, {0.2 * (i % 6), 0.2 * (i / 6), r}, material);
  }
  AddBox(def, "slab", ratio * mass, {0.5, 0.4, 2 * r + 0.1}, {0.7, 0.7, 0.1}, material);
  const double weight = (30 + ratio) * mass * kG;
  WorldBatch world = MakeBatch(def);
  for (int n = 0; n < 500; ++n) {
    world.Step(1e-3);
    ASSERT_EQ(world.Status(0).bits, kStatusOk) << n;
    ASSERT_LE(world.Status(0).residual_m_per_s, WorldBatchOptions().tolerance_m_per_s);
    ASSERT_EQ(world.Contacts(0).size(), 60u) << n;
  }
  double ground = 0;
  for (int i = 0; i < 30; ++i) ground += ForceOn(world, i, kWorld).z;
  // The error of the slab's weight is its mass times the error of its velocity, per step.
  EXPECT_NEAR(ground, weight, ratio * mass * SolverError(1) / 1e-3);
  ExpectAtRest(world, def, 1e-8);
}

TEST(Stack, BoxesThatAlternateByTenThousandOverSixtyContactsConverge) {
  // Fifteen boxes on each other, every other one 10^4 times as heavy as its neighbors: the worst
  // case for Gauss-Seidel sweeps.
  const Material material{0.5, 0.5, 0};
  const Vec3 half{0.1, 0.08, 0.02};
  ModelDef def;
  scenes::AddGround(def, material);
  for (int i = 0; i < 15; ++i) {
    AddBox(def, "box_" + std::to_string(i), i % 2 == 0 ? 0.1 : 1000, {0, 0, half.z * (2 * i + 1)},
           half, material);
  }
  WorldBatch world = MakeBatch(def);
  for (int n = 0; n < 500; ++n) {
    world.Step(1e-3);
    ASSERT_EQ(world.Status(0).bits, kStatusOk) << n;
    ASSERT_LE(world.Status(0).residual_m_per_s, WorldBatchOptions().tolerance_m_per_s) << n;
    ASSERT_GE(world.Contacts(0).size(), 60u) << n;
  }
  double above = 0;
  for (int i = 14; i >= 0; --i) {
    above += def.bodies[static_cast<std::size_t>(i)].mass_kg * kG;
    EXPECT_NEAR(ForceOn(world, i, i == 0 ? kWorld : i - 1).z, above, 1000 * SolverError(15) / 1e-3)
        << i;
  }
  ExpectAtRest(world, def, 1e-8);
}

TEST(Stack, ASolverThatIsStoppedEarlySaysSoInTheSameStep) {
  // With a low limit of linear solves, every step with a large residual reports it.
  const Material material{0.5, 0.5, 0};
  const Vec3 half{0.1, 0.08, 0.02};
  ModelDef def;
  scenes::AddGround(def, material);
  for (int i = 0; i < 15; ++i) {
    AddBox(def, "box_" + std::to_string(i), i % 2 == 0 ? 0.1 : 1000, {0, 0, half.z * (2 * i + 1)},
           half, material);
  }
  WorldBatchOptions options;
  options.max_linear_solves = 5;
  WorldBatch world = MakeBatch(def, options);
  int stopped = 0;
  for (int n = 0; n < 10; ++n) {
    world.ClearStatus(0);
    world.Step(1e-3);
    const WorldStatus status = world.Status(0);
    const bool says = (status.bits & kStatusNotConverged) != 0;
    ASSERT_EQ(says, status.residual_m_per_s > options.tolerance_m_per_s) << n;
    if (!says) continue;
    ++stopped;
    // All solves allowed for velocities, and at most as many for position projection.
    ASSERT_GE(status.linear_solves, options.max_linear_solves) << n;
    ASSERT_LE(status.linear_solves, 2 * options.max_linear_solves) << n;
  }
  EXPECT_GT(stopped, 0);
}

}  // namespace
}  // namespace taut::test
