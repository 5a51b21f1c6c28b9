// Power on and off: two steps to arm, one to disarm, and the commands to motors in between.
#include "link/fake_robot.h"

namespace taut::link {
namespace {

using board::Mode;

TEST(Arming, TakesTwoSteps) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  EXPECT_FALSE(rig.driver->Go(Mode::kHold)) << "never armed";
  rig.driver->Cycle(2);
  rig.driver->Arm();
  EXPECT_EQ(rig.state().stage, Stage::kReady);
  rig.driver->Cycle(2);
  EXPECT_FALSE(rig.robot.AnyPower());
  EXPECT_EQ(rig.robot.Broadcasts().back().arm, board::Arm::kReady);
  EXPECT_EQ(rig.robot.Broadcasts().back().mode, Mode::kOff);
  ASSERT_TRUE(rig.driver->Go(Mode::kHold));
  EXPECT_EQ(rig.state().stage, Stage::kActive);
  rig.driver->Cycle(2);
  EXPECT_TRUE(rig.robot.AnyPower());
  rig.ExpectAll(Mode::kHold);
  EXPECT_EQ(rig.robot.Broadcasts().back().arm, board::Arm::kGo);
}

TEST(Arming, IsRefusedWhileABoardIsNotWell) {
  const std::pair<const char*, std::function<void(Rig&)>> ills[] = {
      {"faults latched", [](Rig& rig) { rig.board(3).core.faults[1] = board::kStall; }},
      {"timed out", [](Rig& rig) { rig.board(3).core.timeout = true; }},
      {"stopped", [](Rig& rig) { rig.board(3).core.stopped = true; }},
      {"board 3 does not answer", [](Rig& rig) {
         rig.board(3).there = false;
         rig.driver->Cycle(3);
       }}};
  for (const auto& [said, ill] : ills) {
    Rig rig;
    ASSERT_TRUE(rig.Configure());
    rig.driver->Cycle(2);
    ill(rig);
    EXPECT_FALSE(rig.driver->Enable(Mode::kHold, false, rig.out)) << said;
    const std::string text = rig.out.Format();
    EXPECT_NE(text.find("board 3"), std::string::npos) << text;
    EXPECT_NE(text.find(said), std::string::npos) << text;
    EXPECT_EQ(text.find("board 2"), std::string::npos) << text;
    EXPECT_FALSE(rig.robot.AnyPower()) << said;
    EXPECT_EQ(rig.state().stage, Stage::kInactive);
  }
}

TEST(Enable, GivesPowerAndThenTheMode) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  rig.ExpectAll(Mode::kImpedance);
  std::vector<Mode> modes;
  for (const board::Cyclic& said : rig.robot.Broadcasts()) {
    if (modes.empty() || modes.back() != said.mode) modes.push_back(said.mode);
  }
  EXPECT_EQ(modes, (std::vector<Mode>{Mode::kOff, Mode::kHold, Mode::kImpedance}));
}

TEST(Enable, SaysWhoDoesNotObeyAndTurnsAllOff) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());  // but not referenced
  rig.driver->ClearFaults();
  rig.driver->Cycle(2);
  EXPECT_FALSE(rig.driver->Enable(Mode::kImpedance, false, rig.out));
  EXPECT_NE(rig.out.Format().find("board 4"), std::string::npos) << rig.out.Format();
  EXPECT_FALSE(rig.robot.AnyPower());
  EXPECT_EQ(rig.state().stage, Stage::kInactive);
  EXPECT_EQ(rig.Heard("board 4: unreferenced"), 1) << rig.Events();
}

TEST(Enable, CapturesWhatIsMeasured) {
  Rig rig;
  rig.Run(Mode::kImpedance, true);
  EXPECT_NEAR(rig.board(2).core.parameters.motor[1][board::kTensionOffset], 11.35, 0.2);
}

