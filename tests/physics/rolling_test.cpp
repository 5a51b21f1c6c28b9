/// Rolling, the transition from sliding to rolling, and spinning on the spot, against closed forms.

#include <gtest/gtest.h>

#include "tests/constants.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/block_on_slope.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

/// A round body of radius 0.1 m at rest on a slope that rolls towards +x. `share` is its moment of
/// inertia about the axis of rolling over m r^2.
struct Roller {
  const char* name;
  double share;
  bool rod;

  ModelDef Def(double angle_rad, double mu) const {
    const scenes::Slope slope{angle_rad, {mu, mu, 0}};
    ModelDef def;
    slope.AddTo(def);
    const Vec3 center = 0.1 * slope.normal();
    if (rod) {
      scenes::AddRod(def, "rod", 0.3, 0.1, center - Vec3{0, 0.25, 0}, center + Vec3{0, 0.25, 0},
                     slope.material);
    } else {
      scenes::AddBall(def, "ball", 0.3, 0.1, center, slope.material);
    }
    return def;
  }
};
constexpr Roller kRollers[] = {{"ball", 0.4, false}, {"rod", 0.5, true}};

TEST(Rolling, DownASlopeTheAccelerationIsGSineOverOnePlusTheInertiasShare) {
  const double angle = 0.3;
  const scenes::Slope slope{angle, {}};
  for (const Roller& roller : kRollers) {
    const double a = kG * std::sin(angle) / (1 + roller.share);
    for (const double h : kThreeStepsS) {
      WorldBatch world = MakeBatch(roller.Def(angle, 0.5));
      const Vec3 start = world.Body(0, 0).position_m;
      const int steps = StepsIn(1, h);
      world.Step(h, steps);
      const BodyState end = world.Body(0, 0);
      EXPECT_LE(Distance(end.velocity_m_per_s, a * slope.downhill()), SolverError(steps))
          << roller.name << h;
      EXPECT_LE(Distance(end.position_m - start, (a / 2) * slope.downhill()), SolverError(steps))
          << roller.name << h;
      EXPECT_LE(Distance(end.angular_velocity_rad_per_s, {0, a / 0.1, 0}), SolverError(steps) / 0.1)
          << roller.name << h;
      EXPECT_EQ(world.Status(0).bits, kStatusOk);
    }
  }
}

TEST(Rolling, DownASlopeTooSteepItSlidesAndFrictionTurnsIt) {
  // The body slips where tan(angle) > mu (1 + share) / share. Then friction has its kinetic value.
  const double angle = 0.9, mu = 0.2;
  const scenes::Slope slope{angle, {}};
  for (const Roller& roller : kRollers) {
    ASSERT_GT(std::tan(angle), mu * (1 + roller.share) / roller.share);
    const double a = kG * (std::sin(angle) - mu * std::cos(angle));
    const double alpha = mu * kG * std::cos(angle) / (roller.share * 0.1);
    for (const double h : kThreeStepsS) {
      WorldBatch world = MakeBatch(roller.Def(angle, mu));
      const int steps = StepsIn(1, h);
      world.Step(h, steps);
      const BodyState end = world.Body(0, 0);
      EXPECT_LE(Distance(end.velocity_m_per_s, a * slope.downhill()), SolverError(steps))
          << roller.name << h;
      EXPECT_LE(Distance(end.angular_velocity_rad_per_s, {0, alpha, 0}), SolverError(steps) / 0.1)
          << roller.name << h;
    }
  }
}

TEST(Rolling, ASlidingRodRollsInTheEndWithTwoThirdsOfItsSpeed) {
  // Like the ball with its 5/7 (friction_test.cpp): angular momentum about a line of the ground is
  // kept. The rod slides for v / (3 mu g), over 5/18 v^2 / (mu g).
  const double v = 2;
  for (const double mu : {0.1, 0.4}) {
    for (const double h : kThreeStepsS) {
      WorldBatch world = MakeBatch(kRollers[1].Def(0, mu));
      BodyState rod = world.Body(0, 0);
      rod.velocity_m_per_s = {v, 0, 0};
      world.SetBodyState(0, 0, rod);
      const int steps = StepsIn(1, h);
      world.Step(h, steps);
      rod = world.Body(0, 0);
      EXPECT_LE(Distance(rod.velocity_m_per_s, {2.0 / 3 * v, 0, 0}), SolverError(steps)) << mu << h;
      EXPECT_LE(Distance(rod.angular_velocity_rad_per_s, {0, 2.0 / 3 * v / 0.1, 0}),
                SolverError(steps) / 0.1);
      const double way = 5.0 / 18 * v * v / (mu * kG) + 2.0 / 3 * v * (1 - v / (3 * mu * kG));
      // Sliding ends within a step: an error below half of a step's change.
      EXPECT_NEAR(rod.position_m.x, way, h * mu * kG * h + SolverError(steps)) << mu << h;
    }
  }
}

