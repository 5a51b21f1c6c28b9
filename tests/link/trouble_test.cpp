// Faults between PC and boards, and on boards, and the reaction of all motors.
#include "link/fake_robot.h"

namespace taut::link {
namespace {

using board::Mode;

bool IsBroadcast(const Bytes& frame) { return frame.size() == 32 && frame[1] == 0; }

TEST(ALostBoard, StopsAllAndItsReturnIsTold) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  rig.board(4).there = false;
  rig.driver->Cycle(2);
  EXPECT_FALSE(rig.state().stopping) << "two cycles are a moment";
  rig.driver->Cycle(2);
  EXPECT_TRUE(rig.state().stopping);
  EXPECT_FALSE(rig.robot.AnyPower());
  EXPECT_EQ(rig.Heard("emergency stop: board 4 does not answer"), 1) << rig.Events();
  EXPECT_NE(rig.state().stage, Stage::kActive);
  rig.board(4).there = true;
  rig.driver->Cycle(12);
  EXPECT_EQ(rig.Heard("board 4 answers again"), 1) << rig.Events();
  EXPECT_TRUE(rig.state().boards[4].there);
  rig.driver->ClearFaults();
  rig.driver->Cycle(3);
  EXPECT_TRUE(rig.driver->Enable(Mode::kImpedance, false, rig.out)) << rig.out.Format();
}

TEST(ALostBoard, OfARobotAtRestIsToldAndNoMore) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.board(0).there = false;
  rig.driver->Cycle(5);
  EXPECT_EQ(rig.Heard("board 0 does not answer"), 1);
  EXPECT_FALSE(rig.state().stopping);
}

TEST(ADeafBoard, IsNoticed) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  rig.board(5).deaf = true;  // its frames are read, but do not change
  rig.driver->Cycle(6);
  EXPECT_EQ(rig.Heard("all motors hold: board 5 receives no broadcasts"), 1) << rig.Events();
  rig.driver->Cycle(20);
  EXPECT_EQ(rig.Heard("board 5 receives no broadcasts"), 2) << "told once: " << rig.Events();
  EXPECT_EQ(rig.board(0).core.mode, Mode::kHold);
  EXPECT_TRUE(rig.board(5).core.timeout) << "and it helps itself";
  rig.board(5).deaf = false;
  rig.driver->Cycle(3);
  EXPECT_EQ(rig.Heard("board 5 received no broadcast in time"), 1) << rig.Events();
}

TEST(OnFault, HoldOffOrStop) {
  const std::pair<OnFault, Mode> cases[] = {
      {OnFault::kHold, Mode::kHold}, {OnFault::kOff, Mode::kOff}, {OnFault::kStop, Mode::kStopped}};
  for (const auto& [what, mode] : cases) {
    DriverOptions options;
    options.on_fault = what;
    options.cables = {"a", "b", "c", "d"};
    Rig rig(options);
    rig.Run(Mode::kImpedance);
    rig.board(1).core.faults[1] = board::kSlack;
    rig.driver->Cycle(6);
    for (const std::size_t b : {0u, 2u, 5u}) {
      EXPECT_EQ(ModeName(rig.state().boards[b].status.mode), std::string(ModeName(mode))) << b;
    }
    EXPECT_EQ(rig.state().stopping, what == OnFault::kStop);
    EXPECT_EQ(rig.Heard("d: slack"), 1) << rig.Events();
    EXPECT_EQ(rig.Heard("board 1 has a fault"), 1) << rig.Events();
    EXPECT_EQ(rig.state().motors[3].faults, board::kSlack);
  }
}

TEST(OnFault, ASecondFaultOfTheSameBoardIsToldToo) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  rig.board(1).core.faults[1] = board::kSlack;
  rig.driver->Cycle(6);
  rig.board(1).core.faults[0] = board::kHot;
  rig.board(1).core.board_faults = board::kBusStuck;
  rig.driver->Cycle(17);
  EXPECT_EQ(rig.Heard("motor 3: slack"), 1) << rig.Events();
  EXPECT_EQ(rig.Heard("motor 2: hot"), 1) << rig.Events();
  EXPECT_EQ(rig.Heard("board 1: bus_stuck"), 1) << rig.Events();
  rig.driver->Off();
  rig.driver->ClearFaults();
  rig.driver->Cycle(3);
  rig.board(1).core.faults[1] = board::kSlack;
  rig.driver->Cycle(6);
  EXPECT_EQ(rig.Heard("motor 3: slack"), 2) << "after it was cleared it is news: " << rig.Events();
}

