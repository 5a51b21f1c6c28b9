/// Position projection: bodies that start in penetration separate without gaining speed
/// (docs/theory/contact.md, section 3).

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/prism3.h"
#include "tests/scenes/rod.h"
#include "tests/scenes/tetraspine3.h"

namespace taut::test {
namespace {

TEST(PushOut, ABallInTheGroundComesOutAndDoesNotRise) {
  for (const double h : {4e-3, 1e-3, 1e-4}) {
    for (const double depth : {1e-4, 1e-3, 1e-2}) {
      scenes::Ball scene;
      scene.radius_m = 0.05;
      scene.drop_m = -depth;
      WorldBatch world = MakeBatch(scene.Def());
      double highest = -1;
      for (int n = 0; n < StepsIn(1, h); ++n) {
        world.Step(h);
        highest = std::max(highest, world.Body(0, 0).position_m.z - scene.radius_m);
      }
      EXPECT_LE(highest, 1e-9) << h << " " << depth;
      EXPECT_NEAR(world.Body(0, 0).position_m.z, scene.radius_m, 1e-9) << h << " " << depth;
      EXPECT_LE(Norm(world.Body(0, 0).velocity_m_per_s), 1e-9) << h << " " << depth;
    }
  }
}

/// Two seconds of a robot whose lowest points start `depth` deep in the ground.
struct PushedRise {
  double speed_m_per_s = 0;  ///< Largest upward speed of any body.
  double height_m = 0;       ///< Largest rise of any body above its start.
  double gap_m = 0;          ///< Deepest contact at the end.
};
PushedRise RiseOf(ModelDef def, double depth, double h) {
  double low = 1;
  for (const CapsuleDef& c : def.capsules) {
    low = std::min({low, c.from_m.z - c.radius_m, c.to_m.z - c.radius_m});
  }
  for (const SphereDef& s : def.spheres) low = std::min(low, s.center_m.z - s.radius_m);
  def.planes.clear();
  scenes::AddGround(def, {0.5, 0.5, 0});
  def.planes[0].point_m = {0, 0, low + depth};
  def.restitution_combine = CombineRule::kMinimum;
  WorldBatch world = MakeBatch(def);
  PushedRise rise;
  for (int n = 0; n < StepsIn(2, h); ++n) {
    world.Step(h);
    for (std::size_t b = 0; b < def.bodies.size(); ++b) {
      const BodyState body = world.Body(0, static_cast<int>(b));
      rise.speed_m_per_s = std::max(rise.speed_m_per_s, body.velocity_m_per_s.z);
      rise.height_m = std::max(rise.height_m, body.position_m.z - def.bodies[b].com_m.z);
    }
  }
  for (const ContactState& c : world.Contacts(0)) rise.gap_m = std::min(rise.gap_m, c.gap_m);
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
  return rise;
}

TEST(PushOut, ASpineInTheGroundGoesUpNoFasterThanOneOnIt) {
  const ModelDef def = scenes::Tetraspine().Def();
  for (const double h : {1e-3, 1e-4}) {
    const PushedRise without = RiseOf(def, -1e-6, h), with = RiseOf(def, 1e-3, h);
    EXPECT_LE(with.speed_m_per_s, 0.1030) << h;
    EXPECT_LE(with.speed_m_per_s, without.speed_m_per_s + 0.0025) << h;
    EXPECT_GE(with.gap_m, -1e-9) << h;
  }
}

TEST(PushOut, APrismInTheGroundComesOutNoHigherThanItWasDeep) {
  // Position projection displaces each rod separately and so stretches cables, which then move the
  // prism, equally at all steps with explicit cable forces. At 1 ms they are implicit, and
  // penetration is resolved by velocities.
  scenes::Prism3 scene;
  scene.damping_n_s_per_m = 10;
  for (const double depth : {1e-3, 5e-3}) {
    const PushedRise coarse = RiseOf(scene.Def(), depth, 2e-4),
                     fine = RiseOf(scene.Def(), depth, 1e-4);
    for (const PushedRise& rise : {coarse, fine, RiseOf(scene.Def(), depth, 1e-3)}) {
      EXPECT_LE(rise.height_m, 1.02 * depth) << depth;
      EXPECT_LE(rise.speed_m_per_s, 42 * depth) << depth;
      EXPECT_GE(rise.gap_m, -1e-9) << depth;
    }
    // The initial upward motion caused by the cables lasts a few steps of 1 ms.
    EXPECT_NEAR(coarse.speed_m_per_s, fine.speed_m_per_s, 0.04 * fine.speed_m_per_s) << depth;
    EXPECT_NEAR(coarse.height_m, fine.height_m, 0.02 * fine.height_m) << depth;
  }
}

ModelDef OverlappingRods(double depth) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  const Material material{0.5, 0.5, 0};
  scenes::AddRod(def, "one", 0.1, 0.01, {-0.2, 0, 0}, {0.2, 0, 0}, material);
  scenes::AddRod(def, "two", 0.1, 0.01, {0.05, -0.15, 0.02 - depth}, {0.1, 0.25, 0.02 - depth},
                 material);
  return def;
}

TEST(PushOut, TwoRodsInEachOtherPartWithoutSpeed) {
  for (const double h : {4e-3, 1e-3, 1e-4}) {
    WorldBatch world = MakeBatch(OverlappingRods(2e-3));
    world.Step(h, 100);
    for (int b = 0; b < 2; ++b) {
      EXPECT_LE(Norm(world.Body(0, b).velocity_m_per_s), 1e-9) << h;
      EXPECT_LE(Norm(world.Body(0, b).angular_velocity_rad_per_s), 1e-9) << h;
    }
    for (const ContactState& c : world.Contacts(0)) EXPECT_GE(c.gap_m, -1e-9) << h;
    EXPECT_LE(Norm(world.AngularMomentum(0)), RoundOff(100, 1e-9)) << h;
  }
}

TEST(PushOut, TwoRodsThatMoveAndSpinKeepTheirMomentaWhileTheyArePushedOut) {
  for (const double h : {4e-3, 1e-3, 1e-4}) {
    ModelDef def = OverlappingRods(2e-3);
    def.bodies[0].velocity_m_per_s = {0.8, -0.3, 0.5};
    def.bodies[0].angular_velocity_rad_per_s = {5, 3, -2};
    def.bodies[1].velocity_m_per_s = {0.5, 0.7, 0.1};
    def.bodies[1].angular_velocity_rad_per_s = {-1, 4, 6};
    WorldBatch world = MakeBatch(def);
    const Vec3 p0 = world.Momentum(0), l0 = world.AngularMomentum(0);
    bool touched = false;
    for (int n = 1; n <= 200; ++n) {
      world.Step(h);
      touched = touched || !world.Contacts(0).empty();
      // No momentum here is above 0.3, no angular momentum above 0.3.
      ASSERT_LE(Distance(world.Momentum(0), p0), RoundOff(n, 0.3)) << h << " " << n;
      ASSERT_LE(Distance(world.AngularMomentum(0), l0), RoundOff(n, 0.3)) << h << " " << n;
    }
    EXPECT_TRUE(touched);
  }
}

}  // namespace
}  // namespace taut::test