TEST(Rolling, OnLevelGroundItLosesNothing) {
  for (const Roller& roller : kRollers) {
    WorldBatch world = MakeBatch(roller.Def(0, 0.5));
    BodyState body = world.Body(0, 0);
    body.velocity_m_per_s = {1.5, 0, 0};
    body.angular_velocity_rad_per_s = {0, 15, 0};
    world.SetBodyState(0, 0, body);
    world.Step(1e-3, 60000);
    // Below the solver's tolerance nothing is corrected: no slip, and no loss that accumulates.
    EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.x, 1.5, SolverError(1)) << roller.name;
    EXPECT_NEAR(world.Body(0, 0).position_m.x, 90, 60 * SolverError(1) + RoundOff(60000, 90))
        << roller.name;
  }
}

TEST(Rolling, ARodSpinningOnTheGroundStopsAsItsTwoEndsSay) {
  // A rod touches with its two ends, at a distance a from the center, each with half the weight: w'
  // = -mu m g a / J. It stops after the time w0 / |w'|, rotated by w0^2 / (2 |w'|). Friction
  // distributed evenly along the rod would have half that moment. Rods are straight and stiff here,
  // and such a body touches rough ground somewhere near its ends.
  const double w0 = 8, a = 0.25, mu = 0.3;
  for (const double h : kThreeStepsS) {
    ModelDef def;
    const Material material{mu, mu, 0};
    scenes::AddGround(def, material);
    scenes::AddRod(def, "rod", 0.2, 0.01, {-a, 0, 0.01}, {a, 0, 0.01}, material);
    def.bodies[0].angular_velocity_rad_per_s = {0, 0, w0};
    const double slowing = mu * 0.2 * kG * a / def.bodies[0].inertia_kg_m2.zz;
    WorldBatch world = MakeBatch(def);
    const double stops_s = w0 / slowing;
    double turned = 0;
    for (int n = 1; n <= StepsIn(0.4, h); ++n) {
      const double before = world.Body(0, 0).angular_velocity_rad_per_s.z;
      world.Step(h);
      const double w = world.Body(0, 0).angular_velocity_rad_per_s.z;
      turned += h * (before + w) / 2;
      if (n * h < stops_s) {
        ASSERT_NEAR(w, w0 - slowing * n * h, SolverError(n) / a) << h << ", step " << n;
      } else if ((n - 1) * h > stops_s) {
        ASSERT_NEAR(w, 0, SolverError(1) / a) << h << ", step " << n;
      }
    }
    ASSERT_LT(stops_s, 0.3);
    EXPECT_NEAR(turned, w0 * w0 / (2 * slowing), 0.005 * turned) << h;
    // It has rotated on the spot.
    EXPECT_LE(Distance(world.Body(0, 0).position_m, {0, 0, 0.01}), SolverError(StepsIn(0.4, h)));
    const Quat q = world.Body(0, 0).orientation;
    EXPECT_NEAR(2 * std::atan2(q.z, q.w), turned, 1e-3) << h;
  }
}

TEST(Rolling, ABallSpinningOnItsPoleGoesOn) {
  // A contact is a point without a lever arm: friction exerts no torque about the normal.
  WorldBatch world = MakeBatch(kRollers[0].Def(0, 0.5));
  BodyState ball = world.Body(0, 0);
  ball.angular_velocity_rad_per_s = {0, 0, 30};
  world.SetBodyState(0, 0, ball);
  world.Step(1e-3, 10000);
  EXPECT_LE(Distance(world.Body(0, 0).angular_velocity_rad_per_s, {0, 0, 30}), RoundOff(10000, 30));
}

}  // namespace
}  // namespace taut::test