TEST(ABoardThatBeginsAnew, HoldsTheOthersAndSaysWhy) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  rig.board(3).Begin(board::kWatchdog);
  rig.driver->Cycle(6);
  EXPECT_EQ(rig.Heard("board 3: reset cause watchdog"), 1) << rig.Events();
  EXPECT_EQ(rig.Heard("all motors hold: board 3 was reset"), 1) << rig.Events();
  EXPECT_EQ(rig.board(0).core.mode, Mode::kHold);
  EXPECT_FALSE(rig.board(3).IsPowered());
  EXPECT_EQ(rig.state().boards[3].reset_cause, board::kWatchdog);
}

// The reset flag was already set before the reset; a refused command reveals the reset.
TEST(ABoardThatBeginsAnew, IsNoticedIfNobodyClearedItsFirstBeginning) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  ASSERT_TRUE(rig.driver->Enable(Mode::kHold, false, rig.out)) << rig.out.Format();
  ASSERT_TRUE(rig.state().boards[3].status.was_reset);
  EXPECT_EQ(rig.Heard("was reset"), 0) << "who has just begun is no news: " << rig.Events();
  rig.board(3).Begin(board::kWatchdog);
  rig.driver->Cycle(20);
  EXPECT_EQ(rig.Heard("board 3: hold -> off"), 1) << rig.Events();
  EXPECT_EQ(rig.Heard("board 3: not_armed"), 1) << rig.Events();
}

TEST(ATimeout, IsTold) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  rig.robot.Wait(rig.robot.now_s() + 0.15);  // the PC was busy
  rig.driver->Cycle(3);
  EXPECT_EQ(rig.Heard("board 2 received no broadcast in time"), 1) << rig.Events();
  EXPECT_EQ(rig.Heard("all motors hold"), 1) << rig.Events();
  EXPECT_EQ(rig.state().link.late_cycles, 1);
  rig.driver->ClearFaults();
  rig.driver->Cycle(3);
  EXPECT_FALSE(rig.state().boards[2].status.timeout);
}

TEST(Broadcasts, ThatNobodyHearsAreSaidOnceMore) {
  Rig rig;
  rig.Run(Mode::kHold);
  int broken = 0;
  rig.robot.spoil = [&](const Bytes& frame, Bytes& reply) {
    if (IsBroadcast(frame) && broken++ == 0) reply[0] = 0;
  };
  const std::size_t from = rig.robot.frames.size();
  rig.driver->Cycle(1);
  const auto said = rig.robot.Broadcasts(from);
  ASSERT_EQ(said.size(), 2u);
  EXPECT_EQ(said[0].sequence, said[1].sequence) << "boards that did hear it obey once";
  EXPECT_EQ(rig.state().link.unheard_broadcasts, 1);
  EXPECT_EQ(rig.state().boards[0].stale_frames, 0);
}

TEST(Broadcasts, ThatNobodyHearsForLongMakeTheAdapterBeginAnew) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.driver->Cycle(2);
  rig.robot.spoil = [](const Bytes& frame, Bytes& reply) {
    if (IsBroadcast(frame)) reply[0] = 0;
  };
  const std::size_t from = rig.robot.frames.size();
  rig.driver->Cycle(2);
  EXPECT_GE(rig.state().link.adapter_resets, 1);
  EXPECT_GE(rig.Heard("no board acknowledges broadcasts"), 1);
  EXPECT_TRUE(std::any_of(rig.robot.frames.begin() + static_cast<std::ptrdiff_t>(from),
                          rig.robot.frames.end(), [](const auto& frame) {
                            return frame.second == Bytes{0x5a, 0x02, 0x70, 0x04};
                          }));
}

