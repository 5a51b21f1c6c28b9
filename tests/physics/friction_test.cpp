/// Exact Coulomb friction: sticking and sliding, equal in all directions (docs/theory/contact.md).

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/constants.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/block_on_slope.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

scenes::Slope SlopeOf(double angle_rad, double static_friction, double kinetic_friction) {
  return {angle_rad, {static_friction, kinetic_friction, 0}};
}
ModelDef Block(double angle_rad, double static_friction, double kinetic_friction) {
  scenes::BlockOnSlope scene{SlopeOf(angle_rad, static_friction, kinetic_friction)};
  scene.material = scene.slope.material;
  return scene.Def();
}
ModelDef Sled(double angle_rad, double static_friction, double kinetic_friction,
              double heading_rad = 0.3) {
  scenes::SledOnSlope scene{SlopeOf(angle_rad, static_friction, kinetic_friction)};
  scene.material = scene.slope.material;
  scene.heading_rad = heading_rad;
  return scene.Def();
}

/// Bodies that slide down slopes: a box on its corners, a sled on its balls.
struct Slider {
  const char* name;
  ModelDef (*def)(double angle_rad, double static_friction, double kinetic_friction);
};
const Slider kSliders[] = {
    {"block", Block},
    {"sled", [](double a, double s, double k) { return Sled(a, s, k); }},
};

TEST(Friction, NothingCreepsBelowTheFrictionAngle) {
  for (const Slider& slider : kSliders) {
    for (const double share : {0.3, 0.9, 0.999}) {
      for (const double h : kThreeStepsS) {
        WorldBatch world = MakeBatch(slider.def(std::atan(share * 0.5), 0.5, 0.5));
        world.Step(h, StepsIn(1, h));
        const Vec3 before = world.NodePosition(0, 0);
        world.Step(h, StepsIn(10, h));
        const double creep = Distance(world.NodePosition(0, 0), before) / 10;
        EXPECT_LT(creep, 1e-9) << slider.name << " at " << share << " of the angle, " << h << " s";
        EXPECT_EQ(world.Status(0).bits, kStatusOk);
      }
    }
  }
}

TEST(Friction, ASliderSlidesDownAtGTimesSineMinusMuCosine) {
  // A constant force, so the scheme has no error: v_n = a n h, starting from rest.
  for (const Slider& slider : kSliders) {
    for (const double mu : {0.0, 0.2, 0.5}) {
      const double angle = 0.6, a = kG * (std::sin(angle) - mu * std::cos(angle));
      const scenes::Slope slope = SlopeOf(angle, mu, mu);
      for (const double h : kThreeStepsS) {
        WorldBatch world = MakeBatch(slider.def(angle, mu, mu));
        const Vec3 start = world.NodePosition(0, 0);
        const int steps = StepsIn(1, h);
        world.Step(h, steps);
        const Vec3 way = world.NodePosition(0, 0) - start;
        EXPECT_LE(Distance(world.NodeVelocity(0, 0), a * slope.downhill()), SolverError(steps))
            << slider.name << ", mu " << mu << ", " << h << " s";
        EXPECT_LE(Distance(way, (a / 2) * slope.downhill()), SolverError(steps));
        EXPECT_LE(Norm(world.Body(0, 0).angular_velocity_rad_per_s), SolverError(steps) / 0.03);
        EXPECT_EQ(world.Status(0).bits, kStatusOk);
      }
    }
  }
}

TEST(Friction, BetweenTheTwoFrictionAnglesASliderStaysUntilItIsPushedAndThenSlidesOn) {
  const double angle = std::atan(0.4), a = kG * (std::sin(angle) - 0.3 * std::cos(angle));
  const scenes::Slope slope = SlopeOf(angle, 0.5, 0.3);
  for (const Slider& slider : kSliders) {
    for (const double h : kThreeStepsS) {
      WorldBatch world = MakeBatch(slider.def(angle, 0.5, 0.3));
      const Vec3 start = world.NodePosition(0, 0);
      world.Step(h, StepsIn(2, h));
      EXPECT_LT(Distance(world.NodePosition(0, 0), start), 2e-9) << slider.name << ", " << h;

      const double push = 0.2;
      BodyState body = world.Body(0, 0);
      body.velocity_m_per_s = push * slope.downhill();
      world.SetBodyState(0, 0, body);
      const int steps = StepsIn(1, h);
      world.Step(h, steps);
      // The first step after the push may still have static friction.
      const double late = 0.2 * kG * std::cos(angle) * h;
      EXPECT_LE(Distance(world.NodeVelocity(0, 0), (push + a) * slope.downhill()),
                late + SolverError(steps))
          << slider.name << ", " << h;
    }
  }
}

