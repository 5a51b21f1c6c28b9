/// Capstan friction of cables at eyelets and wheels (docs/theory/cables.md, section 5).

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <vector>

#include "math/described_path.h"
#include "sim/constraint/cable_chain.h"
#include "tests/constants.h"
#include "tests/physics/lanes_alike.h"

namespace taut::test {
namespace {

BodyDef CapstanBall(double mass_kg, const Vec3& p, double inertia = 1e-4) {
  BodyDef body;
  body.mass_kg = mass_kg;
  body.com_m = p;
  body.inertia_kg_m2 = {inertia, inertia, inertia, 0, 0, 0};
  return body;
}

AttachmentDef CapstanRound(int body, const Vec3& center, double radius_m, double friction,
                           bool counterclockwise = true, int turns = 0) {
  return {body, center, friction, WheelDef{{0, 1, 0}, radius_m, counterclockwise, turns}};
}

/// Adds a cable with the same `tension` [N] along its whole length at the start.
void AddCable(ModelDef& def, std::vector<AttachmentDef> attachments, double stiffness,
              double tension) {
  CableDef cable;
  cable.name = "cable";
  cable.attachments = std::move(attachments);
  cable.stiffness_n_per_m = stiffness;
  cable.rest_length_m = math::DescribedPath(cable).length_m() - tension / stiffness;
  def.cables.push_back(cable);
}

/// Returns two masses on a cable over fixed wheels on a semicircle (Atwood's machine).
ModelDef CapstanAtwood(double m1, double m2, double friction, int wheels = 1,
                       double stiffness = 1e5) {
  const double arch = 0.1, radius = wheels == 1 ? arch : 0.005;
  const double x = arch + (wheels == 1 ? 0 : radius);
  std::vector<AttachmentDef> path{{0, {-x, 0, -1}}};
  for (int k = 0; k < wheels; ++k) {
    const double angle = wheels == 1 ? 0 : std::numbers::pi * k / (wheels - 1);
    const double out = wheels == 1 ? 0 : arch;
    path.push_back(
        CapstanRound(kWorld, {-out * std::cos(angle), 0, out * std::sin(angle)}, radius, friction));
  }
  path.push_back({1, {x, 0, -1}});
  ModelDef def;
  def.bodies = {CapstanBall(m1, path.front().position_m), CapstanBall(m2, path.back().position_m)};
  AddCable(def, path, stiffness, m2 * kG);
  return def;
}

TEST(Capstan, AtwoodsMachineSlipsAsEytelweinSays) {
  const double c = std::exp(0.2 * std::numbers::pi);
  for (const double m2 : {0.4, 0.5, 0.53}) {
    ModelDef def = CapstanAtwood(1, m2, 0.2);
    def.cables[0].damping_n_s_per_m = 20;
    WorldBatch world = MakeBatch(def);
    const double a = (1 - c * m2) / (1 + c * m2) * kG;
    EXPECT_NEAR(-AccelerationOf(world, 0, 0.6), a, 1e-3) << m2;
    EXPECT_NEAR(world.CableSpan(0, 0, 0).tension_n / world.CableSpan(0, 0, 1).tension_n, c, 1e-9);
  }
}

TEST(Capstan, WithinTheRatioItDoesNotCreep) {
  for (const double m2 : {0.54, 0.7, 0.9}) {
    ModelDef def = CapstanAtwood(1, m2, 0.2);
    def.cables[0].damping_n_s_per_m = 200;
    WorldBatch world = MakeBatch(def);
    world.Step(1e-3, 4000);
    const double z = world.Body(0, 0).position_m.z;
    world.Step(1e-3, 4000);
    EXPECT_NEAR(world.Body(0, 0).position_m.z, z, 1e-9 * 4) << m2;
    EXPECT_LT(std::fabs(world.Body(0, 0).velocity_m_per_s.z), 1e-9) << m2;
    EXPECT_NEAR(world.CableSpan(0, 0, 0).tension_n, kG, 1e-7);
    EXPECT_NEAR(world.CableSpan(0, 0, 1).tension_n, m2 * kG, 1e-7);
  }
}

TEST(Capstan, WhatFrictionTakesIsWhatIsMissing) {
  ModelDef def = CapstanAtwood(1, 0.4, 0.2);
  WorldBatch world = MakeBatch(def);
  const double before = EnergyOf(world);
  world.Step(1e-3, 900);
  const double loss = world.CableFrictionLoss(0, 0);
  EXPECT_GT(loss, 1.0);
  EXPECT_NEAR(EnergyOf(world) + loss, before, 1e-3 * loss);
}

TEST(Capstan, OverManyRodsTheRatioIsThatOfTheWholeAngle) {
  for (const int wheels : {1, 2, 3, 5, 9}) {
    ModelDef def = CapstanAtwood(1, 0.4, 0.2, wheels);
    def.cables[0].damping_n_s_per_m = 20;
    WorldBatch world = MakeBatch(def);
    world.Step(1e-3, 500);
    const double first = world.CableSpan(0, 0, 0).tension_n;
    const double last = world.CableSpan(0, 0, world.CableSpans(0) - 1).tension_n;
    EXPECT_NEAR(first / last, std::exp(0.2 * std::numbers::pi), 1e-8) << wheels;
  }
}

TEST(Capstan, AFreePulleyTurnsWithTheCable) {
  const double radius = 0.05, inertia = 0.002;
  ModelDef def;
  std::vector<AttachmentDef> path{
      {0, {-radius, 0, -1}}, CapstanRound(2, {}, radius, 1.0), {1, {radius, 0, -1}}};
  def.bodies = {CapstanBall(1, path.front().position_m), CapstanBall(0.7, path.back().position_m),
                CapstanBall(1, {}, inertia)};
  AddCable(def, path, 1e5, 0.8 * kG);
  def.cables[0].damping_n_s_per_m = 20;
  JointDef axle;
  axle.name = "axle";
  axle.kind = JointKind::kHinge;
  axle.body_a = kWorld;
  axle.body_b = 2;
  axle.axis = {0, 1, 0};
  def.joints.push_back(axle);
  WorldBatch world = MakeBatch(def);
  const double a = (1 - 0.7) * kG / (1 + 0.7 + inertia / (radius * radius));
  EXPECT_NEAR(-AccelerationOf(world, 0, 1.0), 1.1772, 1e-3);
  EXPECT_NEAR(a, 1.1772, 1e-4);
  EXPECT_NEAR(world.Body(0, 2).angular_velocity_rad_per_s.y * radius,
              world.Body(0, 0).velocity_m_per_s.z, 1e-3);
}

TEST(Capstan, OverThreeQuartersOfATurn) {
  // The cable slips over the wheel: the ratio of its two tensions is at the slip limit.
  ModelDef def;
  const Vec3 p{-0.5, 0, -0.1}, q{-0.1, 0, -0.4};
  def.bodies = {CapstanBall(1, q)};
  AddCable(def, {{kWorld, p}, CapstanRound(kWorld, {}, 0.1, 0.3, false, 1), {0, q}}, 1e4, 1.0);
  EXPECT_NEAR(math::DescribedPath(def.cables[0]).length_m(), 1.371238898, 5e-10);
  def.cables[0].actuator.kind = ActuatorDef::Kind::kIdeal;
  def.cables[0].damping_n_s_per_m = 100;
  WorldBatch world = MakeBatch(def);
  // Wind out at the first end until friction alone holds the ball, while the cable slides.
  world.Step(1e-3, 2000);
  const double rest = world.Cable(0, 0).rest_length_m;
  for (int i = 0; i < 200; ++i) {
    world.SetRestLengthTarget(0, 0, rest + 1e-4 * i);
    world.Step(1e-3);
  }
  EXPECT_NEAR(world.CableSpan(0, 0, 1).tension_n / world.CableSpan(0, 0, 0).tension_n,
              std::exp(0.3 * 1.5 * std::numbers::pi), 1e-6);
  EXPECT_NEAR(std::exp(0.3 * 1.5 * std::numbers::pi), 4.111207, 5e-7);
}

/// Random chains of spans: at each place the cable sticks within the tension ratio, or slips at it
/// in the right direction; the reversed chain has the same solution.
TEST(Capstan, AllPlacesTogetherAreWithinTheirRatios) {
  struct Tag {};
  std::mt19937_64 bits(1);
  const auto uniform = [&] { return std::uniform_real_distribution<>(0, 1)(bits); };
  for (const int n : {2, 3, 6, 12, 16}) {
    for (int trial = 0; trial < 2000; ++trial) {
      sim::Capstan<Tag> chain, back;
      chain.count = back.count = n;
      for (int i = 0; i < n; ++i) {
        const double l = 0.05 + uniform();
        const double rest = l / (1 + 0.02 * (uniform() - (trial % 2 ? 0.2 : 0.6)));
        const double damps = trial % 3 == 0 ? uniform() : 0, k = 1e4 / rest;
        const double late = damps * 1e-3 * (uniform() - 0.5);
        chain.spans[i] = {l - rest + late, l - rest, 1 / (k * (1 + damps)),
                          1 / (k * (1 + 2 * damps))};
        const double bends = uniform();
        chain.ratio[i] = uniform() < 0.1 ? 1.0 : std::exp(2 * bends * uniform());
      }
      for (int i = 0; i < n; ++i) {
        back.spans[i] = chain.spans[n - 1 - i];
        if (i + 1 < n) back.ratio[i] = chain.ratio[n - 2 - i];
      }
      chain.Solve();
      back.Solve();
      double top = 1e-9;
      for (int i = 0; i < n; ++i) top = std::max(top, chain.tension[i]);
      const double small = 1e-9 * top;
      for (int i = 0; i < n; ++i) {
        const double gets = (i > 0 ? chain.slip[i - 1] : 0) - (i + 1 < n ? chain.slip[i] : 0);
        const sim::CapstanSpan& s = chain.spans[i];
        const double law = std::max(0.0, std::min((s.a - gets) / s.p, (s.e - gets) / s.q));
        ASSERT_NEAR(chain.tension[i], law, small);
        ASSERT_NEAR(chain.tension[i], back.tension[n - 1 - i], small);
        if (i + 1 == n) continue;
        const double c = chain.ratio[i], T = chain.tension[i], next = chain.tension[i + 1];
        ASSERT_LE(next, c * T + small);
        ASSERT_LE(T, c * next + small);
        if (c > 1 && chain.slip[i] > 1e-12) {
          ASSERT_NEAR(next, c * T, small);
        }
        if (c > 1 && chain.slip[i] < -1e-12) {
          ASSERT_NEAR(T, c * next, small);
        }
      }
    }
  }
}

/// The derivatives that Newton's method uses, also where the cable slips and where a damper is at
/// its bound.
TEST(Capstan, ItsDerivativesAreThoseOfTheImpulses) {
  struct Tag {};
  using Num = simd::Wide<1, Tag>;
  std::mt19937_64 bits(2);
  const auto uniform = [&] { return std::uniform_real_distribution<>(0, 1)(bits); };
  int slipping = 0;
  for (int trial = 0; trial < 200; ++trial) {
    sim::ChainSpan<Num> spans[4];
    for (sim::ChainSpan<Num>& s : spans) {
      const double k = 1000 + 3000 * uniform();
      s.stretch = Num::Splat(0.01 * uniform());
      s.rate = Num::Splat(uniform() - 0.5);
      s.stiffness = s.slip_stiffness = Num::Splat(k);
      s.damping = Num::Splat(trial % 2 ? 0.0 : 5 * uniform());
      s.ratio = Num::Splat(1 + uniform());
    }
    sim::CableChain<Num> chain;
    chain.rows = 4, chain.h = Num::Splat(1e-3), chain.spans = spans;
    chain.link_count = 0, chain.links = nullptr;
    Num u[4], l[4], low[4], high[4], g[16];
    for (Num& x : u) x = Num::Splat(uniform() - 0.5);
    const auto branch = chain.Project(u, u, Num::Splat(1.0), l);
    chain.Derivative(branch, Num::Splat(1.0), g);
    for (int k = 0; k < 4; ++k) {
      const double d = 1e-6;
      const Num at = u[k];
      u[k] = Num::Splat(at[0] - d);
      const auto below = chain.Project(u, u, Num::Splat(1.0), low);
      u[k] = Num::Splat(at[0] + d);
      const auto above = chain.Project(u, u, Num::Splat(1.0), high);
      u[k] = at;
      if (!chain.Same(branch, below) || !chain.Same(branch, above)) continue;
      for (int i = 0; i < 4; ++i) {
        const double slope = (high[i][0] - low[i][0]) / (2 * d);
        ASSERT_NEAR(g[4 * i + k][0], -slope, 1e-7 * (1 + std::fabs(slope))) << trial;
        slipping += i != k && g[4 * i + k][0] > 0;
      }
    }
  }
  EXPECT_GT(slipping, 500);
}

TEST(Capstan, MomentaAreKeptAndEnergyOnlyFalls) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  def.bodies = {CapstanBall(0.4, {0, 0, -1}, 0.01), CapstanBall(0.5, {0.3, 0.1, 1}, 0.01),
                CapstanBall(0.6, {-0.2, 0, 0}, 0.02), CapstanBall(0.3, {0.5, 0, 0}, 0.02)};
  AddCable(def,
           {{0, {0, 0, -1}},
            CapstanRound(2, {-0.2, 0, -0.1}, 0.05, 0.3),
            {3, {0.5, 0.1, 0}, 0.4},
            {1, {0.3, 0.1, 1}}},
           2000, 5);
  for (int b = 0; b < 4; ++b)
    def.bodies[static_cast<std::size_t>(b)].velocity_m_per_s = {0.3 * b, 0.2 - 0.1 * b,
                                                                0.5 * (b % 2)};
  WorldBatch world = MakeBatch(def);
  const Vec3 p = world.Momentum(0), l = world.AngularMomentum(0);
  const double energy = EnergyOf(world);
  for (int i = 0; i < 4000; ++i) {
    world.Step(1e-3);
    ASSERT_NEAR(EnergyOf(world) + world.CableFrictionLoss(0, 0), energy, 0.01 * energy) << i;
  }
  EXPECT_GT(world.CableFrictionLoss(0, 0), 0.05 * energy);
  EXPECT_LT(Distance(world.Momentum(0), p), 1e-12);
  EXPECT_LT(Distance(world.AngularMomentum(0), l), 1e-11);
}

/// A cable with negligible friction equals a frictionless one, also while it is wound and damped.
TEST(Capstan, HardlyAnyFrictionIsNone) {
  double tension[2];
  for (const double friction : {0.0, 1e-9}) {
    ModelDef def;
    def.bodies = {CapstanBall(1e6, {1, 0, 0})};
    def.bodies[0].velocity_m_per_s = {0.2, 0, 0};
    def.gravity_m_per_s2 = {};
    AddCable(def, {{kWorld, {0, 0, -0.3}}, {kWorld, {0, 0, 0}, friction}, {0, {1, 0, 0}}}, 200, 20);
    def.cables[0].damping_n_s_per_m = 20;
    ActuatorDef& motor = def.cables[0].actuator;
    motor.kind = ActuatorDef::Kind::kLimited;
    motor.max_speed_m_per_s = 0.07, motor.max_force_n = 1e3;
    motor.max_acceleration_m_per_s2 = std::numeric_limits<double>::infinity();
    WorldBatch world = MakeBatch(def);
    world.SetRestLengthTarget(0, 0, 0.5);
    world.Step(1e-3, 500);
    tension[friction > 0] = world.Cable(0, 0).tension_n;
  }
  // 20 N, 0.1 m of motion and 0.035 m of winding at 200 N/m, a damper at 0.2 m/s.
  EXPECT_NEAR(tension[0], 20 + 200 * 0.135 + 20 * 0.2, 0.01);
  EXPECT_NEAR(tension[1], tension[0], 0.03);  // mean over the step against the value at its end
}

TEST(Capstan, LanesAreLikeWorldsAlone) {
  ExpectLanesLikeWorldsAlone(CapstanAtwood(1, 0.4, 0.2, 5), {0.002, 0.01, 0.03}, 60);
}

}  // namespace
}  // namespace taut::test
