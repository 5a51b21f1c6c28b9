/// DC motors against closed forms (docs/theory/motor.md): running up and down, stall, back-driving,
/// holding.

#include <gtest/gtest.h>

#include "tests/physics/motor_fixture.h"

namespace taut::test {
namespace {

double Speed(const WorldBatch& world) { return world.Motor(0, 0).rotor_speed_rad_per_s; }
double RestLength(const WorldBatch& world) { return world.Cable(0, 0).rest_length_m; }

// Data sheet of the Faulhaber 1524T012SR: 9800 rpm and 7 mA without load, 6.92 mN m at stall, a
// mechanical time constant of 8.3 ms. These numbers agree with each other to some 1 %.
TEST(Motor, DoesWhatItsDataSheetSays) {
  DcMotorDef motor;
  motor.driver_resistance_ohm = 0;
  motor.resistance_rise_per_k = 0;
  WorldBatch free = MakeBatch(MotorAlone(motor));
  free.SetDuty(0, 0, 1);
  free.Step(1e-3, 8);
  const double after_8_ms = Speed(free);
  free.Step(1e-3, 500);
  EXPECT_NEAR(Speed(free) * 60 / 6.283185307, 9800, 0.01 * 9800);
  EXPECT_NEAR(free.Motor(0, 0).current_a, 0.007, 0.01 * 0.007);
  EXPECT_NEAR(after_8_ms / Speed(free), 1 - std::exp(-8 / 8.3), 0.02);

  WorldBatch stalled = MakeBatch(MotorAlone(motor, 1, 1e5));
  stalled.SetDuty(0, 0, 1);
  stalled.Step(1e-3, 2000);
  EXPECT_EQ(Speed(stalled), 0);
  const double torque = motor.torque_constant_n_m_per_a * stalled.Motor(0, 0).current_a;
  EXPECT_NEAR(torque - motor.friction_torque_n_m, 6.92e-3, 0.01 * 6.92e-3);
}

// w_n = w_inf (1 - p^-n), p = 1 + z + z^2 / 2, z = h / tau, is the scheme's approximation of exp(-t
// / tau) (motor.md, M.8), whose error in time is z^2 / 6.
TEST(Motor, RunsUpExponentially) {
  const DcMotorDef motor = PlainMotor();
  const double k = motor.torque_constant_n_m_per_a;
  const double tau = motor.resistance_ohm * motor.rotor_inertia_kg_m2 / (k * k);
  for (const double duty : {1.0, -0.3}) {
    const double final_speed = duty * motor.supply_voltage_v / k;
    for (const double h : kThreeStepsS) {
      WorldBatch world = MakeBatch(MotorAlone(motor));
      world.SetDuty(0, 0, duty);
      const int steps = StepsIn(0.016, h);
      world.Step(h, steps);
      const double z = h / tau, p = 1 + z + z * z / 2;
      const double expected = final_speed * (1 - std::pow(p, -steps));
      EXPECT_NEAR(Speed(world), expected, RoundOff(steps, std::fabs(final_speed)));
      EXPECT_NEAR(Speed(world), final_speed * (1 - std::exp(-0.016 / tau)),
                  std::fabs(final_speed) * z * z * 0.1);
      // The angle is the sum of the speeds: J dw = k i dt, V = R i + k dtheta/dt.
      const double angle = (final_speed * 0.016 - Speed(world) * tau);
      EXPECT_NEAR(world.Motor(0, 0).rotor_angle_rad, angle, RoundOff(steps, 1e5));
      EXPECT_NEAR(RestLength(world), 100 - Way(motor) * angle, RoundOff(steps, 200));
    }
  }
}

// With the driver off only friction acts: the speed falls linearly and is exactly 0 in the end.
TEST(Motor, SwitchedOffItRunsDownInALineAndStands) {
  DcMotorDef motor = PlainMotor();
  motor.friction_torque_n_m = motor.static_friction_torque_n_m = 8e-5;
  const double falls = motor.friction_torque_n_m / motor.rotor_inertia_kg_m2;
  for (const double h : kThreeStepsS) {
    WorldBatch world = MakeBatch(MotorAlone(motor));
    world.SetDuty(0, 0, 1);
    world.Step(h, StepsIn(0.2, h));
    const double start = Speed(world), angle = world.Motor(0, 0).rotor_angle_rad;
    world.SetMotorEnabled(0, 0, false);
    EXPECT_EQ(world.Motor(0, 0).mode, MotorMode::kOff);
    world.Step(h, StepsIn(0.4, h));
    EXPECT_NEAR(Speed(world), start - 0.4 * falls, RoundOff(1600, start));
    EXPECT_EQ(world.Motor(0, 0).current_a, 0);
    world.Step(h, StepsIn(start / falls - 0.4 + h, h) + 1);
    EXPECT_EQ(Speed(world), 0);
    // The motor stops within the last step; the stop may be off by half a step.
    EXPECT_NEAR(world.Motor(0, 0).rotor_angle_rad - angle, start * start / (2 * falls),
                0.5 * falls * h * h + RoundOff(4000, 1e6));
    const double rest = RestLength(world);
    world.Step(h, 1000);
    EXPECT_EQ(RestLength(world), rest);
  }
}

// With viscous friction: w = (w0 + c) exp(-t / tau) - c, c = friction / viscous.
TEST(Motor, ViscousFrictionSlowsItDown) {
  DcMotorDef motor = PlainMotor();
  motor.friction_torque_n_m = motor.static_friction_torque_n_m = 2e-5;
  motor.viscous_friction_n_m_s_per_rad = 2e-7;
  const double c = motor.friction_torque_n_m / motor.viscous_friction_n_m_s_per_rad;
  const double tau = motor.rotor_inertia_kg_m2 / motor.viscous_friction_n_m_s_per_rad;
  for (const double h : kThreeStepsS) {
    WorldBatch world = MakeBatch(MotorAlone(motor));
    world.SetDuty(0, 0, -1);
    world.Step(h, StepsIn(0.2, h));
    const double start = -Speed(world);
    world.SetMotorEnabled(0, 0, false);
    world.Step(h, StepsIn(0.2, h));
    EXPECT_NEAR(-Speed(world), (start + c) * std::exp(-0.2 / tau) - c,
                start * h * h / (tau * tau) / 6);
  }
}

// Duty 0 shorts the winding: back EMF brakes with the time constant of the motor.
TEST(Motor, DutyZeroBrakes) {
  const DcMotorDef motor = PlainMotor();
  const double k = motor.torque_constant_n_m_per_a;
  const double tau = motor.resistance_ohm * motor.rotor_inertia_kg_m2 / (k * k);
  WorldBatch world = MakeBatch(MotorAlone(motor));
  world.SetDuty(0, 0, 1);
  world.Step(1e-4, 2000);
  const double start = Speed(world);
  world.SetDuty(0, 0, 0);
  EXPECT_EQ(world.Motor(0, 0).mode, MotorMode::kDuty);
  world.Step(1e-4, 100);
  EXPECT_NEAR(Speed(world), start * std::exp(-0.01 / tau), start * 1e-4);
  EXPECT_LT(world.Motor(0, 0).current_a, 0);
}

// Wound up to the balance of the drive's torque with friction and the cable through the gear.
TEST(Motor, StallsAtTheTensionThatItsTorqueHolds) {
  DcMotorDef motor = PlainMotor();
  motor.friction_torque_n_m = motor.static_friction_torque_n_m = 8e-5;
  motor.gear_efficiency = 0.66;
  for (const double duty : {1.0, 0.4}) {
    const double torque =
        motor.torque_constant_n_m_per_a * duty * motor.supply_voltage_v / motor.resistance_ohm;
    const double tension =
        motor.gear_efficiency * (torque - motor.friction_torque_n_m) / Way(motor);
    for (const double h : kThreeStepsS) {
      WorldBatch world = MakeBatch(MotorAlone(motor, 1, 2e4));
      world.SetDuty(0, 0, duty);
      world.Step(h, StepsIn(2.0, h));
      // exponential decay, as friction does not depend on the speed
      EXPECT_NEAR(Speed(world), 0, 1e-8);
      // The tension is approached from below; the rotor's inertia overshoots by less than this.
      EXPECT_NEAR(world.Cable(0, 0).tension_n, tension, 1e-3 * tension);
      // Between winding in and being pulled out, friction in both directions holds the motor.
      const double rest = RestLength(world);
      world.SetDuty(0, 0, 0.8 * duty);
      world.Step(h, 500);
      EXPECT_EQ(RestLength(world), rest);
    }
  }
}

/// Returns the largest cable tension [N] that the motor's static friction holds, the gear's
/// friction included.
double LargestHeldN(const DcMotorDef& motor) {
  const double share = 2 - 1 / motor.gear_efficiency;  // share of the cable's torque at the rotor
  return share > 0 ? motor.static_friction_torque_n_m / (Way(motor) * share) : INFINITY;
}

// A weight that friction can hold keeps its position to the bit indefinitely; a weight heavier by 1
// % descends.
TEST(Motor, SwitchedOffItHoldsWhatItsFrictionCan) {
  DcMotorDef motor;
  for (const double efficiency : {1.0, 0.66, 0.5, 0.3}) {
    motor.gear_efficiency = efficiency;
    const double held_n = std::min(LargestHeldN(motor), 1e3);
    for (const double h : {2.5e-4, 1e-3, 2e-3}) {
      WorldBatch world = MakeBatch(MotorWithWeight(motor, Weight(0.99 * held_n / 9.81, 1e4)));
      world.SetMotorEnabled(0, 0, false);
      world.Step(h, 20'000);
      EXPECT_EQ(RestLength(world), 1.0) << efficiency;
      EXPECT_EQ(Speed(world), 0) << efficiency;
      if (held_n == 1e3) continue;
      WorldBatch heavier = MakeBatch(MotorWithWeight(motor, Weight(1.01 * held_n / 9.81, 1e4)));
      heavier.SetMotorEnabled(0, 0, false);
      heavier.Step(h, StepsIn(2.0, h));
      EXPECT_GT(RestLength(heavier), 1.001) << efficiency;
    }
  }
}

// The motor holds without creep even while its cable vibrates.
TEST(Motor, HoldsARingingCableWithoutCreep) {
  DcMotorDef motor;
  for (const double stiffness : {227.0, 1e4, 1e6}) {
    scenes::HangingMass weight = Weight(0.6 * LargestHeldN(motor) / 9.81, stiffness);
    weight.length_m += 0.2 * weight.sag_m();
    WorldBatch world = MakeBatch(MotorWithWeight(motor, weight));
    world.SetMotorEnabled(0, 0, false);
    double least = 1e9, most = 0;
    for (int i = 0; i < 20'000; ++i) {
      world.Step(1e-3);
      least = std::min(least, world.Cable(0, 0).tension_n);
      most = std::max(most, world.Cable(0, 0).tension_n);
    }
    EXPECT_EQ(RestLength(world), 1.0) << stiffness;
    EXPECT_GT(most - least, 0.2 * weight.mass_kg * 9.81) << stiffness;
  }
}

// A weight drives a motor that is off: m a = m g - T, J a / way = way T share - friction.
TEST(Motor, AWeightDrivesItBack) {
  DcMotorDef motor;
  motor.static_friction_torque_n_m = motor.friction_torque_n_m;
  const double way = Way(motor), share = 2 - 1 / motor.gear_efficiency, m = 3.0;
  const double a = (m * 9.81 * way * way * share - motor.friction_torque_n_m * way) /
                   (motor.rotor_inertia_kg_m2 + m * way * way * share);
  for (const double stiffness : {1e4, 1e6}) {
    for (const double h : kThreeStepsS) {
      WorldBatch world = MakeBatch(MotorWithWeight(motor, Weight(m, stiffness, 200)));
      world.SetMotorEnabled(0, 0, false);
      const int steps = StepsIn(0.5, h);
      world.Step(h, steps);
      EXPECT_NEAR(RestLength(world) - 1, a * 0.125, 0.01 * a * 0.125) << stiffness << " " << h;
      EXPECT_NEAR(-Speed(world) * way, a * 0.5, 0.01 * a * 0.5) << stiffness << " " << h;
    }
  }
}

// Braked, it sinks at the speed at which the torque of the short circuit balances the load less
// friction.
TEST(Motor, SinksEvenlyWhenBraked) {
  DcMotorDef motor;
  motor.resistance_rise_per_k = 0;
  const double k = motor.torque_constant_n_m_per_a, share = 2 - 1 / motor.gear_efficiency;
  const double ohm = motor.resistance_ohm + motor.driver_resistance_ohm;
  const double torque = 30 * Way(motor) * share - motor.friction_torque_n_m;
  for (const double h : kThreeStepsS) {
    WorldBatch world = MakeBatch(MotorWithWeight(motor, Weight(30 / 9.81, 1e4, 100)));
    world.SetDuty(0, 0, 0);
    world.Step(h, StepsIn(2.0, h));
    const double expected = -torque * ohm / (k * k);
    // Above Stribeck's speed, a share of (10 / 150)^2 of the Stribeck term remains.
    EXPECT_NEAR(Speed(world), expected, 0.003 * std::fabs(expected));
  }
}

// A motor that breaks away at its static friction continues against the lower kinetic friction and
// runs away.
TEST(Motor, BreaksAwayAtTheFrictionOfRest) {
  DcMotorDef motor = PlainMotor();
  motor.friction_torque_n_m = 8e-5;
  motor.static_friction_torque_n_m = 3e-4;
  motor.stribeck_speed_rad_per_s = 1;
  const double per_duty =
      motor.torque_constant_n_m_per_a * motor.supply_voltage_v / motor.resistance_ohm;
  WorldBatch world = MakeBatch(MotorAlone(motor));
  world.SetDuty(0, 0, 0.99 * 3e-4 / per_duty);
  world.Step(1e-3, 1000);
  EXPECT_EQ(RestLength(world), 100);
  world.SetDuty(0, 0, 1.05 * 3e-4 / per_duty);
  world.Step(1e-3, 1000);
  // (torque - friction) R / k^2, less the Stribeck term at that speed.
  const double k = motor.torque_constant_n_m_per_a;
  const double expected = (1.05 * 3e-4 - 8e-5) * motor.resistance_ohm / (k * k);
  const double more = 2.2e-4 / (1 + expected * expected) * motor.resistance_ohm / (k * k);
  EXPECT_NEAR(Speed(world), expected - more, 0.2 * more);
  // Below that torque it stays in motion, down to the kinetic friction.
  world.SetDuty(0, 0, 2e-4 / per_duty);
  world.Step(1e-3, 1000);
  EXPECT_GT(Speed(world), 10);
}

}  // namespace
}  // namespace taut::test