TEST(Friction, ASliderAtRestSticksWithItsStaticFrictionWhicheverWayTheGroundTilts) {
  // The slider rests on level ground; then gravity tilts beyond the kinetic but not the static
  // friction angle. The sum of friction does not depend on its distribution over the contacts, on
  // the edges of their cones or inside.
  for (const Slider& slider : kSliders) {
    for (int direction = 0; direction < 8; ++direction) {
      const double a = direction * std::numbers::pi / 4 + 0.1;
      const auto tilt = [&](WorldBatch& world, double slope) {
        world.SetParameter(0, Parameter::kGravityX, 0, slope * kG * std::cos(a));
        world.SetParameter(0, Parameter::kGravityY, 0, slope * kG * std::sin(a));
      };
      WorldBatch world = MakeBatch(slider.def(0, 0.5, 0.3));
      world.Step(1e-3, 100);
      tilt(world, 0.49);
      const Vec3 before = world.NodePosition(0, 0);
      world.Step(1e-3, 1000);
      EXPECT_LT(Distance(world.NodePosition(0, 0), before), 1e-9) << slider.name << direction;
      tilt(world, 0.51);
      world.Step(1e-3, 1000);
      // The slider now slides, with kinetic friction from the second step on.
      EXPECT_NEAR(Norm(world.NodeVelocity(0, 0)), 0.21 * kG, 0.2 * kG * 1e-3 + SolverError(1000))
          << slider.name << direction;
    }
  }
}

/// Returns the displacement of a body that slides on level ground from `v0` until it stops.
Vec3 SlideOut(WorldBatch& world, const Vec3& v0, double h, double time_s) {
  BodyState body = world.Body(0, 0);
  body.velocity_m_per_s = v0;
  world.SetBodyState(0, 0, body);
  const Vec3 start = world.NodePosition(0, 0);
  world.Step(h, StepsIn(time_s, h));
  return world.NodePosition(0, 0) - start;
}

/// Returns the sliding distance of the scheme: sum of h (v + v') / 2 with v' = max(v - mu g h, 0).
double SlidingDistance(double v, double mu, double h) {
  double x = 0;
  while (v > 0) {
    const double after = std::max(v - mu * kG * h, 0.0);
    x += h * (v + after) / 2;
    v = after;
  }
  return x;
}

TEST(Friction, ASliderStopsAfterVSquaredOverTwoMuG) {
  const double v = 1, mu = 0.4;
  for (const Slider& slider : kSliders) {
    for (const double h : kThreeStepsS) {
      WorldBatch world = MakeBatch(slider.def(0, mu, mu));
      const Vec3 way = SlideOut(world, {v, 0, 0}, h, 1);
      const int steps = StepsIn(v / (mu * kG), h) + 1;
      EXPECT_NEAR(way.x, SlidingDistance(v, mu, h), SolverError(steps)) << slider.name << " " << h;
      EXPECT_NEAR(way.x, v * v / (2 * mu * kG), 0.005 * way.x);
      EXPECT_LT(Norm(world.NodeVelocity(0, 0)), 1e-9);
    }
  }
}

