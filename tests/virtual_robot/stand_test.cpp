// The stand that carries the robot until its boards hold it
#include "apps/virtual_robot/stand.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "apps/virtual_robot/load_host.h"
#include "taut/spec.h"

namespace taut::virtual_robot {
namespace {

TEST(Stand, HoldsTheRobotUntilItsBoardsDoAndNeverAgain) {
  Diagnostics found;
  const auto spine = LoadRobot(TAUT_SOURCE_DIR "/share/models/tetraspine3_motors.yaml", {}, found);
  ASSERT_TRUE(spine) << found.Format();
  const auto plant = MotorPlant::Make(*spine, found);
  ASSERT_TRUE(plant) << found.Format();
  RobotOptions options;
  options.program = ReadAvrProgram(TAUT_FIRMWARE_ELF, found);
  ASSERT_TRUE(found.ok()) << found.Format();
  options.faults = {{.kind = FaultKind::kMotorSupplyLoss, .at_s = 1.0}};
  std::vector<Time> let_go;
  options.log = [&](Time at, std::string_view who, std::string_view what) {
    if (who == "stand" && what.starts_with("released")) let_go.push_back(at);
  };
  Robot robot(*plant, options);
  Stand stand(*plant, robot, options.log);
  Time all_driven = -1;
  robot.after_plant_step = [&](Time now) {
    bool all = true;
    for (int motor = 0; motor < plant->motor_count(); ++motor) all &= robot.Drive(motor).enabled;
    if (all && all_driven < 0) all_driven = now;
    stand.Step(now);
  };
  const double force_n = plant->LoadCellForce(2);
  const double height_m = plant->batch().Body(0, 0).position_m.z;
  robot.AdvanceTo(400 * kMillisecond);
  EXPECT_TRUE(plant->held());
  EXPECT_LT(all_driven, 0);
  EXPECT_GT(force_n, 1.0);
  EXPECT_EQ(plant->LoadCellForce(2), force_n) << "what it feels at the start";
  EXPECT_EQ(plant->RotorAngle(2), 0.0);
  EXPECT_EQ(plant->batch().Body(0, 0).position_m.z, height_m);

  LoadHost host(robot);
  ASSERT_TRUE(host.Start());
  while (robot.now() < 900 * kMillisecond) host.Cycle();
  EXPECT_FALSE(plant->held());
  EXPECT_GT(all_driven, 0);
  ASSERT_EQ(let_go.size(), 1U);
  EXPECT_EQ(let_go[0] - all_driven, Stand::kDrivenFor);
  EXPECT_NE(plant->batch().Body(0, 0).position_m.z, height_m);

  while (robot.now() < 1100 * kMillisecond) host.Cycle();
  EXPECT_FALSE(robot.Drive(0).enabled) << "the motors have lost their supply";
  EXPECT_FALSE(plant->held());
  EXPECT_EQ(let_go.size(), 1U);
}

}  // namespace
}  // namespace taut::virtual_robot
