/// Bodies without contacts or cables: free flight and rotation (docs/theory/integrator.md).

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

TEST(FreeMotion, FlightIsTheExactParabolaAtEveryStep) {
  // Half a drift, kick, half a drift: x' = x + h (v + v') / 2 with v' = v + h g, so that x_n = x_0
  // + v_0 (nh) + g (nh)^2 / 2 without an error of the scheme.
  const Vec3 g{0.1, -0.2, -9.81}, v0{3, -1, 5}, x0{0.5, -0.25, 10};
  for (const double h : kThreeStepsS) {
    ModelDef def;
    def.gravity_m_per_s2 = g;
    scenes::AddBall(def, "ball", 0.3, 0.1, x0, {});
    def.bodies[0].velocity_m_per_s = v0;
    WorldBatch world = MakeBatch(def);
    for (int n = 1; n <= StepsIn(2, h); ++n) {
      world.Step(h);
      const double t = n * h;
      const BodyState ball = world.Body(0, 0);
      // No position is above 16 m, no path longer than 30 m.
      ASSERT_LE(Distance(ball.position_m, x0 + t * v0 + (t * t / 2) * g), RoundOff(n, 30)) << h;
      ASSERT_LE(Distance(ball.velocity_m_per_s, v0 + t * g), RoundOff(n, 20)) << h;
    }
    EXPECT_NEAR(world.Time(0), 2, RoundOff(StepsIn(2, h), 2));
  }
}

TEST(FreeMotion, AForceOnABallGivesItsMomentum) {
  // The momentum is F t for any mass; the velocity follows from the mass.
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  scenes::AddBall(def, "ball", 0.3, 0.1, {0, 0, 0}, {});
  WorldBatch world = MakeBatch(def);
  const Vec3 f{0.3, -0.6, 1.2};
  world.SetNodeForce(0, 0, f);
  world.Step(1e-3, 500);
  EXPECT_LE(Distance(world.Momentum(0), 0.5 * f), RoundOff(500, 1));
  EXPECT_LE(Distance(world.Body(0, 0).velocity_m_per_s, {0.5, -1, 2}), RoundOff(500, 3));
  world.SetNodeForce(0, 0, {});
  world.Step(1e-3, 500);
  EXPECT_LE(Distance(world.Momentum(0), 0.5 * f), RoundOff(1000, 1));
}

/// Returns the second-order term E2 of the energy that the rotation scheme conserves. The scheme
/// orders the axes such that the moments of x and y are nearest to each other, and rotates a free
/// body about y, z and y in turn, and about L: the exact flows of Y = (1/Iy - 1/Ix) ly^2 / 2, of Z,
/// and of L^2 / 2Ix, which commutes with all. It keeps not the energy but the energy + h^2 E2 +
/// O(h^4), with (from the symmetric Baker-Campbell-Hausdorff series; {.,.} Poisson brackets; up to
/// sign)
///   E2 = {Y,{Y,Z}} / 24 + {Z,{Y,Z}} / 12
/// and {lx, ly} = lz and so on. So the energy changes by h^2 (max E2 - min E2) along an orbit and
/// never drifts; if Ix = Iy, then Y = 0, and it is constant.
double SecondOrderEnergy(Vec3 l, Vec3 moments) {
  const auto unlike = [](double a, double b) { return std::fabs(a - b) / (a + b); };
  const double xy = unlike(moments.x, moments.y), yz = unlike(moments.y, moments.z),
               zx = unlike(moments.z, moments.x);
  if (yz < std::min(xy, zx)) {
    l = {l.y, l.z, l.x}, moments = {moments.y, moments.z, moments.x};
  } else if (zx < std::min(xy, yz)) {
    l = {l.z, l.x, l.y}, moments = {moments.z, moments.x, moments.y};
  }
  const double x = l.x * l.x, y = l.y * l.y, z = l.z * l.z;
  const double ky = 1 / moments.y - 1 / moments.x, kz = 1 / moments.z - 1 / moments.x;
  return ky * kz * (ky * y * (x - z) / 24 + kz * z * (y - x) / 12);
}

