/// Supplies that motors share (docs/theory/motor.md, M.7).

#include <gtest/gtest.h>

#include "tests/physics/motor_fixture.h"

namespace taut::test {
namespace {

ModelDef TwoMotors(const DcMotorDef& a, const DcMotorDef& b) {
  ModelDef def = MotorAlone(a, 1, 1e5);
  def.cables.push_back(def.cables[0]);
  def.cables[1].name = "other";
  Wind(def.cables[1], b);
  return def;
}

// Two stalled motors at duty d: V = V0 - r I, I = sum of d (d V / R).
TEST(MotorSupply, SagsByTheCurrentsOfAllItsMotors) {
  DcMotorDef motor = PlainMotor();
  motor.supply_resistance_ohm = 5;  // so large that a lagging voltage would oscillate
  motor.resistance_ohm = 4;
  DcMotorDef apart = motor;
  apart.supply = "other";
  for (const double h : kThreeStepsS) {
    WorldBatch world = MakeBatch(TwoMotors(motor, motor));
    world.SetDuty(0, 0, 1);
    world.SetDuty(0, 1, 0.5);
    world.Step(h, StepsIn(5.0, h));
    const double volts = 12 / (1 + 5 * (1 + 0.25) / 4);
    for (const int cable : {0, 1}) {
      EXPECT_NEAR(world.Motor(0, cable).supply_voltage_v, volts, 1e-6 * volts);
    }
    EXPECT_NEAR(world.Motor(0, 0).current_a, volts / 4, 1e-6 * volts);
    EXPECT_NEAR(world.Motor(0, 1).voltage_v, volts / 2, 1e-6 * volts);
    // On separate supplies each motor has the voltage of a single motor.
    WorldBatch two = MakeBatch(TwoMotors(motor, apart));
    two.SetDuty(0, 0, 1);
    two.SetDuty(0, 1, 0.5);
    two.Step(h, StepsIn(5.0, h));
    EXPECT_NEAR(two.Motor(0, 0).supply_voltage_v, 12 / (1 + 5.0 / 4), 1e-5);
    EXPECT_NEAR(two.Motor(0, 1).supply_voltage_v, 12 / (1 + 5 * 0.25 / 4), 1e-5);
  }
}

// A motor that is off draws nothing, whatever its last duty.
TEST(MotorSupply, DoesNotSagByAMotorThatIsOff) {
  DcMotorDef motor = PlainMotor();
  motor.supply_resistance_ohm = 5;
  WorldBatch world = MakeBatch(TwoMotors(motor, motor));
  world.SetDuty(0, 0, 1);
  world.SetDuty(0, 1, 1);
  world.SetMotorEnabled(0, 1, false);
  world.Step(1e-3, 5000);
  EXPECT_NEAR(world.Motor(0, 0).supply_voltage_v, 12 / (1 + 5 / motor.resistance_ohm), 1e-5);
}

// The duty of a moving servo is reduced by its damping (M.6), in (M.7), too.
TEST(MotorSupply, SagsByWhatAServoDrawsWhileItMoves) {
  DcMotorDef motor = PlainMotor();
  motor.supply_resistance_ohm = 5;
  const double k = motor.torque_constant_n_m_per_a, R = motor.resistance_ohm, h = 1e-3;
  WorldBatch world = MakeBatch(MotorAlone(motor));
  world.SetRestLengthTarget(0, 0, 100 - 2e-4);
  for (int i = 0; i < 5; ++i) {
    const double w = world.Motor(0, 0).rotor_speed_rad_per_s;
    const double falls =
        Way(motor) * (0.5 * h * motor.servo_gain_per_m + motor.servo_damping_s_per_m);
    const double d =
        motor.servo_gain_per_m * (world.Cable(0, 0).rest_length_m - (100 - 2e-4)) - falls * w;
    ASSERT_LT(std::fabs(d), 1);
    world.Step(h);
    const double volts = (12 + 5 * d * k * w / R) / (1 + 5 * d * d / R);
    EXPECT_NEAR(world.Motor(0, 0).supply_voltage_v, std::min(12.0, volts), 1e-9) << i;
  }
}

// The returned current of a braking motor does not raise the supply above its no-load voltage.
TEST(MotorSupply, IsNotChargedAboveItsVoltage) {
  DcMotorDef motor = PlainMotor();
  motor.supply_resistance_ohm = 5;
  WorldBatch world = MakeBatch(MotorAlone(motor));
  world.SetDuty(0, 0, 1);
  world.Step(1e-3, 200);
  const double energy = world.Motor(0, 0).energy_from_supply_j;
  world.SetDuty(0, 0, 0.3);
  world.Step(1e-3, 2);
  EXPECT_LT(world.Motor(0, 0).current_a, 0);
  EXPECT_EQ(world.Motor(0, 0).supply_voltage_v, 12);
  EXPECT_LT(world.Motor(0, 0).energy_from_supply_j, energy);
}

}  // namespace
}  // namespace taut::test
