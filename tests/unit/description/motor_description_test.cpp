// Motors in files: values of keys, errors, writing and reading back
#include <cmath>

#include "taut/start.h"
#include "taut/world_batch.h"
#include "unit/description/experiment_fixture.h"
#include "unit/description/model_fixture.h"

namespace taut::test {
namespace {

DcMotorDef MotorOf(const std::string& yaml) {
  const RobotSpec robot = Good(yaml);
  const ActuatorDef& actuator = robot.def.cables.at(0).actuator;
  EXPECT_EQ(actuator.kind, ActuatorDef::Kind::kDcMotor);
  return actuator.dc_motor.value_or(DcMotorDef{});
}

TEST(MotorKeys, AreTheDefaultsUnlessSaidOtherwise) {
  EXPECT_EQ(MotorOf(TwoRods("rest_length_m: 0.05, actuator: {dc_motor: {}}")), DcMotorDef());
  DcMotorDef other;
  other.gear_ratio = 43;
  other.supply = "left";
  other.servo_gain_per_m = 100;
  EXPECT_EQ(MotorOf(TwoRods("rest_length_m: 0.05, actuator: {dc_motor: {gear_ratio: 86 / 2, "
                            "supply: left, servo_gain_per_m: 100}, min_rest_length_m: 0.01}")),
            other);
}

// Also with a base file; cables without an actuator stay without.
TEST(MotorKeys, OfTheModelReplaceTheActuatorsOfItsBuilders) {
  const std::string motor = "actuator: {min_rest_length_m: 0.02, dc_motor: {gear_ratio: 43}}\n";
  const ActuatorDef limited =
      Good(TwoRods("rest_length_m: 0.05, actuator: {max_force_n: 5}", motor))
          .def.cables[0]
          .actuator;
  ASSERT_EQ(limited.kind, ActuatorDef::Kind::kDcMotor);
  EXPECT_EQ(limited.dc_motor->gear_ratio, 43);
  EXPECT_EQ(limited.min_rest_length_m, 0.02);
  EXPECT_EQ(Good(TwoRods("rest_length_m: 0.05", motor)).def.cables[0].actuator.kind,
            ActuatorDef::Kind::kNone);
}

TEST(MotorErrors, LimitsAreNotBesideAMotor) {
  EXPECT_EQ(Errors(TwoRods("rest_length_m: 0.05, actuator: {dc_motor: {}, max_force_n: 3, "
                           "ideal: true}")),
            "robot.yaml:11:98: error: cable.actuator has both dc_motor and max_force_n (with a "
            "dc_motor only min_rest_length_m is allowed)\n"
            "robot.yaml:11:114: error: cable.actuator has both dc_motor and ideal (with a dc_motor "
            "only min_rest_length_m is allowed)\n");
  EXPECT_EQ(Errors(TwoRods("rest_length_m: 0.05, actuator: {}")),
            "robot.yaml:11:83: error: cable.actuator needs limits, a `dc_motor`, or `ideal: true` "
            "(leave out the actuator for a fixed rest length)\n");
}

TEST(MotorErrors, AllFiguresAreLookedAt) {
  EXPECT_EQ(
      Errors(TwoRods("rest_length_m: 0.05, actuator: {dc_motor: {resistance_ohm: 0, "
                     "gear_efficiency: 1.2, backlash: 0.1, spool_radius_m: -1}}")),
      "robot.yaml:11:111: error: cable.actuator.dc_motor.resistance_ohm must be positive, "
      "got 0\n"
      "robot.yaml:11:131: error: cable.actuator.dc_motor.gear_efficiency must not be above "
      "1, got 1.2\n"
      "robot.yaml:11:136: error: unknown key \"backlash\" in cable.actuator.dc_motor (did you "
      "mean \"backlash_rad\"?)\n"
      "robot.yaml:11:167: error: cable.actuator.dc_motor.spool_radius_m must be positive, got "
      "-1\n");
  EXPECT_EQ(Errors(TwoRods("rest_length_m: 0.05, actuator: {dc_motor: {friction_torque_n_m: "
                           "0.001}}")),
            "robot.yaml:11:95: error: cable.actuator.dc_motor.static_friction_torque_n_m is "
            "0.00012, below friction_torque_n_m of 0.001 (static friction must be at least the "
            "friction of a turning rotor)\n");
}

TEST(MotorErrors, BuildersOfASupplyAgreeAboutIt) {
  const auto two = [](const std::string& first, const std::string& second) {
    std::string yaml = TwoRods("rest_length_m: 0.05, actuator: {dc_motor: {" + first + "}}");
    yaml.replace(yaml.find("  - {nodes: [a, c], tags: [cable]}\n"), 0,
                 "  - {nodes: [b, d], tags: [other]}\n");
    return yaml +
           "  - {match: other, cable: {stiffness_n_per_m: 100, rest_length_m: 0.05, actuator: "
           "{dc_motor: {" +
           second + "}}}}\n";
  };
  EXPECT_EQ(Errors(two("", "")), "");
  EXPECT_EQ(Errors(two("supply: a, supply_voltage_v: 6", "supply: b, supply_voltage_v: 9")), "");
  EXPECT_EQ(Errors(two("supply_voltage_v: 6", "supply_resistance_ohm: 1")),
            "robot.yaml:13:5: error: a dc_motor's supply \"supply\" differs from the one in the "
            "builder of line 12: 12 V and 1 ohm here, 6 V and 0 ohm there (make them equal, or "
            "give one of them another `supply`)\n");
}

/// Returns the errors of `Model::Compile` for two motors on one supply.
std::string Compiled(const std::function<void(DcMotorDef&)>& change) {
  ModelDef def;
  for (const char* name : {"one", "other"}) {
    CableDef cable;
    cable.name = name;
    cable.attachments = {{kWorld, {0, 0, 0}}, {kWorld, {1, 0, 0}}};
    cable.stiffness_n_per_m = 100;
    cable.rest_length_m = 1;
    cable.actuator.kind = ActuatorDef::Kind::kDcMotor;
    cable.actuator.dc_motor.emplace();
    def.cables.push_back(cable);
  }
  change(*def.cables[1].actuator.dc_motor);
  Diagnostics out;
  const bool good = Model::Compile(def, out) != nullptr;
  EXPECT_EQ(good, out.ok());
  return out.items().empty() ? "" : out.items()[0].what;
}

TEST(MotorErrors, MotorsOfASupplyAgreeAboutIt) {
  EXPECT_EQ(Compiled([](DcMotorDef&) {}), "");
  const std::string differ =
      "cable other: its motor's supply \"supply\" differs from the one at cable one";
  EXPECT_EQ(Compiled([](DcMotorDef& m) { m.supply_voltage_v = 11; }), differ);
  EXPECT_EQ(Compiled([](DcMotorDef& m) { m.supply_resistance_ohm = 1; }), differ);
  EXPECT_EQ(Compiled([](DcMotorDef& m) { m.supply_voltage_v = 11, m.supply = "other"; }), "");
}

TEST(MotorErrors, EveryFigureThatAProgramGivesIsLookedAt) {
  const double bad = std::nan("");
  const std::vector<std::function<void(DcMotorDef&)>> mistakes = {
      [&](DcMotorDef& m) { m.resistance_ohm = bad; },
      [&](DcMotorDef& m) { m.torque_constant_n_m_per_a = 0; },
      [&](DcMotorDef& m) { m.rotor_inertia_kg_m2 = -1; },
      [&](DcMotorDef& m) { m.friction_torque_n_m = bad; },
      [&](DcMotorDef& m) { m.static_friction_torque_n_m = 1e-9; },
      [&](DcMotorDef& m) { m.stribeck_speed_rad_per_s = 0; },
      [&](DcMotorDef& m) { m.viscous_friction_n_m_s_per_rad = -1; },
      [&](DcMotorDef& m) { m.gear_ratio = 0; },
      [&](DcMotorDef& m) { m.gear_efficiency = 0; },
      [&](DcMotorDef& m) { m.gear_efficiency = 1.01; },
      [&](DcMotorDef& m) { m.backlash_rad = -0.1; },
      [&](DcMotorDef& m) { m.spool_radius_m = 0; },
      [&](DcMotorDef& m) { m.driver_resistance_ohm = -1; },
      [&](DcMotorDef& m) { m.supply_voltage_v = 0; },
      [&](DcMotorDef& m) { m.supply_resistance_ohm = bad; },
      [&](DcMotorDef& m) { m.rated_temperature_c = bad; },
      [&](DcMotorDef& m) { m.ambient_temperature_c = bad; },
      [&](DcMotorDef& m) { m.resistance_rise_per_k = -1; },
      [&](DcMotorDef& m) { m.winding_thermal_resistance_k_per_w = 0; },
      [&](DcMotorDef& m) { m.housing_thermal_resistance_k_per_w = 0; },
      [&](DcMotorDef& m) { m.winding_thermal_time_s = 0; },
      [&](DcMotorDef& m) { m.housing_thermal_time_s = 0; },
      [&](DcMotorDef& m) { m.servo_gain_per_m = -1; },
      [&](DcMotorDef& m) { m.servo_damping_s_per_m = bad; },
  };
  for (std::size_t i = 0; i < mistakes.size(); ++i) {
    EXPECT_TRUE(Compiled(mistakes[i]).starts_with("cable other: ")) << i << Compiled(mistakes[i]);
  }
}

class MotorFiles : public ExperimentFolder {
 protected:
  MotorFiles() {
    ChangeFile("model.yaml", kModel, "actuator: {max_speed_m_per_s: 0.1}",
               "actuator: {min_rest_length_m: 0.03, dc_motor: {gear_ratio: 43, backlash_rad: 0.02, "
               "supply: left}}");
  }
};

TEST_F(MotorFiles, AResolvedExperimentHasTheSameMotorsAndSensors) {
  Change("record: {rate_hz: 50}",
         "record: {rate_hz: 50}\n"
         "sensors:\n"
         "  load_cell: {gain_error: 0.01, drift_n_per_s: 0.002, counts: {noise_counts: 0.5}}\n"
         "  encoder: {lines: 16, decoding: 2, gear_ratio: 43, spool_radius_m: 0.003, index: true, "
         "zero_error_m: 0.001, gain_error: 0.02}\n");
  const ExperimentSpec before = Load();
  Write("resolved.yaml", ResolvedYaml(before));
  const ExperimentSpec after = Load("resolved.yaml");
  for (std::size_t c = 0; c < before.robot.def.cables.size(); ++c) {
    const ActuatorDef &x = before.robot.def.cables[c].actuator,
                      &y = after.robot.def.cables[c].actuator;
    EXPECT_EQ(x.kind, y.kind);
    EXPECT_EQ(x.dc_motor, y.dc_motor);
    EXPECT_EQ(x.min_rest_length_m, y.min_rest_length_m);
  }
  EXPECT_EQ(after.robot.def.cables[0].actuator.dc_motor->backlash_rad, 0.02);
  ASSERT_TRUE(after.sensors && after.sensors->load_cell && after.sensors->load_cell->counts);
  const LoadCellSpec& cell = *after.sensors->load_cell;
  EXPECT_EQ(cell.gain_error, 0.01);
  EXPECT_EQ(cell.drift_n_per_s, 0.002);
  EXPECT_EQ(cell.counts->gain_n_per_count, 0.1567);
  EXPECT_EQ(cell.counts->saturation_count, 741);
  EXPECT_EQ(cell.counts->noise_counts, 0.5);
  const double turn_m = 2 * 3.141592653589793 * 0.003 / 43;
  EXPECT_NEAR(after.sensors->encoder->quantum_m, turn_m / 32, 1e-15);
  EXPECT_NEAR(after.sensors->encoder->index_m, turn_m, 1e-15);
  EXPECT_EQ(after.sensors->encoder->zero_error_m, 0.001);
  EXPECT_EQ(after.sensors->encoder->gain_error, 0.02);
}

TEST_F(MotorFiles, AWrittenModelHasTheSameMotors) {
  const RobotSpec robot = Load().robot;
  Diagnostics out;
  const auto text = ModelYaml(robot, "A robot.", out);
  ASSERT_TRUE(text) << out.Format();
  Write("written.yaml", *text);
  const auto back = LoadRobot(Path("written.yaml"), {}, out);
  ASSERT_TRUE(back) << out.Format();
  EXPECT_EQ(back->def.cables[0].actuator.dc_motor, robot.def.cables[0].actuator.dc_motor);
  EXPECT_EQ(back->def.cables[0].actuator.min_rest_length_m, 0.03);
}

class SensorErrors : public ExperimentErrors {
 protected:
  void ExpectOf(const std::string& sensors, const std::string& expected) {
    Expect("record: {rate_hz: 50}", "record: {rate_hz: 50}\nsensors: {" + sensors + "}", expected);
  }
};

TEST_F(SensorErrors, CountsHaveARangeOfTheirOwn) {
  ExpectOf(
      "load_cell: {counts: {bits: 40}, range_n: [0, 5], quantum_n: 1}",
      "22:38: error: sensors.load_cell.counts.bits must be a whole number within 1..32, got 40\n"
      "22:43: error: sensors.load_cell has both counts and range_n (`counts` already defines the "
      "range and the bits)\n"
      "22:60: error: sensors.load_cell has both counts and quantum_n (`counts` already defines the "
      "range and the bits)");
}

TEST_F(SensorErrors, EncodersOfShaftsHaveLines) {
  ExpectOf("encoder: {decoding: 2, index: true}",
           "22:21: error: sensors.encoder.decoding needs the key \"lines\" as well (it describes "
           "an encoder on the motor's shaft)\n"
           "22:34: error: sensors.encoder.index needs the key \"lines\" as well (it describes an "
           "encoder on the motor's shaft)");
  ExpectOf("encoder: {lines: 16, decoding: 3, spool_radius_m: 0.005, quantum_m: 1}",
           "22:32: error: sensors.encoder.decoding must be 1, 2 or 4, got 3 (1: one edge per line, "
           "2: both edges of one channel, 4: both edges of both channels)\n"
           "22:68: error: sensors.encoder has both quantum_m and lines (give only one of them: it "
           "determines the other)");
  ExpectOf("encoder: {lines: 16}",
           "22:20: error: sensors.encoder needs the key \"spool_radius_m\"");
}

}  // namespace
}  // namespace taut::test