/// Runs a free body for 60 s at 1 kHz; the angular momentum must not change by a single bit, and
/// the energy must stay within the bounds of the scheme's series.
void TumblesForAMinute(const Vec3& moments, const Vec3& w) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  BodyDef body;
  body.name = "tumbler";
  body.mass_kg = 1;
  body.inertia_kg_m2 = {moments.x, moments.y, moments.z, 0, 0, 0};
  body.angular_velocity_rad_per_s = w;
  def.bodies.push_back(body);
  WorldBatch world = MakeBatch(def);
  const double h = 1e-3;
  const Vec3 l0 = world.AngularMomentum(0);
  const double e0 = world.TotalEnergy(0).kinetic_j;
  double low = 0, high = 0, low2 = SecondOrderEnergy(l0, moments), high2 = low2;
  for (int n = 0; n < 60000; ++n) {
    world.Step(h);
    const Vec3 l = world.AngularMomentum(0);
    ASSERT_EQ(l.x, l0.x);
    ASSERT_EQ(l.y, l0.y);
    ASSERT_EQ(l.z, l0.z);
    const double e = world.TotalEnergy(0).kinetic_j - e0;
    low = std::min(low, e);
    high = std::max(high, e);
    const double e2 =
        SecondOrderEnergy(Rotate(Conjugate(world.Body(0, 0).orientation), l), moments);
    low2 = std::min(low2, e2);
    high2 = std::max(high2, e2);
  }
  // The next term of the series is smaller by (h w)^2, times coefficients below one.
  const double next = h * h * Dot(w, w);
  const double expected = h * h * (high2 - low2), rounding = RoundOff(60000, e0);
  EXPECT_LE(high - low, expected * (1 + next) + rounding);
  EXPECT_GE(high - low, expected * (1 - next) - rounding);
}

TEST(FreeMotion, ATumblingBodyKeepsItsMomentumAndEnergy) {
  TumblesForAMinute({0.001, 0.002, 0.0025}, {7, -5, 11});
}

TEST(FreeMotion, ABodyThatFlipsAboutItsMiddleAxisKeepsItsMomentumAndEnergy) {
  TumblesForAMinute({0.001, 0.002, 0.0025}, {0.02, 20, 0.01});
}

TEST(FreeMotion, AThinRodSpinningFastAboutItselfKeepsItsMomentumAndEnergy) {
  // A rod of 0.38 m length and 6 mm thickness along each axis in turn: the scheme selects its axes
  // by the moments of inertia.
  const double across = 2.4e-4, own = 9e-8;
  TumblesForAMinute({own, across, across}, {200, 1.5, 0.5});
  TumblesForAMinute({across, own, across}, {1.5, 200, 0.5});
  TumblesForAMinute({across, across, own}, {1.5, 0.5, 200});
}

TEST(FreeMotion, ABodyFlipsAboutItsMiddleAxisAtTheTimeOfEulersSolution) {
  // Euler's top with 2 E I2 < L^2 in closed form (Landau and Lifshitz, Mechanics, section 37):
  // the middle component crosses zero every half period T / 2 = 2 K(k) / rate.
  const double i1 = 0.001, i2 = 0.002, i3 = 0.0025;
  const Vec3 w{0.3, 12, 0.5};
  const double e2 = i1 * w.x * w.x + i2 * w.y * w.y + i3 * w.z * w.z;  // 2 E
  const double l2 = i1 * i1 * w.x * w.x + i2 * i2 * w.y * w.y + i3 * i3 * w.z * w.z;
  ASSERT_GT(l2, e2 * i2);  // the formulas below are for this case
  const double rate = std::sqrt((i3 - i2) * (l2 - e2 * i1) / (i1 * i2 * i3));
  const double k = std::sqrt((i2 - i1) * (e2 * i3 - l2) / ((i3 - i2) * (l2 - e2 * i1)));
  const double half_period = 2 * std::comp_ellint_1(k) / rate;
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  BodyDef body;
  body.name = "tumbler";
  body.mass_kg = 1;
  body.inertia_kg_m2 = {i1, i2, i3, 0, 0, 0};
  body.angular_velocity_rad_per_s = w;
  def.bodies.push_back(body);
  std::array<double, 2> errors{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double h = i == 0 ? 1e-3 : 5e-4;
    WorldBatch world = MakeBatch(def);
    double before = w.y, first = 0, last = 0;
    int crossings = 0;
    for (int n = 1; crossings < 9; ++n) {
      ASSERT_LT(n * h, 20);
      world.Step(h);
      const BodyState state = world.Body(0, 0);
      const double y = Rotate(Conjugate(state.orientation), state.angular_velocity_rad_per_s).y;
      if ((y < 0) != (before < 0)) {
        last = h * (n - 1 + before / (before - y));
        if (++crossings == 1) first = last;
      }
      before = y;
    }
    errors[i] = (last - first) / 8 / half_period - 1;
  }
  // Second order in h w = 0.012: of the order of 1e-4 at most, and a quarter with half the step.
  EXPECT_LT(std::fabs(errors[0]), 1.44e-4);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.1);
}

