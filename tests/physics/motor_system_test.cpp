/// Motors in a system: energies, heat, backlash, the servo, and the effect of the step size.

#include <gtest/gtest.h>

#include <vector>

#include "tests/physics/motor_fixture.h"

namespace taut::test {
namespace {

double RestOfCable(const WorldBatch& world, int cable = 0) {
  return world.Cable(0, cable).rest_length_m;
}

double RotorEnergy(const WorldBatch& world, const DcMotorDef& motor) {
  const double w = world.Motor(0, 0).rotor_speed_rad_per_s;
  return 0.5 * motor.rotor_inertia_kg_m2 * w * w;
}

// Without friction, the supply's energy equals the sum over winding, driver, rotor and cable at all
// times; the scheme's loss is of the order of the squared step.
TEST(MotorEnergy, IsAllAccountedFor) {
  DcMotorDef motor = PlainMotor();
  motor.driver_resistance_ohm = 0.45;
  double before = 0;
  for (const double h : {1.0 / 1000, 1.0 / 2000, 1.0 / 4000}) {
    const scenes::HangingMass weight = Weight(2, 2000, 5);
    WorldBatch world = MakeBatch(MotorWithWeight(motor, weight));
    double most = 0;
    for (int i = 0; i < StepsIn(1.0, h); ++i) {
      const double t = i * h;
      world.SetDuty(0, 0, t < 0.3 ? 0.9 : (t < 0.5 ? -0.4 : 0.2));
      world.Step(h);
      const MotorState m = world.Motor(0, 0);
      const double lost = m.energy_in_winding_j *
                          (motor.resistance_ohm + motor.driver_resistance_ohm) /
                          motor.resistance_ohm;
      const double missing =
          m.energy_from_supply_j - lost - m.energy_to_cable_j - RotorEnergy(world, motor);
      most = std::max(most, std::fabs(missing));
    }
    const double scale = world.Motor(0, 0).energy_from_supply_j;
    EXPECT_LT(most, 0.02 * scale * (h * 1000) * (h * 1000));
    if (before > 0) {
      EXPECT_LT(most, before / 3);
    }
    before = most;
  }
}

// The energy that a motor supplies to its cable is the gain of the weight and the spring.
TEST(MotorEnergy, ToTheCableIsWhatItStoresAndLifts) {
  for (const double stiffness : {300.0, 1e5}) {
    WorldBatch world = MakeBatch(MotorWithWeight(DcMotorDef(), Weight(1.5, stiffness)));
    const double start = EnergyOf(world);
    world.SetRestLengthTarget(0, 0, 0.9);
    world.Step(1e-3, 6000);
    EXPECT_NEAR(RestOfCable(world), 0.9, 1e-3);
    const double given = world.Motor(0, 0).energy_to_cable_j;
    EXPECT_NEAR(given, EnergyOf(world) - start, 1e-3 * given) << stiffness;
    EXPECT_NEAR(given, 1.5 * 9.81 * 0.1, 0.02 * given) << stiffness;
    // Gear and winding dissipate most of the energy drawn.
    EXPECT_GT(world.Motor(0, 0).energy_from_supply_j, given / 0.66);
  }
}

// At a constant speed: V i from the supply, T v to the cable, and the difference is heat and
// friction.
TEST(MotorEnergy, OfASteadyLiftIsThatOfTheLaw) {
  DcMotorDef motor;
  motor.resistance_rise_per_k = 0;
  const double k = motor.torque_constant_n_m_per_a, way = Way(motor), load = 20;
  const double ohm = motor.resistance_ohm + motor.driver_resistance_ohm;
  const double current = (way * load / motor.gear_efficiency + motor.friction_torque_n_m) / k;
  const double speed = (12 - ohm * current) / k;
  WorldBatch world = MakeBatch(MotorWithWeight(motor, Weight(load / 9.81, 1e4, 200)));
  world.SetDuty(0, 0, 1);
  world.Step(1e-3, 1000);
  const MotorState from = world.Motor(0, 0);
  world.Step(1e-3, 5000);
  const MotorState to = world.Motor(0, 0);
  EXPECT_NEAR(to.rotor_speed_rad_per_s, speed, 1e-4 * speed);
  EXPECT_NEAR(to.current_a, current, 1e-4 * current);
  EXPECT_NEAR(to.energy_from_supply_j - from.energy_from_supply_j, 12 * current * 5,
              1e-3 * 12 * current * 5);
  EXPECT_NEAR(to.energy_to_cable_j - from.energy_to_cable_j, load * way * speed * 5,
              1e-3 * load * way * speed * 5);
}

// A stalled motor whose housing stays cold: the winding's temperature rises by P Rth (1 - exp(-t /
// 5.6 s)); cooled by the air alone, by P (Rth1 + Rth2) in the end.
TEST(MotorHeat, FollowsTheTwoBodiesOfTheDataSheet) {
  DcMotorDef motor = PlainMotor();
  DcMotorDef cold = motor;
  cold.housing_thermal_time_s = 1e12;
  WorldBatch world = MakeBatch(MotorAlone(cold, 1, 1e5));
  world.SetDuty(0, 0, 0.5);
  world.Step(1e-3, 5600);
  const double power = 36 / 19.8;  // from the start: it stalls within milliseconds
  const MotorState m = world.Motor(0, 0);
  EXPECT_NEAR(m.winding_temperature_c - 22, 10 * power * (1 - std::exp(-1.0)), 0.005 * 10 * power);
  EXPECT_NEAR(m.energy_in_winding_j, power * 5.6, 0.01 * power * 5.6);

  motor.winding_thermal_time_s = 0.56;  // for an earlier steady state
  motor.housing_thermal_time_s = 2.2;
  WorldBatch warm = MakeBatch(MotorAlone(motor, 1, 1e5));
  warm.SetDuty(0, 0, 0.5);
  warm.Step(1e-3, 60'000);
  EXPECT_NEAR(warm.Motor(0, 0).winding_temperature_c - 22, 39 * power, 1e-6 * 39 * power);
  EXPECT_NEAR(warm.Motor(0, 0).housing_temperature_c - 22, 29 * power, 1e-6 * 29 * power);

  // Copper: P = V^2 / R(T), R = R0 (1 + a (T - T0)), T - T0 = 39 P: a quadratic equation.
  motor.resistance_rise_per_k = 3.93e-3;
  WorldBatch copper = MakeBatch(MotorAlone(motor, 1, 1e5));
  copper.SetDuty(0, 0, 0.5);
  copper.Step(1e-3, 60'000);
  const double a = 3.93e-3, rise = (std::sqrt(1 + 4 * a * 39 * power) - 1) / (2 * a);
  EXPECT_NEAR(copper.Motor(0, 0).winding_temperature_c - 22, rise, 1e-6 * rise);
}

// With a slack cable, the rotor crosses the backlash in both directions before the spool moves;
// with a taut cable there is no backlash.
TEST(MotorBacklash, IsFeltWhereTheCableIsSlack) {
  DcMotorDef motor;
  motor.backlash_rad = 0.1;
  const double gap = motor.backlash_rad * motor.spool_radius_m;
  WorldBatch world = MakeBatch(MotorAlone(motor));
  const auto wound = [&] { return Way(motor) * world.Motor(0, 0).rotor_angle_rad; };
  world.SetDuty(0, 0, 0.5);
  world.Step(1e-3, 500);
  world.SetDuty(0, 0, 0);
  world.Step(1e-3, 300);
  const double rest = RestOfCable(world), start = wound();
  EXPECT_NEAR(100 - rest, start, 1e-12);
  world.SetDuty(0, 0, -0.05);
  while (start - wound() < 0.99 * gap) world.Step(1e-4);
  EXPECT_EQ(RestOfCable(world), rest);
  EXPECT_NEAR(world.Motor(0, 0).backlash_m, start - wound(), 1e-12);
  world.Step(1e-3, 1000);
  EXPECT_NEAR(RestOfCable(world) - rest, start - wound() - gap, 1e-12);
  const double back = RestOfCable(world);
  const double turned = wound();
  world.SetDuty(0, 0, 0.05);
  while (wound() - turned < 0.95 * gap) world.Step(1e-4);
  EXPECT_NEAR(RestOfCable(world), back, 1e-5);  // it took time to stop
  world.Step(1e-3, 2000);
  EXPECT_NEAR(100 - RestOfCable(world), wound(), 1e-12);
  EXPECT_EQ(world.Motor(0, 0).backlash_m, 0);
}

TEST(MotorBacklash, AWeightKeepsTheFlanksTogether) {
  DcMotorDef motor, exact;
  motor.backlash_rad = 0.1;
  WorldBatch loose = MakeBatch(MotorWithWeight(motor, Weight(2, 3000, 10)));
  WorldBatch tight = MakeBatch(MotorWithWeight(exact, Weight(2, 3000, 10)));
  for (WorldBatch* world : {&loose, &tight}) {
    world->SetRestLengthTarget(0, 0, 0.95);
    world->Step(1e-3, 1500);
    world->SetRestLengthTarget(0, 0, 1.02);
    world->Step(1e-3, 1500);
  }
  EXPECT_NEAR(RestOfCable(loose), RestOfCable(tight), 1e-12);
  EXPECT_EQ(loose.Motor(0, 0).backlash_m, 0);
}

// Small displacements, without friction: tau e'' + (1 + v D) e' + v P e = 0 with v the speed at
// full duty.
TEST(MotorServo, IsTheLinearLawOfItsGains) {
  DcMotorDef motor = PlainMotor();
  motor.servo_gain_per_m = 3000;
  motor.servo_damping_s_per_m = 2;
  const double k = motor.torque_constant_n_m_per_a;
  const double tau = motor.resistance_ohm * motor.rotor_inertia_kg_m2 / (k * k);
  const double v = Way(motor) * 12 / k;
  const double decay = (1 + v * motor.servo_damping_s_per_m) / (2 * tau);
  const double omega = std::sqrt(v * motor.servo_gain_per_m / tau - decay * decay);
  const auto error = [&](double t) {
    return 1e-4 * std::exp(-decay * t) *
           (std::cos(omega * t) + decay / omega * std::sin(omega * t));
  };
  double before = 0;
  for (const double h : {1.0 / 500, 1.0 / 1000, 1.0 / 2000, 1.0 / 4000}) {
    WorldBatch world = MakeBatch(MotorAlone(motor));
    world.SetRestLengthTarget(0, 0, 100 - 1e-4);
    EXPECT_EQ(world.Motor(0, 0).mode, MotorMode::kServo);
    double worst = 0;
    for (int i = 1; i <= StepsIn(0.05, h); ++i) {
      world.Step(h);
      worst = std::max(worst, std::fabs(RestOfCable(world) - (100 - 1e-4) - error(i * h)));
    }
    EXPECT_LT(worst, 1e-5 * (h * 1000) * (h * 1000)) << h;
    if (before > 0) {
      EXPECT_LT(worst, before / 3) << h;
    }
    before = worst;
  }
}

TEST(MotorServo, TakesOverFromADutyAndGivesWayToIt) {
  WorldBatch world = MakeBatch(MotorAlone(DcMotorDef(), 1.5));
  world.SetDuty(0, 0, 0.5);
  world.Step(1e-3, 300);
  EXPECT_LT(RestOfCable(world), 1.495);
  EXPECT_EQ(world.RestLengthTarget(0, 0), 1.5);
  world.SetRestLengthTarget(0, 0, 1.45);
  EXPECT_EQ(world.Motor(0, 0).mode, MotorMode::kServo);
  world.Step(1e-3, 1500);
  EXPECT_NEAR(RestOfCable(world), 1.45, 5e-6);
  EXPECT_LT(std::fabs(world.Motor(0, 0).duty), 0.05);
  world.SetMotorEnabled(0, 0, false);
  world.SetRestLengthTarget(0, 0, 1.4);
  EXPECT_EQ(world.Motor(0, 0).mode, MotorMode::kOff);
  world.Step(1e-3, 1000);
  EXPECT_NEAR(RestOfCable(world), 1.45, 5e-6);
  world.SetMotorEnabled(0, 0, true);
  world.Step(1e-3, 2000);
  EXPECT_NEAR(RestOfCable(world), 1.4, 5e-6);
}

TEST(MotorServo, StopsAtTheShortestRestLength) {
  ModelDef def = MotorAlone(DcMotorDef(), 1.0, 500);
  def.cables[0].attachments[1].position_m = {0.2, 0, 0};
  def.cables[0].actuator.min_rest_length_m = 0.15;
  WorldBatch world = MakeBatch(def);
  world.SetDuty(0, 0, 1);
  world.Step(1e-3, 30'000);
  EXPECT_NEAR(RestOfCable(world), 0.15, 1e-12);
  EXPECT_GE(RestOfCable(world), 0.15 - 1e-12);
  EXPECT_EQ(world.Motor(0, 0).rotor_speed_rad_per_s, 0);
  world.SetDuty(0, 0, -1);
  world.Step(1e-3, 1000);
  EXPECT_GT(RestOfCable(world), 0.2);
}

TEST(Motor, ADutyBeyondItsEndsCountsAsTheEndAndNotANumberHaltsTheWorld) {
  WorldBatch world = MakeBatch(MotorAlone(DcMotorDef()));
  world.SetDuty(0, 0, 7);
  world.Step(1e-3);
  EXPECT_EQ(world.Motor(0, 0).duty, 1);
  world.SetDuty(0, 0, -INFINITY);
  world.Step(1e-3);
  EXPECT_EQ(world.Motor(0, 0).duty, -1);
  const double rest = RestOfCable(world);
  world.SetDuty(0, 0, NAN);
  world.Step(1e-3, 10);
  EXPECT_EQ(world.Status(0).bits & kStatusNonFinite, kStatusNonFinite);
  EXPECT_EQ(RestOfCable(world), rest);
  EXPECT_EQ(world.Motor(0, 0).duty, -1);  // unchanged
}

// A motor starts at rest at the given rest length, with the corresponding angle.
TEST(Motor, IsPutSomewhereByItsRestLength) {
  const DcMotorDef motor;
  WorldBatch world = MakeBatch(MotorAlone(motor, 1.5));
  EXPECT_EQ(world.Motor(0, 0).rotor_angle_rad, 0);
  world.SetDuty(0, 0, 1);
  world.Step(1e-3, 100);
  world.SetRestLength(0, 0, 1.2);
  EXPECT_EQ(world.Motor(0, 0).rotor_speed_rad_per_s, 0);
  EXPECT_NEAR(world.Motor(0, 0).rotor_angle_rad, 0.3 / Way(motor), 1e-9);
}

/// Returns the final state of one second of lifting and lowering, by the servo and by duties.
std::vector<double> EndOfARun(double h, double stiffness, double damping, double gear_ratio,
                              bool* finite = nullptr) {
  DcMotorDef motor;
  motor.gear_ratio = gear_ratio;
  motor.supply_resistance_ohm = 0.3;
  WorldBatch world = MakeBatch(MotorWithWeight(motor, Weight(0.8, stiffness, damping)));
  const double fastest = Way(motor) * 12 / motor.torque_constant_n_m_per_a;
  // Tension peak of catching a weight that falls by some millimeters, or at the motor's highest
  // speed.
  const double jerk = 3 * (fastest + 0.3) * std::sqrt(0.8 * stiffness);
  double most = 0;
  for (int i = 0; i < StepsIn(1.0, h); ++i) {
    const double t = i * h;
    if (t < 0.4) {
      world.SetRestLengthTarget(0, 0, t < 0.2 - 1e-9 ? 0.995 : 1.005);
    } else {
      world.SetDuty(0, 0, t < 0.6 - 1e-9 ? 0.5 : 0.1);
    }
    world.Step(h);
    most = std::max(most, world.Cable(0, 0).tension_n);
  }
  if (finite != nullptr) *finite = world.Status(0).bits == kStatusOk && most < 100 + jerk;
  const MotorState m = world.Motor(0, 0);
  return {RestOfCable(world), world.Body(0, 0).position_m.z, 1e-3 * m.rotor_speed_rad_per_s,
          m.energy_from_supply_j};
}

// The error shrinks at least in proportion to the step. Stops and starts within a step and the
// servo's saturation are of first order, all else of second.
TEST(MotorStep, ConvergesWithTheStep) {
  for (const double stiffness : {227.0, 1e4, 1e5}) {
    const double damping = 0.4 * std::sqrt(stiffness * 0.8);
    const std::vector<double> exact = EndOfARun(1.0 / 64'000, stiffness, damping, 76);
    for (const double h : {1.0 / 500, 1.0 / 1000, 1.0 / 2000, 1.0 / 4000, 1.0 / 8000}) {
      const std::vector<double> now = EndOfARun(h, stiffness, damping, 76);
      double worst = 0;
      for (std::size_t i = 0; i < now.size(); ++i) {
        worst = std::max(worst, std::fabs(now[i] - exact[i]));
      }
      EXPECT_LT(worst, 0.7 * h) << stiffness << " " << h;
    }
  }
}

// For any spring, gear and step up to 4 ms: heavy rotors behind a gear and light ones without.
TEST(MotorStep, NothingBlowsUp) {
  for (const double stiffness : {227.0, 1e4, 1e5, 1e6, 1e7}) {
    for (const double gear_ratio : {76.0, 20.0, 5.0, 1.0}) {
      for (const double h : {1e-3, 2e-3, 4e-3}) {
        bool finite = false;
        EndOfARun(h, stiffness, 0.1 * std::sqrt(stiffness * 0.8), gear_ratio, &finite);
        EXPECT_TRUE(finite) << stiffness << " N/m, gear " << gear_ratio << ", step " << h;
        EndOfARun(h, stiffness, 0, gear_ratio, &finite);
        EXPECT_TRUE(finite) << stiffness << " N/m, undamped, gear " << gear_ratio << ", step " << h;
      }
    }
  }
}

}  // namespace
}  // namespace taut::test
