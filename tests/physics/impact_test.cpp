/// Impacts with several contacts, and the accuracy of a single impact (docs/theory/contact.md,
/// section 3).

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "tests/constants.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/chance.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

TEST(Impact, ABallOnARestingBallBouncesForeverWithItsEnergy) {
  // The impulse passes through the lower ball into the ground and returns in the same step.
  const double r = 0.02;
  for (const double h : {1e-3, 2.5e-4}) {
    for (const double drop : {0.1, 0.1013, 0.17}) {
      ModelDef def;
      const Material material{0, 0, 1};
      scenes::AddGround(def, material);
      scenes::AddBall(def, "lower", 1, r, {0, 0, r}, material);
      scenes::AddBall(def, "upper", 1, r, {0, 0, 3 * r + drop}, material);
      WorldBatch world = MakeBatch(def);
      const double base = kG * 4 * r, fall = kG * drop;
      double low = 1, high = 1, before = 0;
      int bounces = 0;
      for (int n = 0; n < StepsIn(10, h); ++n) {
        world.Step(h);
        const double share = (EnergyOf(world) - base) / fall,
                     v = world.Body(0, 1).velocity_m_per_s.z;
        low = std::min(low, share);
        high = std::max(high, share);
        if (v > 0 && before < 0) ++bounces;
        before = v;
      }
      EXPECT_GE(bounces, 25) << h << " " << drop;
      EXPECT_GE(low, 1 - 1e-3) << h << " " << drop;
      EXPECT_LE(high, 1 + 1e-3) << h << " " << drop;
    }
  }
}

/// Returns the velocities [m/s], after 0.6 s, of Newton's cradle: a ball with 1 m/s against four at
/// rest, `gap` apart.
std::array<double, 5> Cradle(double gap, double h) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  const double r = 0.02;
  const Material material{0, 0, 1};
  scenes::AddBall(def, "first", 1, r, {-0.1, 0, 0}, material);
  for (int i = 0; i < 4; ++i)
    scenes::AddBall(def, "ball", 1, r, {i * (2 * r + gap), 0, 0}, material);
  def.bodies[0].velocity_m_per_s = {1, 0, 0};
  WorldBatch world = MakeBatch(def);
  world.Step(h, StepsIn(0.6, h));
  std::array<double, 5> v{};
  for (std::size_t i = 0; i < 5; ++i) v[i] = world.Body(0, static_cast<int>(i)).velocity_m_per_s.x;
  return v;
}

TEST(Impact, OfACradleWithGapsOnlyTheLastBallLeaves) {
  // Successive impacts, each between two equal balls, which exchange their velocities.
  for (const double gap : {1e-5, 1e-3}) {
    for (const double h : {1e-3, 1e-4}) {
      const std::array<double, 5> v = Cradle(gap, h);
      for (std::size_t i = 0; i < 5; ++i)
        EXPECT_NEAR(v[i], i == 4 ? 1 : 0, 1e-3) << gap << " " << h;
    }
  }
}

TEST(Impact, ACradleThatTouchesFollowsNewtonsLawAndKeepsItsEnergy) {
  // Simultaneous impacts: the first pair parts with the speed of its approach, every other pair
  // stays together. Momentum: v0 + 4 v = 1, and v - v0 = 1.
  for (const double h : {1e-3, 1e-4}) {
    const std::array<double, 5> v = Cradle(0, h);
    double energy = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_NEAR(v[i], i == 0 ? -0.6 : 0.4, 1e-3) << h;
      energy += v[i] * v[i];
    }
    EXPECT_NEAR(energy, 1, 1e-3) << h;
  }
}

/// Lowest and highest energy of twenty balls between six walls, all smooth and elastic, over 20 s,
/// as shares of the initial energy.
struct Shares {
  double low = 1, high = 1;
};
Shares Gas(std::uint64_t seed, double h) {
  const Material material{0, 0, 1};
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  const Vec3 inwards[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const Vec3& normal : inwards) {
    scenes::AddGround(def, material);
    def.planes.back().name = "wall_" + std::to_string(def.planes.size());
    def.planes.back().normal = normal;
    def.planes.back().point_m = -0.3 * normal;
  }
  scenes::Chance chance(seed);
  for (int i = 0; i < 20; ++i) {
    const Vec3 at{-0.2 + 0.1 * (i % 5), -0.15 + 0.1 * (i / 5 % 4), 0.02 * (i % 7) - 0.06};
    scenes::AddBall(def, "ball", 1, 0.04, at, material);
    def.bodies.back().velocity_m_per_s = chance.Jolt(1);
  }
  WorldBatch world = MakeBatch(def);
  const double start = EnergyOf(world);
  Shares shares;
  for (int n = 0; n < StepsIn(20, h); ++n) {
    world.Step(h);
    const double share = EnergyOf(world) / start;
    shares.low = std::min(shares.low, share);
    shares.high = std::max(shares.high, share);
  }
  EXPECT_EQ(world.Status(0).bits, kStatusOk) << h;
  return shares;
}

