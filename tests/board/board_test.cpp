// Modes, commands and parameters of a board.
#include "taut/board/board.h"

#include <gtest/gtest.h>

#include <limits>

#include "board/bench_motor.h"

namespace taut::board {
namespace {

TEST(Board, HasNoPowerUntilItIsArmedInTwoSteps) {
  Bench bench;
  bench.say.mode = Mode::kHold;
  bench.say.arm = Arm::kGo;  // the second step without the first
  bench.Run(50);
  EXPECT_FALSE(IsPowered(bench.board));
  EXPECT_NE(bench.board.board_faults & kNotArmed, 0);
  bench.ArmInto(Mode::kHold);
  EXPECT_TRUE(IsPowered(bench.board));
  EXPECT_EQ(bench.board.mode, Mode::kHold);
  bench.say.arm = Arm::kNot;
  bench.Run(11);
  EXPECT_FALSE(IsPowered(bench.board));
}

TEST(Board, HoldsWhereItIs) {
  Bench bench;
  bench.ArmInto(Mode::kHold);
  bench.Run(2000);
  EXPECT_NEAR(bench.board.loops[0].counts, bench.board.loops[0].target_counts, 1);
  EXPECT_LT(std::fabs(bench.motors[0].speed_now_m_per_s), 1e-3);
}

TEST(Board, GoesToAPosition) {
  Bench bench;
  bench.Reference();
  bench.ArmInto(Mode::kHold);
  bench.say.mode = Mode::kPosition;
  bench.say.values[0] = 1000;
  bench.say.values[1] = -800;
  bench.Run(2000);
  EXPECT_NEAR(bench.board.loops[0].counts, 1000, 2);
  EXPECT_NEAR(bench.board.loops[1].counts, -800, 2);
}

TEST(Board, CapturesLengthAndTensionAndHoldsThemByImpedance) {
  Bench bench;
  bench.ArmInto(Mode::kImpedance);
  EXPECT_EQ(bench.board.mode, Mode::kImpedance);
  const double T_n = bench.motors[0].Tension();
  EXPECT_NEAR(bench.Get(kTensionOffset, 0), T_n, 0.3);
  // l = L + T / k: encoder counts start at the reference of 0.2 m
  EXPECT_NEAR(bench.Get(kLengthOffset, 0), 0.2 + T_n / 227, 2e-3);
  bench.Run(3000);
  EXPECT_NEAR(bench.motors[0].Tension(), T_n, 0.5);
  EXPECT_EQ(bench.board.faults[0], 0);
}

// V0 shifts the set point of the tension by -B V0 (eq. 3), and the loop follows.
TEST(Board, FollowsV0ByTheImpedanceLaw) {
  Bench bench;
  bench.Set(kPositionGain, 0, 0);
  bench.ArmInto(Mode::kImpedance);
  const float T0 = bench.Get(kTensionOffset, 0);
  bench.say.values[0] = static_cast<std::int16_t>(-0.03f / kSpeedUnit_m_per_s);
  bench.Run(3000);
  EXPECT_NEAR(bench.board.loops[0].set_point_n, T0 + 100 * 0.03, 0.2);
  EXPECT_NEAR(bench.motors[0].Tension(), T0 + 100 * 0.03, 0.4);
  bench.say.zero_inputs = true;
  bench.Run(3000);
  EXPECT_NEAR(bench.motors[0].Tension(), T0, 0.4);
}

TEST(Board, AChangeOfModeDoesNotJump) {
  Bench bench;
  bench.Reference();
  bench.ArmInto(Mode::kHold);
  bench.Run(1000);
  const Mode order[] = {Mode::kImpedance, Mode::kHold, Mode::kImpedance, Mode::kPosition};
  for (const Mode mode : order) {
    const float before = bench.board.loops[0].drive;
    bench.say.mode = mode;
    bench.say.capture = mode == Mode::kImpedance;
    bench.say.values[0] =
        static_cast<std::int16_t>(mode == Mode::kPosition ? bench.board.loops[0].counts : 0);
    bench.say.values[1] =
        static_cast<std::int16_t>(mode == Mode::kPosition ? bench.board.loops[1].counts : 0);
    bench.Run(10 - static_cast<int>(bench.ms % 10) + 1);
    ASSERT_EQ(bench.board.mode, mode);
    EXPECT_NEAR(bench.board.loops[0].drive, before, 8) << static_cast<int>(mode);
    bench.Run(500);
  }
}

TEST(Board, AppliesABroadcastAsAWholeAtTheNextTick) {
  Bench bench;
  bench.ArmInto(Mode::kImpedance);
  bench.say.values[0] = bench.say.values[1] = 700;
  bench.Say();
  EXPECT_EQ(bench.board.loops[0].velocity_input_m_per_s, 0.0f);
  bench.Step();
  EXPECT_EQ(bench.board.loops[0].velocity_input_m_per_s, 700 * kSpeedUnit_m_per_s);
  EXPECT_EQ(bench.board.loops[1].velocity_input_m_per_s, 700 * kSpeedUnit_m_per_s);
}

TEST(BoardParameters, AreRefusedOutsideTheirLimits) {
  Bench bench;
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              inf = std::numeric_limits<float>::infinity();
  for (std::uint8_t i = 0; i < kMotorParameters; ++i) {
    const Range range = MotorRange(i);
    const auto which = static_cast<MotorParameter>(i);
    ASSERT_LT(range.least, range.greatest);
    ASSERT_TRUE(IsWithin(range, range.value)) << int{i};
    for (const float bad :
         {nan, inf, -inf, std::nextafter(range.least, -inf), std::nextafter(range.greatest, inf)}) {
      EXPECT_EQ(bench.Set(which, 1, bad), Answer::kOutOfRange) << int{i} << " " << bad;
    }
    EXPECT_EQ(bench.Get(which, 1), range.value);
    EXPECT_EQ(bench.Set(which, 1, range.greatest), Answer::kGood);
    EXPECT_EQ(bench.Get(which, 1), range.greatest);
    EXPECT_EQ(bench.Get(which, 0), range.value);
  }
  for (std::uint8_t i = 0; i < kBoardParameters; ++i)
    ASSERT_TRUE(IsWithin(BoardRange(i), BoardRange(i).value));
  EXPECT_EQ(bench.Ask(Request::kAsk, kMotorParameters, 0), Answer::kUnknown);
  EXPECT_EQ(bench.Ask(Request::kAsk, 0, 3), Answer::kUnknown);
  EXPECT_EQ(bench.Ask(Request::kAsk, 0xee, 0), Answer::kUnknown);
}

TEST(BoardParameters, ChangeSlowlyWhileMotorsRunOrNotAtAll) {
  Bench bench;
  bench.ArmInto(Mode::kImpedance);
  EXPECT_EQ(bench.Set(kForceP, 0, 1.0f), Answer::kNotInThisMode);
  ASSERT_EQ(bench.Set(kPositionGain, 0, 600), Answer::kGood);
  EXPECT_EQ(bench.board.loops[0].gains.position_gain_n_per_m, 100);
  bench.Run(500);
  EXPECT_NEAR(bench.board.loops[0].gains.position_gain_n_per_m, 350, 10);  // 500 N/m per second
  bench.Run(700);
  EXPECT_EQ(bench.board.loops[0].gains.position_gain_n_per_m, 600);
}

TEST(BoardParameters, ThatAreLostSayItAndAreDefaults) {
  Boot boot;
  boot.parameters_good = false;
  Board board;
  board.parameters.motor[0][kTensionLimit] = 1e30f;
  Start(boot, board);
  EXPECT_NE(board.board_faults & kParametersLost, 0);
  EXPECT_EQ(board.parameters.motor[0][kTensionLimit], 50.0f);
}

}  // namespace
}  // namespace taut::board