TEST(FreeMotion, ASpinAboutAPrincipalAxisTurnsByItsSpeedTimesTime) {
  // tan(a / 2) of a rotation by a is approximated by y (1 + y^2 / 3), y = a / 2: the angle is short
  // by at most 2 times 2 y^5 / 15. A step has two rotations by h w / 2.
  const double w = 200, h = 1e-3;
  scenes::FreeRod rod;
  rod.angular_velocity_rad_per_s = {w, 0, 0};
  ModelDef def = rod.Def();
  def.nodes.push_back({"rim", 0, {0, 0, 0.003}});
  WorldBatch world = MakeBatch(def);
  const double y = h * w / 4, short_by = 2 * 2 * (2.0 / 15) * y * y * y * y * y;
  for (int n = 1; n <= 10000; ++n) {
    world.Step(h);
    const Vec3 p = world.NodePosition(0, 2);
    const double c = std::cos(w * h * n), s = std::sin(w * h * n);
    // Across the radius: the lag angle. Along the radius: the point stays on the rim.
    const double lag = (p.y * c + p.z * s) / 0.003;
    ASSERT_LE(std::fabs(lag), n * short_by + RoundOff(n, 1)) << n;
    ASSERT_NEAR(Norm(p), 0.003, RoundOff(n, 0.003));
  }
}

TEST(FreeMotion, ASlantedRodPrecessesAboutItsMomentumAtTheClosedFormsRate) {
  // An axisymmetric body: its axis precesses about L at |L| / I_across. The rod is oblique in W, so
  // its principal axes are, too. The only error is in the angles of the rotations.
  const Vec3 axis{2.0 / 7, 3.0 / 7, 6.0 / 7};
  const Vec3 spin = 40.0 * axis + Vec3{3, -2, 0};  // the second part is across the axis
  scenes::FreeRod rod;
  rod.from_m = -0.19 * axis;
  rod.to_m = 0.19 * axis;
  rod.radius_m = 0.02;  // thick, so that the spin affects the direction of L
  rod.angular_velocity_rad_per_s = spin;
  const double across = rod.mass_kg * (0.38 * 0.38 / 12 + rod.radius_m * rod.radius_m / 4);
  const double own = rod.mass_kg * rod.radius_m * rod.radius_m / 2;
  const Vec3 l = own * 40.0 * axis + across * (spin - 40.0 * axis);
  const double t = 2, angle = Norm(l) / across * t;
  const Vec3 n = (1 / Norm(l)) * l;
  const Vec3 expected = std::cos(angle) * axis + std::sin(angle) * Cross(n, axis) +
                        ((1 - std::cos(angle)) * Dot(n, axis)) * n;
  std::array<double, 2> errors{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double h = i == 0 ? 1e-3 : 5e-4;
    WorldBatch world = MakeBatch(rod.Def());
    EXPECT_LE(Distance(world.AngularMomentum(0), l), RoundOff(1, Norm(l)));
    EXPECT_LE(Distance(world.Body(0, 0).angular_velocity_rad_per_s, spin),
              RoundOff(1, 40 * across / own));
    world.Step(h, StepsIn(t, h));
    const Vec3 now = (1 / 0.38) * (world.NodePosition(0, 1) - world.NodePosition(0, 0));
    errors[i] = Distance(now, expected);
  }
  // A body with an axis of symmetry rotates about its momentum and that axis; these rotations
  // commute, so only the tangents of the half angles err, by angle (h w)^4 / 80 or so.
  EXPECT_LT(errors[0], angle * 1e-12 * Dot(spin, spin) * Dot(spin, spin));
  EXPECT_NEAR(errors[0] / errors[1], 16, 0.5);
}

}  // namespace
}  // namespace taut::test
