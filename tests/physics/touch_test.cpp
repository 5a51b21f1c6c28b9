/// Cable wrapping on edges of the terrain (docs/theory/cables.md, section 6).

#include <gtest/gtest.h>

#include <vector>

#include "math/described_path.h"
#include "tests/physics/lanes_alike.h"
#include "tests/physics/touch_scenes.h"

namespace taut::test {
namespace {

AttachmentDef TouchRound(const Vec3& center, double radius) {
  return {kWorld, center, 0.0, WheelDef{{0, 1, 0}, radius, true, 0}};
}

/// Returns the length of a path over the edges of a wall from x = 0 to 0.1 and 0.06 high.
double OverTheWall(const Vec3& from, const Vec3& to, double radius) {
  CableDef cable = Cable({kWorld, from}, {kWorld, to}, 1, 1, radius);
  cable.attachments = {{kWorld, from},
                       TouchRound({0, 0, 0.06}, radius),
                       TouchRound({0.1, 0, 0.06}, radius),
                       {kWorld, to}};
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
    WorldBatch world = MakeBatch(def);
    world.Step(1e-3);
    EXPECT_EQ(world.CableBends(0, 0), 2);
    EXPECT_NEAR(world.Cable(0, 0).length_m, OverTheWall(from, to, radius), 1e-14);
    EXPECT_EQ(world.CablePath(0, 0).size(), 6u);
    const std::vector<Vec3> bends = world.CableBendPlaces(0, 0);
    ASSERT_EQ(bends.size(), 2u);
    EXPECT_LT(std::hypot(bends[0].x, bends[0].z - 0.06), 1.001 * radius);
    EXPECT_LT(std::hypot(bends[1].x - 0.1, bends[1].z - 0.06), 1.001 * radius);
  }
}

/// Down onto the wall from above, along it and up again: the length has no jumps.
TEST(Touch, LengthsAreThoseOfThePathWhereverItGoes) {
  const double radius = 1e-3;
  ModelDef def;
  def.gravity_m_per_s2 = {};
  const Vec3 from{-0.3, 0, 0.2}, to{0.4, 0.1, 0.2};
  def.bodies = {Ball(1, from), Ball(1, to)};
  def.terrain_boxes = {Box({0, -1, -1}, {0.1, 1, 0.06})};
  def.cables = {Cable({0, from}, {1, to}, 1e-9, 0.1, radius)};
  WorldBatch world = MakeBatch(def);
  int most = 0, changes = 0, last = 0;
  for (int i = 0; i < 2000; ++i) {
    const double t = i * 1e-3;
    Lead(world, 0, {-0.3 + 0.1 * std::sin(5 * t), 0.1 * t, 0.1 + 0.2 * std::cos(7 * t)});
    Lead(world, 1, {0.4 - 0.1 * std::sin(3 * t), 0.1, 0.1 + 0.2 * std::cos(4 * t)});
    world.Step(kStep);
    const Vec3 a = world.Body(0, 0).position_m, b = world.Body(0, 1).position_m;
    Lead(world, 0, a), Lead(world, 1, b);
    world.Step(kStep);  // contacts are found in the middle of a step
    EXPECT_NEAR(world.Cable(0, 0).length_m, OverTheWall(a, b, radius), 1e-12) << i;
    const int now = world.CableBends(0, 0);
    changes += now != last;
    most = std::max(most, now);
    last = now;
  }
  EXPECT_EQ(most, 2);
  EXPECT_GT(changes, 5);
}

TEST(Touch, OverAHeapOfBoxesItLiesOverAllOfTheirEdgesThatStickOut) {
  const double radius = 1e-3;
  const Vec3 from{-0.3, 0, 0.01}, to{0.4, 0.1, 0.005};
  ModelDef def;
  def.gravity_m_per_s2 = {};
  def.bodies = {Ball(1, from), Ball(1, to)};
  def.terrain_boxes = {Box({-0.1, -1, -1}, {0, 1, 0.045}), Box({0, -1, -1}, {0.1, 1, 0.06}),
                       Box({0.1, -1, -1}, {0.2, 1, 0.045})};
  def.cables = {Cable({0, from}, {1, to}, 1e-9, 0.1, radius)};
  WorldBatch world = MakeBatch(def);
  world.Step(kStep);
  EXPECT_EQ(world.CableBends(0, 0), 4);
  CableDef path = def.cables[0];
  path.attachments = {{kWorld, from},
                      TouchRound({-0.1, 0, 0.045}, radius),
                      TouchRound({0, 0, 0.06}, radius),
                      TouchRound({0.1, 0, 0.06}, radius),
                      TouchRound({0.2, 0, 0.045}, radius),
                      {kWorld, to}};
  EXPECT_NEAR(world.Cable(0, 0).length_m, math::DescribedPath(path).length_m(), 1e-12);
}

TEST(Touch, ABarIsPassedOnTheSideToWhichItTakesLess) {
  const auto middle_of = [](const Vec3& from, const Vec3& to) {
    ModelDef def;
    def.gravity_m_per_s2 = {};
    def.bodies = {Ball(1, from), Ball(1, to)};
    def.terrain_boxes = {Box({0, -1, 0}, {0.1, 1, 0.06})};
    def.cables = {Cable({0, from}, {1, to}, 1e-9, 0.1, 1e-3)};
    WorldBatch world = MakeBatch(def);
    world.Step(kStep);
    return world.CableBendPlaces(0, 0).at(0);
  };
  // The straight path enters the wall 25 mm below the top and leaves it 5 mm above the bottom; also
  // mirrored.
  EXPECT_LT(Distance(middle_of({-0.3, 0, 0.125}, {0.4, 0, -0.085}), {0, 0, 0}), 2e-3);
  EXPECT_LT(Distance(middle_of({-0.3, 0, -0.065}, {0.4, 0, 0.145}), {0, 0, 0.06}), 2e-3);
}

/// A ridge of a height field, whose edge consists of pieces, and a mesh in the shape of a box.
TEST(Touch, RidgesOfFieldsAndMeshesAreEdges) {
  const double radius = 1e-3, height = 0.06;
  HeightFieldDef field;
  field.name = "field";
  field.columns = field.rows = 21;
  field.cell_m = 0.05;
  for (int j = 0; j < 21; ++j) {
    for (int i = 0; i < 21; ++i) field.height_m.push_back(i == 10 ? height : 0.0);
  }
  TerrainMeshDef mesh;
  mesh.name = "mesh";
  const double x[2] = {0, 0.1}, y[2] = {-1, 1}, z[2] = {-1, height};
  for (int k = 0; k < 8; ++k) mesh.corners_m.push_back({x[k & 1], y[k >> 1 & 1], z[k >> 2]});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const auto over_the_ridge = [&](const Vec3& from, const Vec3& to) {
    CableDef cable = Cable({kWorld, from}, {kWorld, to}, 1, 1, radius);
    cable.attachments = {{kWorld, from}, TouchRound({0, 0, height}, radius), {kWorld, to}};
    return math::DescribedPath(cable).length_m();
  };
  for (const bool is_field : {true, false}) {
    const Vec3 from{-0.3, 0, 0.2}, to{0.4, 0.1, 0.2};
    ModelDef def;
    def.gravity_m_per_s2 = {};
    def.bodies = {Ball(1, from), Ball(1, to)};
    def.cables = {Cable({0, from}, {1, to}, 1e-9, 0.1, radius)};
    if (is_field) {
      def.height_fields = {field};
    } else {
      def.terrain_meshes = {mesh};
    }
    WorldBatch world = MakeBatch(def);
    int bent = 0;
    for (int i = 0; i < 1000; ++i) {
      const double t = i * 1e-3;
      Lead(world, 0, {-0.3, 0.2 * std::sin(4 * t), 0.08 + 0.07 * std::cos(7 * t)});
      Lead(world, 1, {0.4, 0.1, 0.08 + 0.07 * std::cos(4 * t)});
      world.Step(kStep);
      const Vec3 a = world.Body(0, 0).position_m, b = world.Body(0, 1).position_m;
      Lead(world, 0, a), Lead(world, 1, b);
      world.Step(kStep);
      const double expected = is_field ? over_the_ridge(a, b) : OverTheWall(a, b, radius);
      ASSERT_NEAR(world.Cable(0, 0).length_m, expected, 1e-9) << is_field << " " << i;
      bent += world.CableBends(0, 0) > 0;
    }
    EXPECT_GT(bent, 100);
  }
}

TEST(Touch, AnInterruptedPendulumKeepsItsEnergy) {
  const auto worst = [](double step_s) {
    ModelDef def;
    const Vec3 start{0.8, 0, -0.6};
    def.bodies = {Ball(0.2, start)};
    def.terrain_boxes = {Box({-0.03, -1, -0.61}, {-0.02, 1, -0.6})};
    const double fall = 0.2 * 9.81 * 0.6;
    def.cables = {Cable({kWorld, {}}, {0, start}, 2000, 1.0 - fall / 2000, 1e-3)};
    WorldBatch world = MakeBatch(def);
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

TEST(Touch, ASkewCableOverARodMeetsItAtTheSameAngleBeforeAndBehind) {
  const Vec3 from{-0.3, -0.1, -0.2}, to{0.4, 0.15, -0.1};
  WorldBatch world = MakeBatch(OverARod(from + Vec3{0, 0, 1}, to + Vec3{0, 0, 1}, 0.01, 0.001));
  for (int i = 0; i <= 100; ++i) {
    Lead(world, 0, from + Vec3{0, 0, 1 - 0.01 * i});
    Lead(world, 1, to + Vec3{0, 0, 1 - 0.01 * i});
    world.Step(kStep);
  }
  EXPECT_NEAR(world.Cable(0, 0).length_m, 0.820470984681, 5e-13);
}

/// From above to far below the rod, at the highest speed in one step.
TEST(Touch, NoCableGoesThroughARodHoweverFast) {
  for (const double speed : {0.01, 5.0, 50.0, 500.0}) {
    const Vec3 from{-0.3, 0.1, 0.02}, to{0.4, -0.1, 0.02};
    ModelDef def = OverARod(from, to, 0.003, 1e-4);
    def.bodies[0].velocity_m_per_s = def.bodies[1].velocity_m_per_s = {0, 0, -speed};
    WorldBatch world = MakeBatch(def);
    int steps = 0;
    while (world.Body(0, 0).position_m.z > -0.05) world.Step(1e-3), ++steps;
    EXPECT_EQ(world.CableBends(0, 0), 1) << speed;
    EXPECT_GT(world.Cable(0, 0).length_m, std::hypot(0.7, 0.2) + 1e-4) << speed;
  }
  // Beyond the rod's end there is no contact.
  ModelDef def = OverARod({-0.3, 0.31, 0.1}, {0.4, 0.31, 0.1}, 0.003, 1e-4);
  def.bodies[0].velocity_m_per_s = def.bodies[1].velocity_m_per_s = {0, 0, -5.0};
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 50);
  EXPECT_LT(world.Body(0, 0).position_m.z, -0.1);
  EXPECT_EQ(world.CableBends(0, 0), 0);
}

/// Both ends of the cable are moved along the rod or edge.
TEST(Touch, WhereARodOrAnEdgeEndsItSlipsOff) {
  const Vec3 from{-0.3, 0, 0.02}, to{0.4, 0, 0.02};
  ModelDef rod = OverARod(from, to, 0.03, 1e-3), wall;
  wall.gravity_m_per_s2 = {};
  wall.bodies = {Ball(1, from), Ball(1, to)};
  wall.terrain_boxes = {Box({0, -1, -1}, {0.1, 0.3, 0.06})};
  wall.cables = {Cable({0, from}, {1, to}, 1e-9, 0.1, 1e-3)};
  for (const bool is_rod : {true, false}) {
    WorldBatch world = MakeBatch(is_rod ? rod : wall);
    // On a box, three radii before the corner.
    const double end = is_rod ? 0.3 : 0.297;
    for (const double along : {0.0, 0.1, 0.2, end - 1e-4, end + 1e-4, 0.32}) {
      Lead(world, 0, from + Vec3{0, along, 0});
      Lead(world, 1, to + Vec3{0, along, 0});
      world.Step(kStep);
      Lead(world, 0, world.Body(0, 0).position_m);
      Lead(world, 1, world.Body(0, 1).position_m);
      world.Step(kStep);
      int over = 0;  // bends over the top; around the wall's end further bends are allowed
      for (const Vec3& bend : world.CableBendPlaces(0, 0)) over += bend.z > 0.025;
      const int most = is_rod ? 1 : 2;
      EXPECT_EQ(over, along < end ? most : 0) << is_rod << " " << along;
    }
    EXPECT_EQ(world.CableBends(0, 0), 0);
    EXPECT_NEAR(world.Cable(0, 0).length_m, Distance(from, to), 1e-12);
  }
}

TEST(Touch, ARodWindsUpAndUnwindsAnyNumberOfTurns) {
  const double radius = 0.004, far = 0.3;
  const Vec3 from{-far, 0, 0};
  WorldBatch world = MakeBatch(OverARod(from, {far, 0, 0.01}, radius, 1e-4));
  const double tangent = std::sqrt(far * far - radius * radius);
  for (int i = 0; i <= 810; ++i) {
    // Downwards, three and a half turns around, and back.
    const double turn = 0.5 - 0.06 * (i <= 400 ? i : 800 - i);
    const Vec3 to{far * std::cos(turn), 0, far * std::sin(turn)};
    Lead(world, 1, to);
    world.Step(kStep);
    Lead(world, 1, world.Body(0, 1).position_m);
    world.Step(kStep);
    const double theta = std::acos(-1.0) - turn - 2 * std::acos(radius / far);
    const double expected = theta > 0 ? 2 * tangent + radius * theta : Distance(from, to);
    ASSERT_NEAR(world.Cable(0, 0).length_m, expected, 1e-12) << i;
    const std::vector<Vec3> bends = world.CableBendPlaces(0, 0);
    ASSERT_EQ(bends.size(), theta > 0 ? 1u : 0u) << i;
    if (bends.empty()) continue;
    const double middle = 0.5 * (std::acos(-1.0) + turn);  // between the ends, on the wrapped side
    const Vec3 expected_m{radius * std::cos(middle), 0, radius * std::sin(middle)};
    ASSERT_LT(Distance(bends[0], expected_m), 1e-12) << i;
  }
}

/// On a flying and rotating rod: the rate for sensors against a difference of lengths.
TEST(Touch, TheRateIsThatOfTheLength) {
  WorldBatch world = MakeBatch(OverARod({-0.3, 0.1, -0.02}, {0.4, 0.05, 0.03}, 0.02, 1e-3));
  BodyState rod = world.Body(0, 2);
  rod.velocity_m_per_s = {0.3, -0.2, 0.4};
  rod.angular_velocity_rad_per_s = {2, 1, -3};
  world.SetBodyState(0, 2, rod);
  world.Step(1e-6);
  ASSERT_EQ(world.CableBends(0, 0), 1);
  const CableState before = world.Cable(0, 0);
  world.Step(1e-6);
  const CableState behind = world.Cable(0, 0);
  EXPECT_NEAR(0.5 * (before.rate_m_per_s + behind.rate_m_per_s),
              1e6 * (behind.length_m - before.length_m), 1e-7);
  EXPECT_GT(std::fabs(behind.rate_m_per_s), 0.05);
}

/// Flies for 10 s and counts the steps in which the cable touches. Momenta are kept to 1e-12, the
/// energy to `energy_share`.
void FlyKeepingAll(double energy_share, WorldBatch& world, int& touched) {
  const double energy = EnergyOf(world);
  const Vec3 momentum = world.Momentum(0), angular = world.AngularMomentum(0);
  touched = 0;
  for (int i = 0; i < 10000; ++i) {
    world.Step(1e-3);
    touched += world.CableBends(0, 0);
    ASSERT_LT(Distance(world.Momentum(0), momentum), 1e-12) << i;
    ASSERT_LT(Distance(world.AngularMomentum(0), angular), 1e-12 * Norm(angular)) << i;
    ASSERT_NEAR(EnergyOf(world), energy, energy_share * energy) << i;
  }
}

TEST(Touch, AFlightOverAFreeRodKeepsMomentaAndEnergy) {
  WorldBatch world = MakeBatch(Flight());
  int touched = 0;
  ASSERT_NO_FATAL_FAILURE(FlyKeepingAll(1e-4, world, touched));
  EXPECT_GT(touched, 100);
  EXPECT_GT(world.Body(0, 2).velocity_m_per_s.x, 0.1);
}

TEST(Touch, WhatNtrtLosesInMuscleNpIsKept) {
  WorldBatch world = MakeBatch(MuscleNp());
  // NTRT ends with 0.86466503, -0.041891, 0.83705044 of 1, 0, 1
  EXPECT_NEAR(world.Momentum(0).x, 0.8, 1e-12);
  EXPECT_NEAR(world.Momentum(0).z, 0.8, 1e-12);
  int touched = 0;
  ASSERT_NO_FATAL_FAILURE(FlyKeepingAll(1e-6, world, touched));
  EXPECT_GT(touched, 1000);
  EXPECT_GT(Norm(world.Body(0, 2).velocity_m_per_s), 0.5);
}

TEST(Touch, LanesAreLikeWorldsAlone) {
  ExpectLanesLikeWorldsAlone(Flight(), {0.02, 0.01, 0.03}, 2000);
  ModelDef wall;
  const Vec3 from{-0.3, 0, 0.1}, to{0.4, 0.1, 0.07};
  wall.bodies = {Ball(1, from), Ball(1, to)};
  wall.terrain_boxes = {Box({0, -1, -1}, {0.1, 1, 0.06})};
  wall.cables = {Cable({0, from}, {1, to}, 1000, Distance(from, to), 1e-3)};
  ExpectLanesLikeWorldsAlone(wall, {0.01, 0.01, 0.02}, 300);
}

}  // namespace
}  // namespace taut::test
