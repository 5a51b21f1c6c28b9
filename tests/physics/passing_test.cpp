/// Continuous collision detection: bodies that pass each other are not deflected, bodies that meet
/// rebound, and resting bodies keep their contacts (docs/theory/contact.md, section 7).

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/box.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

constexpr double kFlybyStepS = 1e-3;
const Material kSmooth{0, 0, 0};

/// Returns a model whose body 0 flies along x past body 1 or the terrain: it starts `back_m` behind
/// the origin and passes at a distance of `clear_m`.
using Flyby = std::function<ModelDef(double clear_m, double back_m)>;

/// Returns how many of 16 flights, with starts shifted by sixteenths of a step's travel, change any
/// velocity.
int Deflected(const Flyby& flyby, double clear_m, double speed_m_per_s, double spin_rad_per_s = 0) {
  int deflected = 0;
  for (int phase = 0; phase < 16; ++phase) {
    ModelDef def = flyby(clear_m, 0.3 + phase * speed_m_per_s * kFlybyStepS / 16);
    def.gravity_m_per_s2 = {0, 0, 0};
    const Vec3 v{speed_m_per_s, 0, 0}, w{spin_rad_per_s, 0, 0};
    def.bodies[0].velocity_m_per_s = v;
    def.bodies[0].angular_velocity_rad_per_s = w;
    WorldBatch world = MakeBatch(def);
    world.Step(kFlybyStepS, StepsIn(0.7 / speed_m_per_s + 2 * kFlybyStepS, kFlybyStepS));
    double off = Distance(world.Body(0, 0).velocity_m_per_s, v) +
                 Distance(world.Body(0, 0).angular_velocity_rad_per_s, w);
    for (std::size_t b = 1; b < def.bodies.size(); ++b) {
      const BodyState other = world.Body(0, static_cast<int>(b));
      off += Norm(other.velocity_m_per_s) + Norm(other.angular_velocity_rad_per_s);
    }
    deflected += off > 1e-10 ? 1 : 0;
  }
  return deflected;
}

void PassesAtAnySpeed(const Flyby& flyby) {
  for (const double clear : {1e-4, 5e-4, 1e-3, 5e-3}) {
    for (const double speed : {1.0, 3.0, 10.0, 30.0}) {
      EXPECT_EQ(Deflected(flyby, clear, speed), 0) << clear << " m at " << speed << " m/s";
    }
  }
}

constexpr double kBallM = 0.02, kRodM = 0.003;

ModelDef BallPastBall(double clear, double back, bool fixed) {
  ModelDef def;
  scenes::AddBall(def, "flies", 1, kBallM, {-back, 0, 2 * kBallM + clear}, kSmooth);
  scenes::AddBall(def, "other", 1, kBallM, {0, 0, 0}, kSmooth);
  def.bodies[1].fixed = fixed;
  return def;
}
ModelDef RodPastEnd(double clear, double back, bool fixed) {
  ModelDef def;
  scenes::AddRod(def, "flies", 0.05, kRodM, {-back, -0.2, 0}, {-back, 0.2, 0}, kSmooth);
  scenes::AddRod(def, "other", 1, kRodM, {0, 0, 2 * kRodM + clear}, {0, 0, 0.3}, kSmooth);
  def.bodies[1].fixed = fixed;
  return def;
}
ModelDef OverTheWall(double clear, double back, const Vec3& half_rod) {
  ModelDef def;
  const Vec3 middle{-back, 0, 0.05 + kRodM + clear};
  scenes::AddRod(def, "flies", 0.05, kRodM, middle - half_rod, middle + half_rod, kSmooth);
  def.terrain_boxes.push_back({"wall", {0, 0, 0}, {}, {0.02, 1, 0.05}, kSmooth});
  return def;
}
ModelDef BoxPastBox(double clear, double back, const Quat& q, double reach, bool fixed) {
  ModelDef def;
  const Vec3 half{0.05, 0.05, 0.05};
  scenes::AddBox(def, "flies", 1, half, {-back, 0.01, 0.05 + reach + clear}, q, kSmooth);
  scenes::AddBox(def, "other", 1, half, {0, 0, 0}, {}, kSmooth);
  def.bodies[1].fixed = fixed;
  return def;
}

TEST(Passing, ABallPassesABall) {
  for (const bool fixed : {true, false}) {
    PassesAtAnySpeed([&](double clear, double back) { return BallPastBall(clear, back, fixed); });
  }
}

TEST(Passing, ARodPassesTheEndOfARod) {
  for (const bool fixed : {true, false}) {
    PassesAtAnySpeed([&](double clear, double back) { return RodPastEnd(clear, back, fixed); });
  }
}

TEST(Passing, ARodPassesOverTheEdgesOfAWall) {
  // The wall lies across the path, oblique to it, and along it.
  for (const Vec3& half : {Vec3{0, 0.2, 0}, Vec3{0.08, 0.12, 0}, Vec3{0.1, 0, 0}}) {
    PassesAtAnySpeed([&](double clear, double back) { return OverTheWall(clear, back, half); });
  }
}

TEST(Passing, ABoxPassesABox) {
  const double pi = 3.14159265358979323846;
  const struct {
    Quat q;
    double reach_m;
  } cases[] = {{{}, 0.05},  // face over face; an edge along the path, and across it
               {scenes::Turn({1, 0, 0}, pi / 4), 0.05 * std::sqrt(2.0)},
               {scenes::Turn({0, 1, 0}, pi / 4), 0.05 * std::sqrt(2.0)}};
  for (const auto& c : cases) {
    for (const bool fixed : {true, false}) {
      const auto flyby = [&](double clear, double back) {
        return BoxPastBox(clear, back, c.q, c.reach_m, fixed);
      };
      PassesAtAnySpeed(flyby);
    }
  }
}

