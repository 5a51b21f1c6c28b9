// Resets of a board: causes, and restart of the program
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "apps/virtual_robot/avr_core.h"
#include "apps/virtual_robot/simavr.h"
#include "tests/virtual_robot/board_fixture.h"

namespace taut::virtual_robot {
namespace {

TEST(Board, ALineThatFallsBeforeTheProgramAsksForEdgesIsNoStorm) {
  Board board(ProbeProgram(), {});
  board.SetEncoderEdges(0, {{0, true, false}});
  RunTo(board, kBoot);
  board.SetBrownOut(board.now(), true);
  const Time again = board.now() + kMillisecond;
  board.SetBrownOut(again, false);
  board.SetEncoderEdges(0, {{again + kMicrosecond, false, false}});
  RunTo(board, again + 60 * kMillisecond);
  EXPECT_EQ(board.resets(), 1U);
  EXPECT_NEAR(Long(board, kBoxTicks), 65, 2);
}

TEST(Board, EdgesAfterAResetCountOnceEach) {
  Board board(ProbeProgram(), {});
  RunTo(board, kBoot);
  // Stop with both lines low, a state that causes a storm of interrupts in simavr after a reset.
  board.SetEncoderEdges(0, Edges(4, board.now(), board.now() + kMillisecond));
  RunTo(board, board.now() + 2 * kMillisecond);
  ASSERT_EQ(Count(board, 0), 2);
  board.SetMemory(kBoxOrder, kOrderHang);
  RunTo(board, board.now() + 80 * kMillisecond);
  ASSERT_EQ(board.resets(), 1U);
  const std::uint32_t ticks = Long(board, kBoxTicks);
  RunTo(board, board.now() + 10 * kMillisecond);
  EXPECT_EQ(Long(board, kBoxTicks), ticks + 10);
  EXPECT_EQ(Count(board, 0), 2) << "memory is kept, and nothing moved";
  board.SetEncoderEdges(0, Edges(6, board.now(), board.now() + kMillisecond));
  RunTo(board, board.now() + 2 * kMillisecond);
  EXPECT_EQ(Count(board, 0), 5);
  // Pins keep their level through a reset.
  board.SetMemory(kBoxOrder, kOrderHang);
  RunTo(board, board.now() + 80 * kMillisecond);
  board.SetEncoderEdges(0, {{board.now(), false, true}});
  RunTo(board, board.now() + kMillisecond);
  EXPECT_EQ(Count(board, 0), 6) << "from A high, B high to A low is one edge on";
}

TEST(Board, TheWatchdogEndsAHangWithinItsTimeAndSaysSo) {
  for (const bool by_emulator : {false, true}) {
    Board board(ProbeProgram(), {});
    std::vector<std::pair<Time, ResetCause>> resets;
    board.on_reset = [&](Time at, ResetCause cause) { resets.emplace_back(at, cause); };
    RunTo(board, kBoot);
    if (by_emulator) {
      board.Hang();
    } else {
      board.SetMemory(kBoxOrder, kOrderHang);
    }
    const Time hung = board.now();
    RunTo(board, hung + 100 * kMillisecond);
    ASSERT_EQ(resets.size(), 1U);
    EXPECT_EQ(resets[0].second, ResetCause::kWatchdog);
    EXPECT_NEAR(ToSeconds(resets[0].first - hung), 0.064, 0.002) << "8192 cycles of 128 kHz";
    EXPECT_EQ(board.Memory(kBoxCause), 8);
    EXPECT_EQ(board.Memory(kBoxBoots), 2);
  }
}

TEST(Board, AProgramClearsCausesOfResetsAndSetsNone) {
  Board board(ProbeProgram(), {});
  RunTo(board, kBoot);
  board.SetMemory(kBoxCausesRead, 0xFF);
  board.SetMemory(kBoxOrder, kOrderSetCauses);
  RunTo(board, board.now() + 5 * kMillisecond);
  EXPECT_EQ(board.Memory(kBoxCausesRead), 0) << "it had cleared them all when it began";
  board.SetMemory(kBoxOrder, kOrderHang);
  RunTo(board, board.now() + 100 * kMillisecond);
  EXPECT_EQ(board.Memory(kBoxCause), 8) << "and the next reset has its own cause only";
}

// Otherwise simavr would check its timers after about every instruction: the same result, ten times
// slower.
TEST(Board, ACoreRunsOnForAsLongAfterAReset) {
  AvrCore core(*ProbeProgram());
  core.Reset(1, true);
  EXPECT_EQ(core.avr().run_cycle_limit, 100'000U);
  core.avr().run_cycle_limit = 1;
  core.Reset(4, false);
  EXPECT_EQ(core.avr().run_cycle_limit, 100'000U);
}

TEST(Board, AProgramThatIsLostIsCaughtByTheWatchdog) {
  for (const int order : {kOrderSleepForever, kOrderLeave}) {
    Board board(ProbeProgram(), {});
    std::string trouble;
    board.on_trouble = [&](Time, const std::string& what) { trouble += what; };
    RunTo(board, kBoot);
    board.SetMemory(kBoxOrder, static_cast<std::uint8_t>(order));
    RunTo(board, board.now() + 100 * kMillisecond);
    EXPECT_EQ(board.crashes(), 1U) << order;
    EXPECT_NE(trouble.find("the program has crashed"), std::string::npos);
    EXPECT_EQ(board.Memory(kBoxCause), 8) << order;
    EXPECT_EQ(board.Memory(kBoxBoots), 2) << order;
  }
}

TEST(Board, ABrownOutHoldsItThenSaysSo) {
  Board board(ProbeProgram(), {});
  RunTo(board, 50 * kMillisecond);
  const std::uint32_t ticks = Long(board, kBoxTicks);
  board.SetMemory(kBoxEnable, 1);
  board.SetMemory(kBoxNewDuty, 1);
  RunTo(board, 52 * kMillisecond);
  EXPECT_TRUE(board.Drive(0).enabled);
  board.SetBrownOut(52 * kMillisecond, true);
  EXPECT_FALSE(board.Drive(0).enabled) << "pins of a core in reset drive nothing";
  board.RunUntil(80 * kMillisecond);
  EXPECT_EQ(Long(board, kBoxTicks), ticks + 2);
  board.SetBrownOut(80 * kMillisecond, false);
  RunTo(board, 90 * kMillisecond);
  EXPECT_EQ(board.Memory(kBoxCause), 4);
  EXPECT_EQ(board.Memory(kBoxBoots), 2) << "memory was kept";
  EXPECT_NEAR(Long(board, kBoxTicks), ticks + 12, 1);
}

TEST(Board, LossOfPowerForgetsTheMemory) {
  Board board(ProbeProgram(), {.id = 2, .eeprom = {7, 8}});
  RunTo(board, 50 * kMillisecond);
  board.SetPower(50 * kMillisecond, false);
  EXPECT_FALSE(board.bus_side().Powered());
  board.RunUntil(kSecond);
  board.SetPower(kSecond, true);
  RunTo(board, kSecond + 10 * kMillisecond);
  EXPECT_EQ(board.Memory(kBoxCause), 1);
  EXPECT_EQ(board.Memory(kBoxBoots), 1);
  EXPECT_NEAR(Long(board, kBoxTicks), 10, 1);
  EXPECT_EQ(board.Memory(kBoxId), 2) << "the EEPROM is kept";
  EXPECT_EQ(board.Eeprom()[2], 8);
}

}  // namespace
}  // namespace taut::virtual_robot