TEST(Impact, AGasOfTwentyBallsKeepsItsEnergy) {
  for (std::uint64_t seed = 1; seed < 13; ++seed) {
    for (const double h : {1e-3, 2.5e-4}) {
      const Shares shares = Gas(seed, h);
      EXPECT_GE(shares.low, 1 - 1e-3) << seed << " " << h;
      EXPECT_LE(shares.high, 1 + 1e-9) << seed << " " << h;
    }
  }
}

TEST(Impact, AnEndThatTheOthersReboundThrowsDownReboundsInTheSameStep) {
  // A smooth rod descends with 1 m/s at one end and 0.2 m/s at the other. The first end hits;
  // without a rebound the other end would continue with 0.7 m/s, with a rebound with 1.2 m/s, and
  // only then does it close its gap of 0.85 m/s h: it joins in a second round. Both ends then leave
  // at their speeds of arrival.
  const double h = 1e-3, r = 0.003;
  for (const bool moves : {false, true}) {
    ModelDef def;
    def.gravity_m_per_s2 = {0, 0, 0};
    const Material material{0, 0, 1};
    // Half a step before the impact.
    scenes::AddRod(def, "rod", 0.1, r, {-0.2, 0, r + (0.1 + 0.5) * h},
                   {0.2, 0, r + (0.85 + 0.1) * h}, material);
    def.bodies[0].velocity_m_per_s = {0, 0, -0.6};
    def.bodies[0].angular_velocity_rad_per_s = {0, -0.4 / 0.2, 0};
    if (moves) {  // onto two balls of practically infinite mass
      scenes::AddBall(def, "left", 1e9, 0.1, {-0.2, 0, -0.1}, material);
      scenes::AddBall(def, "right", 1e9, 0.1, {0.2, 0, -0.1}, material);
    } else {
      scenes::AddGround(def, material);
    }
    WorldBatch world = MakeBatch(def);
    const double start = EnergyOf(world);
    world.Step(h);
    const BodyState rod = world.Body(0, 0);
    EXPECT_NEAR(rod.velocity_m_per_s.z, 0.6, 0.01) << moves;
    EXPECT_NEAR(rod.angular_velocity_rad_per_s.y, 0.4 / 0.2, 0.05) << moves;
    EXPECT_NEAR(EnergyOf(world) / start, 1, 1e-3) << moves;
  }
}

TEST(Impact, ABallRisesToESquaredTimesItsHeightWhereverInTheStepItLands) {
  // 60 heights, so that impacts fall everywhere within a step. In flight the apex is known exactly:
  // the scheme keeps parabolas. The error is of second order (contact.md, section 3).
  const double r = 0.05, h = 1e-3;
  const struct {
    double e, limit;
  } cases[] = {{1, 1e-12}, {0.9, 3e-6}, {0.8, 6e-6}, {0.5, 3e-5}, {0.2, 2e-4}};
  for (const auto& c : cases) {
    double worst = 0;
    for (int i = 0; i < 60; ++i) {
      scenes::Ball scene;
      scene.radius_m = r;
      scene.drop_m = 0.2 + 0.0137 * i;
      scene.material = {0, 0, c.e};
      WorldBatch world = MakeBatch(scene.Def());
      while (world.Body(0, 0).velocity_m_per_s.z <= 0) {
        world.Step(h);
        ASSERT_LT(world.Time(0), 2);
      }
      world.Step(h);
      const BodyState ball = world.Body(0, 0);
      const double v = ball.velocity_m_per_s.z, rise = ball.position_m.z - r + v * v / (2 * kG);
      worst = std::max(worst, std::fabs(rise / (c.e * c.e * scene.drop_m) - 1));
    }
    EXPECT_LE(worst, c.limit) << c.e;
  }
}

TEST(Impact, ABallThatHasBouncedComesToRest) {
  for (const double h : kThreeStepsS) {
    for (const double e : {0.2, 0.5, 0.8}) {
      for (int i = 0; i < 5; ++i) {
        scenes::Ball scene;
        scene.drop_m = 0.2 + 0.137 * i;
        scene.material = {0, 0, e};
        WorldBatch world = MakeBatch(scene.Def());
        world.Step(h, StepsIn(12, h));
        EXPECT_LE(std::fabs(world.Body(0, 0).velocity_m_per_s.z), 1e-10) << h << " " << e;
        EXPECT_NEAR(world.Body(0, 0).position_m.z, scene.radius_m, 1e-9) << h << " " << e;
      }
    }
  }
}

TEST(Impact, ABallWithFullRestitutionBouncesForAMinuteWithItsEnergy) {
  scenes::Ball scene;
  scene.drop_m = 0.5;
  scene.material = {0, 0, 1};
  WorldBatch world = MakeBatch(scene.Def());
  const double base = scene.mass_kg * kG * scene.radius_m, fall = scene.mass_kg * kG * scene.drop_m;
  for (int n = 0; n < 60000; ++n) {
    world.Step(1e-3);
    ASSERT_NEAR((EnergyOf(world) - base) / fall, 1, 1e-5) << n;
  }
}

}  // namespace
}  // namespace taut::test