TEST(Passing, ASpinningBallPassesABall) {
  const auto flyby = [](double clear, double back) { return BallPastBall(clear, back, true); };
  for (const double speed : {1.0, 10.0}) EXPECT_EQ(Deflected(flyby, 1e-4, speed, 100), 0) << speed;
}

TEST(Passing, ABallThatMeetsAnEdgeReboundsFromWhereTheyTouch) {
  // The edge is half a radius below the ball's center: the normal at the moment of contact is 30
  // degrees oblique and passes through the center, so that a smooth ball gets no spin.
  const double s = 0.5, c = std::sqrt(1 - s * s);
  for (const double speed : {1.0, 3.0, 10.0, 30.0}) {
    for (int phase = 0; phase < 16; ++phase) {
      ModelDef def;
      def.gravity_m_per_s2 = {0, 0, 0};
      const Material material{0, 0, 1};
      const double back = 0.3 + phase * speed * kFlybyStepS / 16;
      scenes::AddBall(def, "flies", 1, kBallM, {-back, 0, 0.05 + s * kBallM}, material);
      def.terrain_boxes.push_back({"wall", {0.1, 0, 0}, {}, {0.1, 1, 0.05}, material});
      def.bodies[0].velocity_m_per_s = {speed, 0, 0};
      WorldBatch world = MakeBatch(def);
      world.Step(kFlybyStepS, StepsIn(0.5 / speed, kFlybyStepS));
      const BodyState ball = world.Body(0, 0);
      // Balls count as touching within a thousandth of a step's travel; divided by the lever arm r.
      const double off = 4e-3 * speed * kFlybyStepS / kBallM;
      EXPECT_NEAR(EnergyOf(world), 0.5 * speed * speed, 1e-9 * speed * speed) << speed;
      EXPECT_LE(Distance((1 / speed) * ball.velocity_m_per_s, {1 - 2 * c * c, 0, 2 * c * s}), off)
          << speed << " " << phase;
      EXPECT_LE(Norm(ball.angular_velocity_rad_per_s) * kBallM, off * speed) << speed;
    }
  }
}

TEST(Passing, WhatMeetsAWallOrABoxReboundsWithItsEnergy) {
  const Flyby meetings[] = {
      [](double clear, double back) { return RodPastEnd(clear, back, true); },
      [](double clear, double back) {
        return OverTheWall(clear, back, {0, 0.2, 0});
      },
      [](double clear, double back) {
        return OverTheWall(clear, back, {0.08, 0.12, 0});
      },
      [](double clear, double back) { return BoxPastBox(clear, back, {}, 0.05, true); },
      [](double clear, double back) { return BoxPastBox(clear, back, {}, 0.05, false); }};
  int which = 0;
  for (const Flyby& meeting : meetings) {
    for (const double speed : {1.0, 3.0, 10.0}) {
      for (int phase = 0; phase < 16; ++phase) {
        ModelDef def = meeting(-2e-3, 0.3 + phase * speed * kFlybyStepS / 16);
        def.gravity_m_per_s2 = {0, 0, 0};
        def.bodies[0].velocity_m_per_s = {speed, 0, 0};
        for (CapsuleDef& shape : def.capsules) shape.material.restitution = 1;
        for (BoxDef& shape : def.boxes) shape.material.restitution = 1;
        WorldBatch world = MakeBatch(def);
        const double start = EnergyOf(world);
        world.Step(kFlybyStepS, StepsIn(0.4 / speed, kFlybyStepS));
        EXPECT_NEAR(EnergyOf(world) / start, 1, 1e-3) << which << " " << speed << " " << phase;
        EXPECT_GT(Distance(world.Body(0, 0).velocity_m_per_s, {speed, 0, 0}), 0.1 * speed)
            << which << " " << speed << " " << phase;
      }
    }
    ++which;
  }
}

TEST(Passing, ASlabOnBallsKeepsAllItsContacts) {
  // Before contacts hold the bodies, all fall alike. Contacts are detected from their relative free
  // motion, which is zero.
  for (const bool fixed : {true, false}) {
    ModelDef def;
    const Material material{0.5, 0.5, 0};
    scenes::AddGround(def, material);
    const double r = 0.02;
    for (int i = 0; i < 30; ++i) {
      const Vec3 at{-0.25 + 0.1 * (i % 6), -0.2 + 0.1 * (i / 6), r};  // NOLINT
      scenes::AddBall(def, "ball", 0.1, r, at, material);
      def.bodies.back().fixed = fixed;
    }
    scenes::AddBox(def, "slab", 5, {0.3, 0.3, 0.02}, {0, 0, 2 * r + 0.02}, {}, material);
    WorldBatch world = MakeBatch(def);
    world.Step(kFlybyStepS);
    const std::size_t count = world.Contacts(0).size();
    EXPECT_EQ(count, fixed ? 30u : 60u);
    for (int n = 0; n < 3000; ++n) {
      world.Step(kFlybyStepS);
      ASSERT_EQ(world.Contacts(0).size(), count) << n;
    }
  }
}

}  // namespace
}  // namespace taut::test
