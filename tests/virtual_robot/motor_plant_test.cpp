// taut's motors as the plant, and the whole robot with the firmware's protocol
#include "apps/virtual_robot/motor_plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "apps/virtual_robot/load_host.h"
#include "taut/spec.h"
#include "tests/virtual_robot/probe_fixture.h"

namespace taut::virtual_robot {
namespace {

/// Returns Tetraspine3 with motor-driven cables, in the air.
RobotSpec MotorSpine() {
  Diagnostics found;
  auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/tetraspine3.yaml", {}, found);
  EXPECT_TRUE(robot) << found.Format();
  for (CableDef& cable : robot->def.cables) {
    cable.actuator = {};
    cable.actuator.kind = ActuatorDef::Kind::kDcMotor;
    cable.actuator.dc_motor = DcMotorDef{};
  }
  robot->def.gravity_m_per_s2 = {};
  return *robot;
}

std::unique_ptr<MotorPlant> Make(const RobotSpec& robot) {
  Diagnostics found;
  auto plant = MotorPlant::Make(robot, found);
  EXPECT_TRUE(plant) << found.Format();
  return plant;
}

void Turn(MotorPlant& plant, double seconds, const std::vector<MotorDrive>& drives) {
  for (int i = 0; i < seconds / 1e-4; ++i) plant.Advance(1e-4, drives);
}

TEST(MotorPlant, HasAMotorACableInTheModelsOrder) {
  const auto plant = Make(MotorSpine());
  ASSERT_EQ(plant->motor_count(), 12);
  for (int motor = 0; motor < 12; ++motor) {
    EXPECT_EQ(plant->cable(motor), motor);
    EXPECT_EQ(plant->cable_names()[static_cast<std::size_t>(motor)],
              plant->batch().model().def().cables[static_cast<std::size_t>(motor)].name);
    EXPECT_EQ(plant->RotorAngle(motor), 0.0);
  }
}

TEST(MotorPlant, AMotorWithoutLoadRunsAsItsDataSheetSays) {
  const auto plant = Make(MotorSpine());
  plant->CutCable(3);
  EXPECT_EQ(plant->LoadCellForce(3), 0.0);
  std::vector<MotorDrive> drives(12);
  for (const double duty : {0.8, -0.4}) {
    drives[3] = {duty, true};
    Turn(*plant, 0.3, drives);
    const double before = plant->RotorAngle(3);
    Turn(*plant, 0.1, drives);
    // U = k w + R i at the current needed for friction. A cut cable exerts no force.
    const DcMotorDef motor;
    const double k = motor.torque_constant_n_m_per_a;
    const double lost =
        (motor.resistance_ohm + motor.driver_resistance_ohm) * motor.friction_torque_n_m / k;
    const double expected = (std::abs(duty) * motor.supply_voltage_v - lost) / k;
    EXPECT_NEAR((plant->RotorAngle(3) - before) / 0.1, duty > 0 ? expected : -expected,
                0.02 * expected);
  }
}

TEST(MotorPlant, WindingInShortensAndTightensTheCable) {
  const auto force = [](double duty) {
    const auto plant = Make(MotorSpine());
    const double before_m = plant->batch().Cable(0, 0).rest_length_m;
    std::vector<MotorDrive> drives(12, MotorDrive{0.0, true});  // brakes
    drives[0].duty = duty;
    Turn(*plant, 0.05, drives);
    EXPECT_EQ(plant->RotorAngle(0) > 0, duty > 0);
    const DcMotorDef motor;
    const double wound_m = motor.spool_radius_m / motor.gear_ratio * plant->RotorAngle(0);
    EXPECT_NEAR(plant->batch().Cable(0, 0).rest_length_m, before_m - wound_m, 1e-12);
    EXPECT_GT(std::abs(wound_m), 1e-3);
    return plant->LoadCellForce(0);
  };
  EXPECT_GT(force(0.8), force(-0.8) + 0.1);
}

TEST(MotorPlant, RefusesWhatBoardsCannotDrive) {
  const auto complaints = [](const RobotSpec& robot) {
    Diagnostics found;
    EXPECT_EQ(MotorPlant::Make(robot, found), nullptr);
    return found.Format();
  };
  RobotSpec robot = MotorSpine();
  robot.def.cables[4].actuator.kind = ActuatorDef::Kind::kIdeal;
  robot.def.cables[4].actuator.dc_motor.reset();
  robot.def.cables[7].actuator = robot.def.cables[4].actuator;
  const std::string two = complaints(robot);
  EXPECT_NE(two.find("the actuator of cable " + robot.def.cables[4].name + " is not a motor"),
            std::string::npos);
  EXPECT_NE(two.find("cable " + robot.def.cables[7].name), std::string::npos) << "all at once";
  for (CableDef& cable : robot.def.cables) cable.actuator = {};
  EXPECT_NE(complaints(robot).find("no cable has a motor"), std::string::npos);
  Diagnostics found;
  auto lengthy = LoadRobot(TAUT_SOURCE_DIR "/share/models/tetraspine12.yaml", {}, found);
  ASSERT_TRUE(lengthy);
  for (CableDef& cable : lengthy->def.cables) cable.actuator = MotorSpine().def.cables[0].actuator;
  EXPECT_NE(complaints(*lengthy).find("66 cables have a motor"), std::string::npos);
}

TEST(LoadHost, KeepsBoardsInImpedanceControl) {
  Diagnostics found;
  const auto program = ReadAvrProgram(TAUT_FIRMWARE_ELF, found);
  ASSERT_TRUE(program) << found.Format();
  const auto plant = Make(MotorSpine());
  Robot robot(*plant, {.program = program});
  LoadHost host(robot);
  ASSERT_TRUE(host.Start());
  for (int i = 0; i < 20; ++i) host.Cycle();
  constexpr int kImpedance = 3;  // mode in the frame's second byte
  for (int board = 0; board < 6; ++board) {
    const auto address = static_cast<std::uint8_t>((0x10 + board) << 1 | 1);
    const auto frame = robot.Transfer(Bytes{0x54, address, 16});
    ASSERT_TRUE(frame && frame->size() == 16);
    EXPECT_EQ((*frame)[1] & 7, kImpedance) << board;
    EXPECT_TRUE(robot.Drive(2 * board).enabled);
  }
  EXPECT_LT(host.longest_cycle_s(), 0.01);
}

}  // namespace
}  // namespace taut::virtual_robot
