/// Overlaps (penetration depths) of spheres, rods and boxes against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/world.h"
#include "tests/scenes/solids.h"

namespace taut::test {
namespace {

using List = ShapeRef::List;

BodyDef BodyAt(const Vec3& at, bool fixed = false) {
  BodyDef body;
  body.name = "body";
  body.mass_kg = 1;
  body.com_m = at;
  body.inertia_kg_m2 = scenes::BoxInertia(1, {0.1, 0.1, 0.1});
  body.fixed = fixed;
  return body;
}

PlaneDef Ground() {
  PlaneDef ground;
  ground.name = "ground";
  return ground;
}

/// Returns the only overlap.
Overlap OnlyOne(const WorldBatch& world) {
  const std::vector<Overlap> found = world.Overlaps(0);
  EXPECT_EQ(found.size(), 1u);
  return found.empty() ? Overlap{} : found[0];
}

TEST(Overlaps, ARodInAPlaneIsAsDeepAsItsLowerEnd) {
  ModelDef def;
  def.bodies = {BodyAt({0, 0, 0.1})};
  def.capsules = {{"rod", 0, {-0.5, 0, 0.195}, {0.5, 0, 0.005}, 0.02, {}, true}};
  def.planes = {Ground()};
  const Overlap overlap = OnlyOne(MakeBatch(def));
  EXPECT_EQ(overlap.a.list, List::kCapsules);
  EXPECT_EQ(overlap.b.list, List::kPlanes);
  EXPECT_EQ(overlap.body_a, 0);
  EXPECT_EQ(overlap.body_b, kWorld);
  EXPECT_NEAR(overlap.depth_m, 0.015, 1e-15);
  EXPECT_EQ(overlap.half_thickness_m, 0.02);
}

TEST(Overlaps, ABoxInAPlaneIsAsDeepAsItsLowestCornerAndHalfAsThickAsItsSmallestEdge) {
  ModelDef def;
  def.bodies = {BodyAt({0, 0, 0.3})};
  const Quat turn = scenes::Turn({0, 1, 0}, std::atan(1.0));  // 45 degrees
  def.boxes = {{"box", 0, {0, 0, 0.3}, turn, {0.3, 0.05, 0.2}, {}, true}};
  def.planes = {Ground()};
  const Overlap overlap = OnlyOne(MakeBatch(def));
  EXPECT_NEAR(overlap.depth_m, 0.5 * std::sqrt(0.5) - 0.3, 1e-15);
  EXPECT_EQ(overlap.half_thickness_m, 0.05);
}

TEST(Overlaps, TwoBodiesAreOneOverlapWithTheWorstOfTheirShapes) {
  ModelDef def;
  def.bodies = {BodyAt({0, 0, 1}), BodyAt({0, 0.1, 1})};
  def.capsules = {{"a", 0, {-1, 0, 1}, {1, 0, 1}, 0.06, {}, true},
                  {"b", 1, {-1, 0.1, 1}, {1, 0.1, 1}, 0.05, {}, true}};  // 1 cm: a fifth of `b`
  def.spheres = {{"thin", 1, {0, 0.065, 1}, 0.01, {}, true}};            // 5 mm: half of the radius
  Overlap overlap = OnlyOne(MakeBatch(def));
  EXPECT_EQ(overlap.depth_m > 0 ? overlap.half_thickness_m : 0, 0.01);
  EXPECT_NEAR(overlap.depth_m, 0.005, 1e-15);
  EXPECT_EQ(overlap.b.list == List::kSpheres || overlap.a.list == List::kSpheres, true);
  // Shapes that do not collide have no overlaps.
  def.spheres[0].collides = false;
  overlap = OnlyOne(MakeBatch(def));
  EXPECT_NEAR(overlap.depth_m, 0.01, 1e-15);
  EXPECT_EQ(overlap.half_thickness_m, 0.05);
}

TEST(Overlaps, TerrainBoxesCountAndTheThinnerOneSaysHowThick) {
  ModelDef def;
  def.bodies = {BodyAt({0, 0, 0.1})};
  def.spheres = {{"ball", 0, {0, 0, 0.1}, 0.1, {}, true}};
  def.terrain_boxes = {{"plate", {0, 0, -0.002}, {}, {1, 1, 0.004}, {}}};
  const Overlap overlap = OnlyOne(MakeBatch(def));
  EXPECT_EQ(overlap.b.list, List::kTerrainBoxes);
  EXPECT_NEAR(overlap.depth_m, 0.002, 1e-15);
  EXPECT_EQ(overlap.half_thickness_m, 0.004);
}

TEST(Overlaps, AreThoseOfTheMoment) {
  ModelDef def;
  def.bodies = {BodyAt({0, 0, 1})};
  def.spheres = {{"ball", 0, {0, 0, 1}, 0.1, {}, true}};
  def.planes = {Ground()};
  WorldBatchOptions two;
  two.worlds = 2;
  WorldBatch world = MakeBatch(def, two);
  EXPECT_TRUE(world.Overlaps(1).empty());
  BodyState state = world.Body(1, 0);
  state.position_m.z = 0.07;
  world.SetBodyState(1, 0, state);
  EXPECT_NEAR(world.Overlaps(1).at(0).depth_m, 0.03, 1e-15);
  EXPECT_TRUE(world.Overlaps(0).empty());
}

TEST(Overlaps, WhatDoesNotMoveMayBeInTheGround) {
  ModelDef def;
  def.bodies = {BodyAt({0, 0, 0}, true)};
  def.spheres = {{"ball", 0, {0, 0, 0}, 0.1, {}, true}};
  def.planes = {Ground()};
  EXPECT_TRUE(MakeBatch(def).Overlaps(0).empty());
}

}  // namespace
}  // namespace taut::test
