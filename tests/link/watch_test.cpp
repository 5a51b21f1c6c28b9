// Warnings of the PC about cables that boards do not report as faults.
#include "link/fake_robot.h"

namespace taut::link {
namespace {

using board::Mode;

TEST(ACableWithoutTension, IsTold) {
  Rig rig;
  rig.Run(Mode::kHold);
  rig.driver->Cycle(30);
  EXPECT_TRUE(rig.events.empty()) << rig.Events();
  rig.board(2).motors[1].cut = true;
  const double cut_s = rig.robot.now_s();
  rig.driver->Cycle(40);
  ASSERT_EQ(rig.Heard("motor 5 is slack"), 1) << rig.Events();
  EXPECT_LT(rig.events.back().first - cut_s, 0.25);
  EXPECT_EQ(rig.events.size(), 1u) << rig.Events();
  rig.board(2).motors[1].cut = false;
  rig.driver->Cycle(10);
  EXPECT_EQ(rig.Heard("motor 5 is taut again"), 1) << rig.Events();
}

TEST(ACableWithoutTension, OfAMotorWithoutPowerIsNoNews) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.board(2).motors[1].cut = true;
  rig.driver->Cycle(50);
  EXPECT_EQ(rig.Heard("slack"), 0) << rig.Events();
}

// At rest a reading may be constant for long.
TEST(ALoadCellThatStands, IsToldOnceItsMotorHasMoved) {
  Rig rig;
  rig.Run(Mode::kPosition);
  rig.board(3).motors[0].adc_stuck = 120;
  rig.driver->Cycle(100);
  EXPECT_EQ(rig.Heard("does not change"), 0) << rig.Events();
  rig.driver->SetValue(6, 0.19);
  rig.driver->SetValue(7, 0.19);
  rig.driver->Cycle(60);
  EXPECT_EQ(rig.Heard("motor 6: its load cell reading does not change"), 1) << rig.Events();
  EXPECT_EQ(rig.Heard("does not change"), 1) << rig.Events();
}

// Two readings that are equal by chance, with a gap between them.
TEST(ALoadCellThatStands, IsNotOneReadingTwice) {
  Rig rig;
  rig.Run(Mode::kPosition);
  board::BenchMotor& motor = rig.board(3).motors[0];
  for (int i = 0; i < 40; ++i) {
    if (i % 4 == 0) motor.adc_stuck = 100 + i;  // the filter settles within a cycle or two
    if (i % 4 == 2) motor.wound_m += i % 8 == 2 ? 0.005 : -0.005;
    rig.driver->Cycle(1);
  }
  EXPECT_EQ(rig.Heard("does not change"), 0) << rig.Events();
}

}  // namespace
}  // namespace taut::link
