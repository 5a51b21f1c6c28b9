/// Actuators between commanded and actual rest lengths (docs/theory/cables.md). Limits are per
/// second, so each test runs at three step sizes.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/physics/world.h"
#include "tests/scenes/hanging_mass.h"

namespace taut::test {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// A cable of 1 m between two fixed points, slack by `slack_m`, with an actuator.
ModelDef Winch(const ActuatorDef& actuator, double slack_m = 0.5, double stiffness = 1000) {
  ModelDef def;
  CableDef cable;
  cable.name = "cable";
  cable.attachments = {{kWorld, {0, 0, 0}}, {kWorld, {1, 0, 0}}};
  cable.stiffness_n_per_m = stiffness;
  cable.rest_length_m = 1 + slack_m;
  cable.actuator = actuator;
  def.cables.push_back(cable);
  return def;
}

ActuatorDef Limited(double speed, double acceleration = kNone, double force = kNone) {
  ActuatorDef actuator;
  actuator.kind = ActuatorDef::Kind::kLimited;
  actuator.max_speed_m_per_s = speed;
  actuator.max_acceleration_m_per_s2 = acceleration;
  actuator.max_force_n = force;
  return actuator;
}

double Rest(const WorldBatch& world) { return world.Cable(0, 0).rest_length_m; }

/// A body too heavy to move hangs on a motor that winds in 0.1 mm at 0.1 m/s: its impulse within 4
/// ms must not depend on the number of steps.
TEST(Actuator, TheImpulseOfAMotorThatArrivesDoesNotDependOnTheStep) {
  constexpr double kMass = 1e6, kStiffness = 1000, kStretch = 0.01;
  constexpr double kTime = 4e-3, kSpeed = 0.1, kWay = 1e-4, kArrives = kWay / kSpeed;
  for (const bool ideal : {false, true}) {
    ModelDef def = Winch(Limited(kSpeed), -kStretch, kStiffness);
    if (ideal) def.cables[0].actuator.kind = ActuatorDef::Kind::kIdeal;
    def.gravity_m_per_s2 = {};
    BodyDef body;
    body.name = "heavy";
    body.mass_kg = kMass;
    body.com_m = {1, 0, 0};
    body.inertia_kg_m2 = {kMass, kMass, kMass, 0, 0, 0};
    def.bodies.push_back(body);
    def.cables[0].attachments[1].body = 0;
    const double arrives = ideal ? 0 : kArrives;
    const double stretch_time =
        kStretch * kTime + kWay * arrives / 2 + kWay * (kTime - arrives);  // [m s]
    for (const int steps : {1, 4, 64}) {
      WorldBatch world = MakeBatch(def);
      world.SetRestLengthTarget(0, 0, 1 - kStretch - kWay);
      world.Step(kTime / steps, steps);
      EXPECT_EQ(Rest(world), 1 - kStretch - kWay);
      // The body's motion changes the stretch by a share of less than 1e-9.
      const double impulse = -world.Body(0, 0).velocity_m_per_s.x * kMass;
      EXPECT_NEAR(impulse, kStiffness * stretch_time, 1e-8 * kStiffness * stretch_time)
          << steps << " steps, " << (ideal ? "ideal" : "limited");
    }
  }
}

TEST(Actuator, WithoutOneCommandsAreIgnored) {
  WorldBatch world = MakeBatch(Winch({}));
  world.SetRestLengthTarget(0, 0, 0.2);
  EXPECT_EQ(world.RestLengthTarget(0, 0), 0.2);
  world.Step(1e-3, 100);
  EXPECT_EQ(Rest(world), 1.5);
}

TEST(Actuator, AnIdealOneIsAtItsTargetAfterOneStep) {
  ActuatorDef ideal;
  ideal.kind = ActuatorDef::Kind::kIdeal;
  for (const double h : kThreeStepsS) {
    WorldBatch world = MakeBatch(Winch(ideal));
    EXPECT_EQ(world.RestLengthTarget(0, 0), 1.5);  // present rest length until the first command
    world.Step(h);
    EXPECT_EQ(Rest(world), 1.5);
    for (const double target : {0.4, 2.0, 0.9}) {
      world.SetRestLengthTarget(0, 0, target);
      EXPECT_NE(Rest(world), target);
      world.Step(h);
      EXPECT_EQ(Rest(world), target);
      EXPECT_NEAR(world.Cable(0, 0).tension_n, std::max(1000 * (1 - target), 0.0),
                  RoundOff(1, 1000));
    }
  }
}

TEST(Actuator, WindsAtItsSpeedAndStopsExactlyAtTheTarget) {
  const double speed = 0.07;
  for (const double h : kThreeStepsS) {
    for (const double target : {1.2345, 1.7654}) {
      WorldBatch world = MakeBatch(Winch(Limited(speed)));
      world.SetRestLengthTarget(0, 0, target);
      const double direction = target < 1.5 ? -1 : 1, way = std::fabs(target - 1.5);
      const int arrives = static_cast<int>(std::ceil(way / (speed * h)));
      for (int n = 1; n < arrives; ++n) {
        world.Step(h);
        ASSERT_NEAR(Rest(world), 1.5 + direction * speed * h * n, RoundOff(n, 2)) << h;
      }
      world.Step(h);
      for (int n = 0; n < 10; ++n) {
        EXPECT_EQ(Rest(world), target) << h;
        world.Step(h);
      }
    }
  }
}

TEST(Actuator, AnAccelerationLimitGivesATrapezoidWithoutOvershoot) {
  const double speed = 0.2, a = 0.8;
  // Duration of a move over `way` with the speed limit reached, d / v + v / a, and not reached, 2
  // sqrt(d / a).
  for (const double way : {0.3, 0.03}) {
    const bool reached = way > speed * speed / a;
    const double time = reached ? way / speed + speed / a : 2 * std::sqrt(way / a);
    for (const double h : kThreeStepsS) {
      for (const double direction : {-1.0, 1.0}) {
        WorldBatch world = MakeBatch(Winch(Limited(speed, a)));
        const double target = 1.5 + direction * way;
        world.SetRestLengthTarget(0, 0, target);
        double before = 0, rate = 0;
        for (int n = 1; n <= StepsIn(time + 10 * h, h); ++n) {
          const double last = Rest(world);
          world.Step(h);
          rate = direction * (Rest(world) - last) / h;
          // Differences of lengths of up to 2 m, divided by h.
          const double rounding = RoundOff(1, 2) / h;
          ASSERT_LE(rate, speed + rounding) << h;
          ASSERT_LE(std::fabs(rate - before), a * h + 2 * rounding) << h << ", step " << n;
          ASSERT_LE(direction * (Rest(world) - target), RoundOff(1, 2)) << "overshoot, " << h;
          before = rate;
          // The scheme's speeds are at most a h below the trapezoidal profile; the motor may lag by
          // two steps.
          const double t = n * h - 2 * h;
          const double way_up = std::max(t, 0.0) * std::max(t, 0.0) * a / 2;
          if (t < std::min(time / 2, speed / a)) {
            ASSERT_GE(direction * (Rest(world) - 1.5), way_up - RoundOff(1, 2)) << h;
          }
        }
        EXPECT_NEAR(Rest(world), target, a * h * h * 1e-3) << "arrived by then, at " << h;
      }
    }
  }
}

TEST(Actuator, AnAccelerationLimitBrakesBeforeItTurnsBack) {
  const double speed = 0.2, a = 0.8;
  for (const double h : kThreeStepsS) {
    WorldBatch world = MakeBatch(Winch(Limited(speed, a)));
    world.SetRestLengthTarget(0, 0, 1.0);
    world.Step(h, StepsIn(0.5, h));  // at full speed
    const double turn = Rest(world);
    world.SetRestLengthTarget(0, 0, 1.6);
    double least = turn, before = -speed;
    for (int n = 0; n < StepsIn(3, h); ++n) {
      const double last = Rest(world);
      world.Step(h);
      const double rate = (Rest(world) - last) / h;
      ASSERT_LE(std::fabs(rate - before), a * h + RoundOff(1, 4) / h) << h;
      before = rate;
      least = std::min(least, Rest(world));
    }
    // The motor stops after another v^2 / 2a; the sum over steps falls short of that by half a
    // step's travel.
    EXPECT_NEAR(turn - least, speed * speed / (2 * a), speed * h / 2 + RoundOff(100, 2)) << h;
    EXPECT_NEAR(Rest(world), 1.6, RoundOff(100, 2));
  }
}

TEST(Actuator, NeverWindsPastItsForce) {
  const double force = 50;
  for (const double h : kThreeStepsS) {
    for (const double acceleration : {kNone, 0.8}) {
      WorldBatch world = MakeBatch(Winch(Limited(0.2, acceleration, force), 0.1));
      world.SetRestLengthTarget(0, 0, 0.1);
      for (int n = 0; n < StepsIn(4, h); ++n) {
        world.Step(h);
        ASSERT_LE(world.Cable(0, 0).tension_n, force + RoundOff(1, 1000)) << h;
      }
      EXPECT_NEAR(world.Cable(0, 0).tension_n, force, 1e-9 * force) << h;
      // The target stays the same although a stiffer cable would reach the force with less winding.
      EXPECT_EQ(world.RestLengthTarget(0, 0), 0.1);
    }
  }
}

TEST(Actuator, NeverWindsBelowItsLeastRestLength) {
  for (const double h : kThreeStepsS) {
    ActuatorDef actuator = Limited(0.5);
    actuator.min_rest_length_m = 0.8;
    WorldBatch world = MakeBatch(Winch(actuator));
    world.SetRestLengthTarget(0, 0, 0.1);
    for (int n = 0; n < StepsIn(2, h); ++n) {
      world.Step(h);
      ASSERT_GE(Rest(world), 0.8);
    }
    EXPECT_EQ(Rest(world), 0.8);
  }
}

TEST(Actuator, DoesNotWindInWhileTheCableIsShorterThanItsLeastLength) {
  for (const double h : kThreeStepsS) {
    ActuatorDef actuator = Limited(0.5);
    actuator.min_length_m = 1.01;  // the cable is 1 m long
    WorldBatch world = MakeBatch(Winch(actuator));
    world.SetRestLengthTarget(0, 0, 0.5);
    world.Step(h, 100);
    EXPECT_EQ(Rest(world), 1.5) << h;
    world.SetRestLengthTarget(0, 0, 1.9);
    world.Step(h, StepsIn(2, h));
    EXPECT_EQ(Rest(world), 1.9) << "letting out is allowed";
  }
  ActuatorDef actuator = Limited(0.5);
  actuator.min_length_m = 0.99;
  WorldBatch world = MakeBatch(Winch(actuator));
  world.SetRestLengthTarget(0, 0, 0.5);
  world.Step(1e-3, 3000);
  EXPECT_EQ(Rest(world), 0.5);
}

TEST(Actuator, LiftsAWeightByAsMuchAsItWinds) {
  // Lifted slowly, the weight rises with the rest length; the elastic force stays equal to the
  // weight.
  for (const double h : kThreeStepsS) {
    scenes::HangingMass scene;
    scene.damping_n_s_per_m = 20;
    scene.length_m = scene.rest_length_m + scene.sag_m();
    ModelDef def = scene.Def();
    def.cables[0].actuator = Limited(0.05, 0.5);
    WorldBatch world = MakeBatch(def);
    world.SetRestLengthTarget(0, 0, 0.8);
    world.Step(h, StepsIn(10, h));
    EXPECT_EQ(Rest(world), 0.8);
    EXPECT_NEAR(world.Body(0, 0).position_m.z, -0.8 - scene.sag_m(), 1e-9) << h;
    EXPECT_NEAR(world.Cable(0, 0).elastic_n, 0.5 * 9.81, 1e-6) << h;
  }
}

TEST(Actuator, ARestLengthSetByHandIsAtRestAndItsOwnTarget) {
  WorldBatch world = MakeBatch(Winch(Limited(0.2, 0.8)));
  world.SetRestLengthTarget(0, 0, 1.0);
  world.Step(1e-3, 200);
  world.SetRestLength(0, 0, 1.25);
  world.Step(1e-3, 10);
  EXPECT_EQ(Rest(world), 1.25);
  EXPECT_EQ(world.RestLengthTarget(0, 0), 1.25);
}

}  // namespace
}  // namespace taut::test