TEST(Friction, ASledStopsAfterTheSameDistanceInEveryDirection) {
  // Exact cone, and friction along the contact-free slip: on a sled that does not rotate, all balls
  // slip in the same direction, so that both laws agree.
  const double v = 1, mu = 0.4, h = 1e-3;
  for (const FrictionLaw law : {FrictionLaw::kCone, FrictionLaw::kAlongSlip}) {
    for (int direction = 0; direction < 8; ++direction) {
      const double a = direction * std::numbers::pi / 4 + 0.1;
      ModelDef def = Sled(0, mu, mu);
      def.friction_law = law;
      WorldBatch world = MakeBatch(def);
      const Vec3 way = SlideOut(world, {v * std::cos(a), v * std::sin(a), 0}, h, 0.5);
      const double straight = way.x * std::cos(a) + way.y * std::sin(a);
      const double aside = way.y * std::cos(a) - way.x * std::sin(a);
      const char* const name = law == FrictionLaw::kCone ? "cone" : "along the slip";
      EXPECT_NEAR(straight, SlidingDistance(v, mu, h), SolverError(300)) << name << direction;
      EXPECT_NEAR(aside, 0, SolverError(300)) << name << direction;
    }
  }
}

TEST(Friction, ASlidingSledPushedAsideTurnsItsWayAsTheConeSays) {
  // Friction opposes the velocity for any applied force. For a point with a force f across its
  // path, the scheme gives v' = v_free (1 - mu g h / |v_free|). Separate friction along each axis
  // would give another result.
  const double mu = 0.4, h = 1e-3, push = 2.0;  // [m/s^2]
  WorldBatch world = MakeBatch(Sled(0, mu, mu));
  world.SetParameter(0, Parameter::kGravityY, 0, push);
  BodyState body = world.Body(0, 0);
  body.velocity_m_per_s = {1, 0, 0};
  world.SetBodyState(0, 0, body);
  Vec3 v{1, 0, 0};
  for (int n = 1; n <= 200; ++n) {
    world.Step(h);
    v.y += push * h;
    v = (1 - mu * kG * h / Norm(v)) * v;
    ASSERT_LE(Distance(world.NodeVelocity(0, 0), v), SolverError(n)) << n;
  }
}

/// J^-1 a by Cramer's rule.
Vec3 Solve(const Inertia& j, const Vec3& a) {
  const Vec3 x{j.xx, j.xy, j.xz}, y{j.xy, j.yy, j.yz}, z{j.xz, j.yz, j.zz};
  const double det = Dot(x, Cross(y, z));
  return {Dot(a, Cross(y, z)) / det, Dot(x, Cross(a, z)) / det, Dot(x, Cross(y, a)) / det};
}

TEST(Friction, TheConeHoldsAFootInBothDirectionsAndFrictionAlongSlipInOneOnly) {
  // A rod stands obliquely on rough ground and gravity pulls obliquely. Without contact its foot
  // would gain h g in this step. The cone stops the foot completely. Friction along the slip stops
  // only the two components n and s; the rod's inertia converts these two impulses into motion
  // across, which nothing stops.
  const Vec3 g{1.5, -0.8, -9.81};
  const double h = 1e-3;
  ModelDef def;
  def.gravity_m_per_s2 = g;
  const Material rough{5, 5, 0};
  scenes::AddGround(def, rough);
  scenes::AddRod(def, "rod", 0.1, 0.01, {0, 0, 0.01}, {0.3, 0.1, 0.5}, rough);
  def.nodes.push_back({"foot", 0, {0, 0, 0}});
  const BodyDef& rod = def.bodies[0];
  const Vec3 arm = Vec3{0, 0, 0} - rod.com_m;
  const auto answer = [&](const Vec3& impulse) {  // velocity of the foot
    return (1 / rod.mass_kg) * impulse + Cross(Solve(rod.inertia_kg_m2, Cross(arm, impulse)), arm);
  };
  const Vec3 n{0, 0, 1}, s = (1 / std::hypot(g.x, g.y)) * Vec3{g.x, g.y, 0}, c = Cross(n, s);
  const double wnn = Dot(n, answer(n)), wns = Dot(n, answer(s)), wss = Dot(s, answer(s));
  const double un = h * g.z, us = h * std::hypot(g.x, g.y), det = wnn * wss - wns * wns;
  const Vec3 impulse = ((wns * us - wss * un) / det) * n + ((wns * un - wnn * us) / det) * s;
  const double across = Dot(c, answer(impulse));
  ASSERT_GT(std::fabs(across), 1e-4);

  for (const FrictionLaw law : {FrictionLaw::kCone, FrictionLaw::kAlongSlip}) {
    def.friction_law = law;
    WorldBatch world = MakeBatch(def);
    world.Step(h);
    const Vec3 expected = law == FrictionLaw::kCone ? Vec3{} : across * c;
    // In the second half of the step the rod rotates by h w / 2, and the velocities of its foot
    // rotate with it: v + w x r, each part below h g and below w times 0.3 m.
    const double w = Norm(world.Body(0, 0).angular_velocity_rad_per_s);
    EXPECT_LE(Distance(world.NodeVelocity(0, 2), expected), h * w * 0.3 * w + SolverError(1));
  }
}