// Default values must not move a robot: a rest length of 0 m would wind in all cables.
TEST(Enable, APositionThatNobodyNamedIsWhereTheMotorIs) {
  Rig rig;
  rig.Run(Mode::kPosition);
  rig.driver->Cycle(50);
  for (const MotorView& motor : rig.state().motors) EXPECT_NEAR(motor.rest_length_m, 0.2, 1e-3);
  rig.driver->SetValue(4, std::numeric_limits<double>::quiet_NaN());
  rig.driver->Cycle(20);
  EXPECT_NEAR(rig.state().motors[4].rest_length_m, 0.2, 1e-3);
}

TEST(Values, ArePositionsInCounts) {
  Rig rig;
  rig.Run(Mode::kPosition);
  rig.driver->SetValue(0, 0.19);
  rig.driver->SetValue(11, 0.21);
  rig.driver->SetValue(5, -5);
  rig.driver->SetValue(6, 5);
  rig.driver->Cycle(1);
  const board::Cyclic said = rig.robot.Broadcasts().back();
  EXPECT_EQ(said.values[0], 746);  // 0.01 m / 1.34e-5 m, winding in positive
  EXPECT_EQ(said.values[11], -746);
  EXPECT_EQ(said.values[5], 32767) << "what the wire cannot hold is cut off";
  EXPECT_EQ(said.values[6], -32767);
}

TEST(Values, AreSpeedsOfImpedanceControlAndDuties) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  rig.driver->SetValue(0, 0.01);
  rig.driver->SetValue(7, -0.02);
  rig.driver->SetValue(8, std::numeric_limits<double>::infinity());
  rig.driver->Cycle(1);
  EXPECT_EQ(rig.robot.Broadcasts().back().values[0], 500);
  EXPECT_EQ(rig.robot.Broadcasts().back().values[7], -1000);
  EXPECT_EQ(rig.robot.Broadcasts().back().values[8], 0);
  EXPECT_NEAR(rig.board(0).core.loops[0].velocity_input_m_per_s, 0.01, 1e-6);
  rig.driver->Off();
  rig.driver->Cycle(2);
  ASSERT_TRUE(rig.driver->Enable(Mode::kDuty, false, rig.out)) << rig.out.Format();
  rig.driver->SetValue(3, -0.25);
  rig.driver->Cycle(2);
  EXPECT_EQ(rig.robot.Broadcasts().back().values[3], -8192);
  EXPECT_EQ(rig.robot.Broadcasts().back().values[0], 0) << "off forgets values";
  EXPECT_NEAR(rig.state().motors[3].duty, -0.25, 0.01);
}

TEST(Off, TakesPowerWithTheNextBroadcast) {
  Rig rig;
  rig.Run(Mode::kHold);
  rig.driver->Off();
  rig.driver->Cycle(1);
  rig.robot.Wait(rig.robot.now_s() + 0.002);
  EXPECT_FALSE(rig.robot.AnyPower());
  EXPECT_EQ(rig.state().stage, Stage::kInactive);
  EXPECT_FALSE(rig.driver->Go(Mode::kHold)) << "to be armed anew";
}

TEST(Stop, IsSentThriceAndThenEveryCycleUntilItIsCleared) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  const std::size_t from = rig.robot.frames.size();
  rig.driver->Stop("a test");
  EXPECT_TRUE(rig.state().stopping);
  rig.driver->Cycle(1);
  for (std::size_t i = from; i < from + 3; ++i) {
    EXPECT_TRUE(FakeRobot::IsStopFrame(rig.robot.frames[i].second)) << i - from;
  }
  EXPECT_FALSE(FakeRobot::IsStopFrame(rig.robot.frames[from + 3].second));
  EXPECT_FALSE(rig.robot.AnyPower());
  EXPECT_EQ(rig.Heard("emergency stop: a test"), 1);
  const auto stops_of = [&](int cycles) {
    const std::size_t begin = rig.robot.frames.size();
    rig.driver->Cycle(cycles);
    return std::count_if(rig.robot.frames.begin() + static_cast<std::ptrdiff_t>(begin),
                         rig.robot.frames.end(),
                         [](const auto& frame) { return FakeRobot::IsStopFrame(frame.second); });
  };
  EXPECT_EQ(stops_of(10), 10);
  rig.ExpectAll(Mode::kStopped);
  EXPECT_FALSE(rig.driver->Enable(Mode::kHold, false, rig.out));
  EXPECT_NE(rig.out.Format().find("an emergency stop has not been cleared"), std::string::npos);
  EXPECT_FALSE(rig.robot.AnyPower());
  rig.driver->ClearFaults();
  EXPECT_EQ(stops_of(3), 0);
  rig.ExpectAll(Mode::kOff);
  rig.out = {};
  EXPECT_TRUE(rig.driver->Enable(Mode::kHold, false, rig.out)) << rig.out.Format();
}

