/// Impacts: height of rebounds, and no bounces at rest (docs/theory/contact.md).

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/constants.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/block_on_slope.h"

namespace taut::test {
namespace {

/// Steps until the ball has bounced `bounces` times and is in flight again. Returns the apex of its
/// flight above the ground [m], which is exact: the scheme keeps parabolas.
double HeightAfter(WorldBatch& world, int bounces, double radius_m, double h) {
  int seen = 0, flying = 0;
  double before = world.Body(0, 0).velocity_m_per_s.z;
  for (int n = 0; n < StepsIn(10, h); ++n) {
    world.Step(h);
    const BodyState ball = world.Body(0, 0);
    if (ball.velocity_m_per_s.z > 0 && before <= 0) {
      ++seen;
      flying = 0;
    }
    before = ball.velocity_m_per_s.z;
    if (seen == bounces && ++flying == 3) {
      return ball.position_m.z - radius_m +
             ball.velocity_m_per_s.z * ball.velocity_m_per_s.z / (2 * kG);
    }
  }
  return NAN;
}

TEST(Bounce, ABallRisesToESquaredTimesItsHeightAtAnyStepSize) {
  for (const double e : {0.2, 0.5, 0.9}) {
    for (const double h : kThreeStepsS) {
      // Heights whose impacts fall early and late in a step.
      for (const double drop : {1.0, 1.003, 1.007, 1.011, 1.017}) {
        scenes::Ball scene;
        scene.drop_m = drop;
        scene.material.restitution = e;
        WorldBatch world = MakeBatch(scene.Def());
        const double rise = HeightAfter(world, 1, scene.radius_m, h);
        EXPECT_NEAR(rise / drop, e * e, 0.001 * e * e) << "e " << e << ", " << h << " s, " << drop;
      }
    }
  }
}

TEST(Bounce, EveryFurtherBounceLosesTheSameShare) {
  for (const double h : kThreeStepsS) {
    scenes::Ball scene;
    scene.drop_m = 1;
    scene.material.restitution = 0.9;
    for (int bounces = 2; bounces <= 5; ++bounces) {
      WorldBatch world = MakeBatch(scene.Def());
      const double share = std::pow(0.81, bounces);
      EXPECT_NEAR(HeightAfter(world, bounces, scene.radius_m, h), share, 0.001 * bounces * share)
          << bounces << " bounces at " << h << " s";
    }
  }
}

TEST(Bounce, ABallWithoutWeightReboundsWithETimesItsSpeed) {
  // No force acts during the impact: the rebound is exactly e v.
  for (const double e : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    for (const double h : kThreeStepsS) {
      scenes::Ball scene;
      scene.drop_m = 0.1;
      scene.material.restitution = e;
      ModelDef def = scene.Def();
      def.gravity_m_per_s2 = {0, 0, 0};
      def.bodies[0].velocity_m_per_s = {0, 0, -1.7};
      WorldBatch world = MakeBatch(def);
      world.Step(h, StepsIn(0.5, h));
      EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.z, 1.7 * e, SolverError(2)) << e << " " << h;
    }
  }
}

TEST(Bounce, AnImpactWithoutRestitutionStopsAtTheSurface) {
  for (const double h : kThreeStepsS) {
    scenes::Ball scene;
    scene.drop_m = 1;
    WorldBatch world = MakeBatch(scene.Def());
    double lowest = 1;
    for (int n = 0; n < StepsIn(1, h); ++n) {
      world.Step(h);
      lowest = std::min(lowest, world.Body(0, 0).position_m.z - scene.radius_m);
    }
    // The ball arrives at 4.43 m/s, and contacts are found at the middle of a step: half a step's
    // travel.
    EXPECT_GT(lowest, -4.43 * h / 2);
    // Position projection corrects the penetration.
    world.Step(h, 300);
    EXPECT_NEAR(world.Body(0, 0).position_m.z, scene.radius_m, 1e-9);
    EXPECT_LT(Norm(world.Body(0, 0).velocity_m_per_s), 1e-9);
  }
}

TEST(Bounce, AtRestNothingSinksOrJitters) {
  for (const double e : {0.0, 0.5, 1.0}) {
    for (const double h : kThreeStepsS) {
      scenes::Ball ball;
      ball.material.restitution = e;
      scenes::BlockOnSlope block;
      block.material.restitution = block.slope.material.restitution = e;
      for (const ModelDef& def : {ball.Def(), block.Def()}) {
        WorldBatch world = MakeBatch(def);
        const double z = world.Body(0, 0).position_m.z;
        for (int n = 0; n < StepsIn(10, h); ++n) {
          world.Step(h);
          // A velocity below the solver's tolerance may remain, for at most one step, until it has
          // become a gap.
          ASSERT_LE(Norm(world.Body(0, 0).velocity_m_per_s), SolverError(1)) << def.name << e << h;
          ASSERT_NEAR(world.Body(0, 0).position_m.z, z, SolverError(1)) << def.name << e << h;
        }
      }
    }
  }
}

TEST(Bounce, ARestingBallCarriesItsWeight) {
  scenes::Ball scene;
  WorldBatch world = MakeBatch(scene.Def());
  world.Step(1e-3, 10);
  const auto contacts = world.Contacts(0);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].body_a, 0);
  EXPECT_EQ(contacts[0].body_b, kWorld);
  EXPECT_LE(Distance(contacts[0].normal, {0, 0, 1}), 0);
  EXPECT_LE(Distance(contacts[0].point_m, {0, 0, 0}), SolverError(10));
  EXPECT_NEAR(contacts[0].gap_m, 0, SolverError(10));
  EXPECT_LE(Distance(contacts[0].force_n, {0, 0, 0.2 * kG}), 0.2 * SolverError(1) / 1e-3);
}

TEST(Bounce, RestitutionsOfTwoMaterialsCombineAsTheModelSays) {
  const struct {
    CombineRule rule;
    double e;
  } cases[] = {{CombineRule::kProduct, 0.9 * 0.4},
               {CombineRule::kGeometricMean, 0.6},
               {CombineRule::kMinimum, 0.4},
               {CombineRule::kMaximum, 0.9}};
  for (const auto& c : cases) {
    scenes::Ball scene;
    scene.drop_m = 0.1;
    ModelDef def = scene.Def();
    def.gravity_m_per_s2 = {0, 0, 0};
    def.restitution_combine = c.rule;
    def.spheres[0].material.restitution = 0.9;
    def.planes[0].material.restitution = 0.4;
    def.bodies[0].velocity_m_per_s = {0, 0, -1};
    WorldBatch world = MakeBatch(def);
    world.Step(1e-3, 500);
    EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.z, c.e, SolverError(2));
  }
}

}  // namespace
}  // namespace taut::test