TEST(Friction, ASlidingBallRollsInTheEndWithFiveSeventhsOfItsSpeed) {
  // Friction keeps the angular momentum about a line of the ground; a rolling solid ball then has
  // 5/7 of its initial speed, at any step size.
  const double v = 2;
  for (const double mu : {0.1, 0.4}) {
    for (const double h : kThreeStepsS) {
      scenes::Ball scene;
      scene.material = {mu, mu, 0};
      WorldBatch world = MakeBatch(scene.Def());
      BodyState ball = world.Body(0, 0);
      ball.velocity_m_per_s = {v * 0.6, v * 0.8, 0};
      world.SetBodyState(0, 0, ball);
      const int steps = StepsIn(1, h);
      world.Step(h, steps);
      ball = world.Body(0, 0);
      const Vec3 rolling{5.0 / 7 * v * 0.6, 5.0 / 7 * v * 0.8, 0};
      EXPECT_LE(Distance(ball.velocity_m_per_s, rolling), SolverError(steps)) << mu << " " << h;
      EXPECT_LE(Distance(ball.angular_velocity_rad_per_s, {-rolling.y / 0.1, rolling.x / 0.1, 0}),
                SolverError(steps) / 0.1);
      // Sliding for 2 v / (7 mu g), over 12/49 v^2 / (mu g), then rolling.
      const double sliding_s = 2 * v / (7 * mu * kG);
      const double way = 12.0 / 49 * v * v / (mu * kG) + 5.0 / 7 * v * (steps * h - sliding_s);
      // Sliding ends within a step: an error below half of a step's change.
      EXPECT_NEAR(std::hypot(ball.position_m.x, ball.position_m.y), way,
                  h * mu * kG * h + SolverError(steps));
    }
  }
}

TEST(Friction, FrictionScaleIsAFactorOnEveryCoefficient) {
  WorldBatch world = MakeBatch(Sled(0, 0.4, 0.4));
  world.SetParameter(0, Parameter::kFrictionScale, 0, 0.5);
  const Vec3 way = SlideOut(world, {1, 0, 0}, 1e-3, 1);
  EXPECT_NEAR(way.x, SlidingDistance(1, 0.2, 1e-3), SolverError(510));
}

TEST(Friction, CoefficientsOfTwoMaterialsCombineAsTheModelSays) {
  const struct {
    CombineRule rule;
    double mu;
  } cases[] = {{CombineRule::kProduct, 0.8 * 0.2},
               {CombineRule::kGeometricMean, 0.4},
               {CombineRule::kMinimum, 0.2},
               {CombineRule::kMaximum, 0.8}};
  for (const auto& c : cases) {
    scenes::SledOnSlope scene{SlopeOf(0, 0.8, 0.8)};
    scene.material = {0.2, 0.2, 0};
    ModelDef def = scene.Def();
    def.friction_combine = c.rule;
    WorldBatch world = MakeBatch(def);
    const Vec3 way = SlideOut(world, {1, 0, 0}, 1e-3, 1);
    EXPECT_NEAR(way.x, SlidingDistance(1, c.mu, 1e-3), SolverError(640)) << c.mu;
  }
}

}  // namespace
}  // namespace taut::test