TEST(Stop, ForbidsPowerBeforeBoardsKnowOfIt) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.driver->Cycle(2);
  rig.driver->Stop("a test");
  rig.driver->Arm();
  EXPECT_FALSE(rig.driver->Go(Mode::kHold));
  rig.driver->Cycle(3);
  EXPECT_FALSE(rig.robot.AnyPower());
}

TEST(ClearFaults, IsSaidOnce) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.driver->Cycle(2);
  rig.board(2).core.faults[0] = board::kHot;
  rig.driver->Cycle(3);
  EXPECT_TRUE(rig.state().boards[2].status.faulty);
  EXPECT_EQ(rig.state().motors[4].faults, board::kHot);
  const std::size_t from = rig.robot.frames.size();
  rig.driver->ClearFaults();
  rig.driver->Cycle(3);
  const auto said = rig.robot.Broadcasts(from);
  EXPECT_TRUE(said[0].clear_faults);
  EXPECT_FALSE(said[1].clear_faults);
  EXPECT_FALSE(rig.state().boards[2].status.faulty);
  EXPECT_FALSE(rig.state().boards[2].status.was_reset);
  EXPECT_EQ(rig.state().motors[4].faults, 0) << "what is cleared is not shown any more";
}

TEST(ClearFaults, KeepsMotorsThatHold) {
  Rig rig;
  rig.Run(Mode::kHold);
  rig.driver->ClearFaults();
  rig.driver->Cycle(3);
  rig.ExpectAll(Mode::kHold);
  EXPECT_EQ(rig.state().stage, Stage::kActive);
}

TEST(TheEndOfADriver, StopsMotorsThatHavePower) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  bool called = false;
  rig.driver->on_cycle = [&](const State&) { called = true; };
  const std::size_t from = rig.robot.frames.size();
  rig.driver.reset();
  EXPECT_FALSE(rig.robot.AnyPower());
  EXPECT_TRUE(FakeRobot::IsStopFrame(rig.robot.frames[from + 2].second));
  EXPECT_FALSE(called) << "who listened may be gone";
  Rig quiet;
  ASSERT_TRUE(quiet.Configure());
  quiet.driver->Cycle(2);
  const std::size_t frames = quiet.robot.frames.size();
  quiet.driver.reset();
  EXPECT_EQ(quiet.robot.frames.size(), frames) << "nothing had power";
}

TEST(TheEndOfADriver, ComesWithoutAnAdapterToo) {
  Rig pulled;
  pulled.Run(Mode::kHold);
  pulled.robot.gone = true;
  pulled.driver->Cycle(2);
  pulled.driver.reset();
  Rig mute;  // the adapter is plugged in again, but sends nothing
  mute.Run(Mode::kHold);
  mute.robot.gone = true;
  mute.driver->RunUntil(mute.robot.now_s() + 0.1);
  mute.robot.gone = false;
  mute.robot.swallow = [](const Bytes&) { return true; };
  mute.driver->RunUntil(mute.robot.now_s() + 0.5);
  mute.driver.reset();
}

}  // namespace
}  // namespace taut::link
