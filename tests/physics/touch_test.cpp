/// Cables that come to lie against edges of the terrain (docs/theory/cables.md, section 6).

#include <gtest/gtest.h>

#include <vector>

#include "math/described_path.h"
#include "tests/physics/lanes_alike.h"

namespace taut::test {
namespace {

BodyDef Ball(double mass_kg, const Vec3& p, const Vec3& velocity = {}) {
  BodyDef body;
  body.mass_kg = mass_kg;
  body.com_m = p;
  body.velocity_m_per_s = velocity;
  body.inertia_kg_m2 = {1e-4, 1e-4, 1e-4, 0, 0, 0};
  return body;
}

CableDef Cable(const AttachmentDef& from, const AttachmentDef& to, double stiffness,
               double rest_length, double radius) {
  CableDef cable;
  cable.name = "cable";
  cable.attachments = {from, to};
  cable.stiffness_n_per_m = stiffness;
  cable.rest_length_m = rest_length;
  cable.touches = CableTouches::kTerrain;
  cable.radius_m = radius;
  return cable;
}

TerrainBoxDef Box(const Vec3& low, const Vec3& high) {
  TerrainBoxDef box;
  box.name = "box";
  box.center_m = 0.5 * (low + high);
  box.half_extents_m = 0.5 * (high - low);
  return box;
}

AttachmentDef Round(const Vec3& center, double radius) {
  return {kWorld, center, 0.0, WheelDef{{0, 1, 0}, radius, true, 0}};
}

/// The length of a path over the edges of a wall from x = 0 to 0.1 and 0.06 high.
double OverTheWall(const Vec3& from, const Vec3& to, double radius) {
  CableDef cable = Cable({kWorld, from}, {kWorld, to}, 1, 1, radius);
  cable.attachments = {
      {kWorld, from}, Round({0, 0, 0.06}, radius), Round({0.1, 0, 0.06}, radius), {kWorld, to}};
  return math::DescribedPath(cable).length_m();
}

TEST(Touch, ACableAcrossAWallLiesOverItsTwoEdges) {
  const Vec3 from{-0.3, 0, 0.05}, to{0.4, 0.1, 0.02};
  for (const double radius : {1e-4, 1e-3}) {
    ModelDef def;
    def.gravity_m_per_s2 = {};
    def.bodies = {Ball(1, from), Ball(1, to)};
    def.terrain_boxes = {Box({0, -1, -1}, {0.1, 1, 0.06})};
    def.cables = {Cable({0, from}, {1, to}, 1e-9, 0.1, radius)};
    Batch world = MakeBatch(def);
    world.Step(1e-3);
    EXPECT_EQ(world.CableBends(0, 0), 2);
    EXPECT_NEAR(world.Cable(0, 0).length_m, OverTheWall(from, to, radius), 1e-14);
    EXPECT_EQ(world.CablePath(0, 0).size(), 6u);
  }
}

/// Down on it from above, along it and up again: nowhere a jump.
TEST(Touch, LengthsAreThoseOfThePathWhereverItGoes) {
  const double radius = 1e-3;
  ModelDef def;
  def.gravity_m_per_s2 = {};
  const Vec3 from{-0.3, 0, 0.2}, to{0.4, 0.1, 0.2};
  def.bodies = {Ball(1, from), Ball(1, to)};
  def.terrain_boxes = {Box({0, -1, -1}, {0.1, 1, 0.06})};
  def.cables = {Cable({0, from}, {1, to}, 1e-9, 0.1, radius)};
  Batch world = MakeBatch(def);
  int most = 0, changes = 0, last = 0;
  for (int i = 0; i < 2000; ++i) {
    const double t = i * 1e-3;
    BodyState a = world.Body(0, 0), b = world.Body(0, 1);
    a.position_m = {-0.3 + 0.1 * std::sin(5 * t), 0.1 * t, 0.1 + 0.2 * std::cos(7 * t)};
    b.position_m = {0.4 - 0.1 * std::sin(3 * t), 0.1, 0.1 + 0.2 * std::cos(4 * t)};
    world.SetBodyState(0, 0, a);
    world.SetBodyState(0, 1, b);
    world.Step(1e-9);
    EXPECT_NEAR(world.Cable(0, 0).length_m, OverTheWall(a.position_m, b.position_m, radius), 1e-12)
        << i;
    const int now = world.CableBends(0, 0);
    changes += now != last;
    most = std::max(most, now);
    last = now;
  }
  EXPECT_EQ(most, 2);
  EXPECT_GT(changes, 5);
}

TEST(Touch, AnInterruptedPendulumKeepsItsEnergy) {
  const auto worst = [](double step_s) {
    ModelDef def;
    const Vec3 start{0.8, 0, -0.6};
    def.bodies = {Ball(0.2, start)};
    def.terrain_boxes = {Box({-0.03, -1, -0.61}, {-0.02, 1, -0.6})};
    const double fall = 0.2 * 9.81 * 0.6;
    def.cables = {Cable({kWorld, {}}, {0, start}, 2000, 1.0 - fall / 2000, 1e-3)};
    Batch world = MakeBatch(def);
    const double energy = EnergyOf(world);
    double off = 0, most = 0;
    int touches = 0, last = 0;
    for (int i = 0; i < StepsIn(20, step_s); ++i) {
      world.Step(step_s);
      off = std::max(off, std::fabs(EnergyOf(world) - energy) / fall);
      most = std::max(most, -world.Body(0, 0).position_m.x);
      touches += world.CableBends(0, 0) > last;
      last = world.CableBends(0, 0);
    }
    EXPECT_GT(most, 0.2);
    EXPECT_LT(most, 0.5);
    EXPECT_GT(touches, 8);
    return off;
  };
  EXPECT_LT(worst(1e-3), 0.003);
  EXPECT_LT(worst(5e-4), 0.001);
}

}  // namespace
}  // namespace taut::test
