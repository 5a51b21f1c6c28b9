/// Sticking and stopping motors, to the bit and within a step (docs/theory/motor.md, sections 2 and
/// 3): details that long runs do not resolve.

#include <gtest/gtest.h>

#include "tests/physics/motor_fixture.h"

namespace taut::test {
namespace {

double RotorSpeed(const WorldBatch& world) { return world.Motor(0, 0).rotor_speed_rad_per_s; }
double Angle(const WorldBatch& world) { return world.Motor(0, 0).rotor_angle_rad; }

// A motor that holds is a fixed end for any motion of the weight: the result is bit-identical to a
// cable without a motor. This also holds for a rotor so light that its rotation would affect the
// cable.
TEST(MotorStick, AMotorThatHoldsIsAFixedEnd) {
  DcMotorDef motor;
  motor.gear_ratio = 2;
  motor.friction_torque_n_m = 1e-4;
  motor.static_friction_torque_n_m = 2e-4;
  for (const double efficiency : {1.0, 0.66, 0.4}) {
    motor.gear_efficiency = efficiency;
    const double share = 2 - 1 / efficiency;
    const double held_n = share > 0 ? 2e-4 / (Way(motor) * share) : 10.0;
    // The damping is enough for fixed directions without substeps.
    scenes::HangingMass weight = Weight(0.6 * held_n / 9.81, 5000, 2);
    weight.length_m += 0.3 * weight.sag_m();
    WorldBatch held = MakeBatch(MotorWithWeight(motor, weight)), fixed = MakeBatch(weight.Def());
    held.SetMotorEnabled(0, 0, false);
    for (int i = 0; i < 3000; ++i) {
      held.Step(1e-3);
      fixed.Step(1e-3);
      // Stiff cables with motors use fixed directions, others do not: here both have the same
      // result.
      ASSERT_NEAR(held.Body(0, 0).position_m.z, fixed.Body(0, 0).position_m.z, 1e-12)
          << efficiency << i;
      ASSERT_NEAR(held.Cable(0, 0).tension_n, fixed.Cable(0, 0).tension_n, 1e-8) << efficiency << i;
    }
    EXPECT_EQ(held.Cable(0, 0).rest_length_m, 1.0);
  }
}

// Braked, with friction, no cable: w_1 = (w_0 - F h / J (1 + z / 2)) / p is 0 from the step length
// of (M.10) on, in which the rotor travels h w_0 / (2 + z); in a slightly shorter step it travels
// the distance of (M.8).
TEST(MotorStick, ItStopsInTheStepThatFrictionAndBrakeHaveTimeIn) {
  DcMotorDef motor = PlainMotor();
  motor.friction_torque_n_m = motor.static_friction_torque_n_m = 4e-4;
  const double k = motor.torque_constant_n_m_per_a, J = motor.rotor_inertia_kg_m2;
  const double rate = k * k / (motor.resistance_ohm * J), slows = 4e-4 / J;
  for (const double duty : {0.2, -0.2}) {
    for (const double longer : {0.99, 1.01, 1.5}) {
      WorldBatch world = MakeBatch(MotorAlone(motor));
      world.SetDuty(0, 0, duty);
      world.Step(1e-3, 200);
      const double speed = RotorSpeed(world), angle = Angle(world), w = std::fabs(speed);
      world.SetDuty(0, 0, 0);
      // w = slows h (1 + rate h / 2), solved for h
      const double enough_s = (std::sqrt(1 + 2 * rate * w / slows) - 1) / rate;
      const double h = longer * enough_s, z = rate * h, p = 1 + z + z * z / 2;
      ASSERT_GT(z, 0.5) << "else brake and friction do not differ";
      world.Step(h);
      const double sign = speed > 0 ? 1 : -1;
      if (longer > 1) {
        EXPECT_EQ(RotorSpeed(world), 0);
        EXPECT_NEAR(Angle(world) - angle, h * speed / (2 + z), 1e-9 * h * w) << longer;
      } else {
        EXPECT_NEAR(RotorSpeed(world), sign * (w - slows * h * (1 + z / 2)) / p, 1e-9 * w);
        const double mean = (w * (1 + z / 2) - slows * h * (1 + z) / 2) / p;
        EXPECT_NEAR(Angle(world) - angle, sign * h * mean, 1e-9 * h * w);
      }
    }
  }
}

// Where torque and tension balance just before the end of the spool, the motor stays there, though
// without the cable it would reach the end within a step.
TEST(MotorStick, TheEndOfTheSpoolIsNotReachedAgainstTheCable) {
  DcMotorDef motor = PlainMotor();
  motor.gear_ratio = 1;
  const double tension_n =
      motor.torque_constant_n_m_per_a * motor.supply_voltage_v / motor.resistance_ohm / Way(motor);
  const double rest_m = 1 - tension_n / 1000;
  ModelDef def = MotorAlone(motor, rest_m + 1e-8, 1000);  // a small remaining travel
  def.cables[0].actuator.min_rest_length_m = rest_m - 1e-7;
  WorldBatch world = MakeBatch(def);
  world.SetDuty(0, 0, 1);
  world.Step(1e-3, 1000);
  EXPECT_NEAR(world.Cable(0, 0).rest_length_m, rest_m, 2e-8);
}

// No rounding error makes a rest length shorter than the minimum.
TEST(MotorStick, TheEndOfTheSpoolIsNeverPassed) {
  for (int i = 0; i < 40; ++i) {
    ModelDef def = MotorAlone(DcMotorDef(), 0.2);
    def.cables[0].attachments[1].position_m = {0.05, 0, 0};
    const double least_m = 0.19 + 1e-4 * i;
    def.cables[0].actuator.min_rest_length_m = least_m;
    WorldBatch world = MakeBatch(def);
    world.SetDuty(0, 0, 1);
    for (int step = 0; step < 300; ++step) {
      world.Step(1e-3);
      ASSERT_GE(world.Cable(0, 0).rest_length_m, least_m) << i;
    }
    EXPECT_EQ(world.Cable(0, 0).rest_length_m, least_m) << i;
  }
}

// A self-locking gear is never driven back, however stiff the cable that stops the rotor within a
// step.
TEST(MotorStick, ACableThatStopsItDoesNotTurnItBack) {
  DcMotorDef motor;
  motor.gear_efficiency = 0.4;
  for (const double gear_ratio : {1.0, 5.0, 76.0}) {
    motor.gear_ratio = gear_ratio;
    for (const double stiffness : {1e3, 1e5, 1e7}) {
      for (const double h : kThreeStepsS) {
        WorldBatch world = MakeBatch(MotorAlone(motor, 1.01, stiffness));
        world.SetDuty(0, 0, 1);
        double rest_m = 1.01;
        for (int i = 0; i < StepsIn(1.0, h); ++i) {
          if (rest_m < 1) world.SetMotorEnabled(0, 0, false);
          world.Step(h);
          const double before_m = rest_m;
          rest_m = world.Cable(0, 0).rest_length_m;
          ASSERT_LE(rest_m, before_m) << gear_ratio << " " << stiffness << " " << h;
          ASSERT_GE(RotorSpeed(world), 0) << gear_ratio << " " << stiffness << " " << h;
        }
        EXPECT_EQ(RotorSpeed(world), 0);
        EXPECT_GT(world.Cable(0, 0).tension_n, 0);
      }
    }
  }
}

// A weight that falls into its slack cable does not drive the gear back either, although its
// tension cannot be predicted.
TEST(MotorStick, AWeightThatFallsIntoItsCableDoesNotTurnItBack) {
  DcMotorDef motor;
  motor.gear_efficiency = 0.4;
  for (const double gear_ratio : {1.0, 5.0, 76.0}) {
    motor.gear_ratio = gear_ratio;
    for (const double stiffness : {1e4, 1e6, 1e8}) {
      for (const double higher_m : {1e-4, 1e-3, 5e-3}) {
        scenes::HangingMass weight = Weight(0.3, stiffness, 0.1 * std::sqrt(0.3 * stiffness));
        weight.length_m = 1 - higher_m;
        for (const double h : {1.0 / 2000, 1.0 / 700, 1.0 / 250}) {
          WorldBatch world = MakeBatch(MotorWithWeight(motor, weight));
          world.SetDuty(0, 0, 0.2);
          double rest_m = 1;
          for (int i = 0; i < StepsIn(0.2, h); ++i) {
            world.Step(h);
            const double before_m = rest_m;
            rest_m = world.Cable(0, 0).rest_length_m;
            ASSERT_LE(rest_m, before_m) << gear_ratio << " " << stiffness << " " << h;
            ASSERT_GE(RotorSpeed(world), 0) << gear_ratio << " " << stiffness << " " << h;
          }
        }
      }
    }
  }
}

// A rotor that reverses within a step still travels forward first: w_m of (M.8), with friction
// against the final direction.
TEST(MotorStick, WhatTurnsRoundWithinAStepWentOnBefore) {
  DcMotorDef motor = PlainMotor();
  motor.friction_torque_n_m = motor.static_friction_torque_n_m = 8e-5;
  const double k = motor.torque_constant_n_m_per_a, J = motor.rotor_inertia_kg_m2;
  const double rate = k * k / (motor.resistance_ohm * J), h = 1e-3, z = rate * h;
  const double p = 1 + z + z * z / 2;
  for (const double sign : {1.0, -1.0}) {
    WorldBatch world = MakeBatch(MotorAlone(motor));
    world.SetDuty(0, 0, sign);
    world.Step(h, 100);
    world.SetDuty(0, 0, -sign);
    const double drive = -k * motor.supply_voltage_v / motor.resistance_ohm / J;
    bool turned_on = false;
    for (double w = sign * RotorSpeed(world), angle = sign * Angle(world); w > 0;) {
      world.Step(h);
      const double a = drive + (w / (h * (1 + z / 2)) + drive < 0 ? 8e-5 : -8e-5) / J;
      const double end = (w + a * h * (1 + z / 2)) / p;
      const double mean = (w * (1 + z / 2) + a * h * (1 + z) / 2) / p;
      EXPECT_NEAR(sign * RotorSpeed(world), end, 1e-9 * 1043);
      EXPECT_NEAR(sign * Angle(world) - angle, h * mean, 1e-9 * h * 1043);
      turned_on = turned_on || (end < 0 && mean > 0);
      w = end, angle = sign * Angle(world);
    }
    EXPECT_TRUE(turned_on) << "no step had its way in one direction and its end in the other";
  }
}

// Winding out through a self-locking gear: the friction that holds the rotor grows with the
// tension, which must not become a negative stiffness in series.
TEST(MotorStick, PaysOutThroughAGearThatLocks) {
  DcMotorDef motor;
  motor.gear_ratio = 1;
  motor.gear_efficiency = 0.3;
  for (const double stiffness : {1e3, 1e5, 1e6}) {
    for (const double h : kThreeStepsS) {
      const double tension_n = 0.3;  // stall torque: 1.3 N
      WorldBatch world = MakeBatch(MotorAlone(motor, 1 - tension_n / stiffness, stiffness));
      world.SetDuty(0, 0, -1);
      double before_n = tension_n;
      for (int i = 0; i < StepsIn(0.2, h); ++i) {
        world.Step(h);
        const double now_n = world.Cable(0, 0).tension_n;
        ASSERT_GE(now_n, 0);
        ASSERT_LE(now_n, before_n * (1 + 1e-12)) << stiffness << " " << h << " " << i;
        before_n = now_n;
      }
      EXPECT_EQ(before_n, 0);
    }
  }
}

// At constant speed, its torque balances back EMF and (M.5), whose bend is at Stribeck's speed.
TEST(MotorStick, FrictionFallsWithTheSquareOfTheSpeed) {
  DcMotorDef motor = PlainMotor();
  motor.friction_torque_n_m = 8e-5;
  motor.static_friction_torque_n_m = 3e-4;
  for (const double bend_rad_per_s : {5.0, 30.0}) {
    motor.stribeck_speed_rad_per_s = bend_rad_per_s;
    WorldBatch world = MakeBatch(MotorAlone(motor));
    world.SetDuty(0, 0, 0.06);
    world.Step(1e-3, 2000);
    const double k = motor.torque_constant_n_m_per_a, w = RotorSpeed(world);
    const double torque = k * (0.06 * motor.supply_voltage_v - k * w) / motor.resistance_ohm;
    const double ratio = w / bend_rad_per_s;
    ASSERT_GT(w, 10);
    EXPECT_NEAR(torque, 8e-5 + 2.2e-4 / (1 + ratio * ratio), 1e-10) << bend_rad_per_s;
  }
}

// Setting the rest length closes the backlash.
TEST(MotorStick, AMotorThatIsPutSomewhereHasNoSlackInItsGear) {
  DcMotorDef motor;
  motor.backlash_rad = 0.1;
  WorldBatch world = MakeBatch(MotorAlone(motor, 1.5));
  world.SetDuty(0, 0, -0.05);
  for (int i = 0; i < 1000 && world.Motor(0, 0).backlash_m < 1e-4; ++i) world.Step(1e-3);
  ASSERT_GT(world.Motor(0, 0).backlash_m, 1e-5);
  world.SetRestLength(0, 0, 1.2);
  EXPECT_EQ(world.Motor(0, 0).backlash_m, 0);
  EXPECT_NEAR(Angle(world), 0.3 / Way(motor), 1e-9);
}

}  // namespace
}  // namespace taut::test