TEST(ASilentAdapter, IsCountedAndGivenUpOn) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  rig.robot.swallow = [](const Bytes& frame) { return frame[0] != 0x5a; };
  rig.driver->Cycle(2);
  EXPECT_FALSE(rig.state().stopping) << "it may only be late";
  rig.driver->Cycle(10);
  EXPECT_GE(rig.state().link.silent_transfers, 12);
  EXPECT_TRUE(rig.state().stopping);
  EXPECT_EQ(rig.Heard("board 0 does not answer"), 2) << rig.Events();
  rig.robot.swallow = {};
  rig.driver->Cycle(30);
  EXPECT_TRUE(rig.state().boards[0].there);
  EXPECT_FALSE(rig.robot.AnyPower()) << "the stop has reached them";
}

TEST(ASilentAdapter, ForAMomentIsSurvived) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  int frames = 0;
  rig.robot.swallow = [&](const Bytes&) { return frames++ == 1; };
  rig.driver->Cycle(5);
  EXPECT_EQ(rig.state().link.silent_transfers, 1);
  EXPECT_EQ(rig.state().boards[0].bad_frames, 1);
  EXPECT_FALSE(rig.state().stopping);
  rig.ExpectAll(Mode::kImpedance);
}

TEST(ASlowAdapter, IsNotMisunderstood) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  rig.robot.spoil = [&](const Bytes&, Bytes&) {
    rig.robot.delay_s = rig.robot.frames.size() % 5 == 0 ? 0.045 : 0;
  };
  rig.driver->Cycle(30);
  EXPECT_GT(rig.state().link.silent_transfers, 3);
  for (std::size_t m = 0; m < 12; ++m) {
    EXPECT_NEAR(rig.state().motors[m].tension_n, rig.board(m / 2).motors[m % 2].Tension(), 1.0)
        << m;
  }
}

TEST(Garbage, IsNotBelieved) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.driver->Cycle(3);
  const double tension_n = rig.state().motors[0].tension_n;
  std::uint32_t noise = 1;
  rig.robot.spoil = [&](const Bytes&, Bytes& reply) {
    for (std::uint8_t& byte : reply)
      byte = static_cast<std::uint8_t>((noise = noise * 1664525 + 1013904223) >> 24);
  };
  rig.driver->Cycle(20);
  EXPECT_NEAR(rig.state().motors[0].tension_n, tension_n, 1e-9);
  EXPECT_FALSE(rig.state().boards[0].there);
  EXPECT_GT(rig.state().boards[0].bad_frames, 2);
}

TEST(AnAdapterThatIsPulledOut, IsOpenedAgainAndMotorsHold) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  rig.robot.gone = true;
  rig.driver->RunUntil(rig.robot.now_s() + 0.6);
  EXPECT_EQ(rig.Heard("the adapter is gone"), 1) << rig.Events();
  EXPECT_FALSE(rig.state().link.connected);
  EXPECT_GE(rig.robot.reopened, 1);
  EXPECT_LE(rig.robot.reopened, 4) << "a few times a second";
  EXPECT_TRUE(rig.robot.AnyPower()) << "boards hold";
  rig.robot.gone = false;
  rig.driver->RunUntil(rig.robot.now_s() + 0.4);
  EXPECT_TRUE(rig.state().link.connected);
  EXPECT_EQ(rig.state().link.reconnections, 1);
  EXPECT_EQ(rig.Heard("the adapter is back"), 1) << rig.Events();
  EXPECT_EQ(rig.Heard("board 0 received no broadcast in time"), 1) << rig.Events();
  EXPECT_EQ(rig.robot.Broadcasts().back().mode, Mode::kHold) << "not where it left off";
  rig.driver->ClearFaults();
  rig.driver->Cycle(3);
  rig.ExpectAll(Mode::kHold);
}

TEST(AnAdapterThatIsPulledOut, EndsCyclesThatSomebodyWaitsFor) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.robot.gone = true;
  rig.driver->Cycle(100);
  EXPECT_FALSE(rig.state().link.connected);
}

}  // namespace
}  // namespace taut::link
