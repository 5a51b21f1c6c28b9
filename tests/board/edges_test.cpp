// Boundary values of a board's commands and readings: cases first found by its fuzz target.
#include <gtest/gtest.h>

#include "board/bench_motor.h"
#include "taut/board/board.h"

namespace taut::board {
namespace {

TEST(Board, PaysOutNoHarderThanItsDutyMayBe) {
  Bench bench;
  ASSERT_EQ(bench.Set(kDutyLimit, 0, 0.1f), Answer::kGood);
  bench.ArmInto(Mode::kHold);
  bench.motors[0].wound_m = 55.0 / 227;
  bench.board.loops[0].encoder = bench.motors[0].Encoder();
  bench.Run(20);
  EXPECT_EQ(bench.board.loops[0].drive, -0.1f * kFullWidth);
}

TEST(Board, GoesOffInSilenceWhereItIsToldToWhateverElseIsWrong) {
  for (const bool while_it_is_silent : {false, true}) {
    Bench bench;
    ASSERT_EQ(bench.Ask(Request::kSet, kOnTimeout, kMotors, internal::ToBits(1.0f)), Answer::kGood);
    bench.ArmInto(Mode::kImpedance);
    if (while_it_is_silent) bench.Silence(85);
    bench.motors[0].adc_stuck = 0;  // a fault after five readings, in the tick of the timeout
    if (while_it_is_silent) {
      bench.Silence(20);
    } else {
      bench.Run(20);
      EXPECT_EQ(bench.board.mode, Mode::kHold);
      bench.Silence(110);
    }
    EXPECT_NE(bench.board.faults[0] & kSensor, 0);
    EXPECT_TRUE(bench.board.timeout);
    EXPECT_FALSE(IsPowered(bench.board)) << while_it_is_silent;
    EXPECT_EQ(bench.board.loops[1].width, 0);
  }
}

// The driver is off then, but a duty would be reported and counted as heat.
TEST(Board, WithoutPowerItPaysNothingOut) {
  Bench bench;
  bench.ArmInto(Mode::kHold);
  bench.motors[0].wound_m = 55.0 / 227;
  bench.board.loops[0].encoder = bench.motors[0].Encoder();
  bench.Run(20);
  ASSERT_LT(bench.board.loops[0].drive, 0.0f);
  bench.say.mode = Mode::kOff;
  bench.Run(20);
  EXPECT_NE(bench.board.faults[0] & kOverTension, 0);
  EXPECT_FALSE(IsPowered(bench.board));
  EXPECT_EQ(bench.board.loops[0].width, 0);
}

TEST(Board, WithoutANumberItTakesNoBroadcastButAStop) {
  Boot boot;
  boot.board = 7;
  Bench bench(boot);
  bench.ArmInto(Mode::kHold);  // the message would end before the board's part
  EXPECT_FALSE(IsPowered(bench.board));
  EXPECT_FALSE(bench.board.heard);
  EXPECT_EQ(bench.board.counters.bad_messages, 4);
  std::uint8_t frame[kStopSize];
  EncodeStop(frame);
  Receive(frame, sizeof frame, true, bench.board);
  EXPECT_TRUE(bench.board.stopped);
}

TEST(Board, CapturesNoTensionAboveItsRange) {
  Bench bench;
  ASSERT_EQ(bench.Set(kTensionLimit, 0, 110), Answer::kGood);
  bench.motors[0].wound_m = 70.0 / 227;
  bench.board.loops[0].encoder = bench.motors[0].Encoder();
  bench.ArmInto(Mode::kImpedance);
  EXPECT_EQ(bench.board.mode, Mode::kImpedance);
  EXPECT_EQ(bench.Get(kTensionOffset, 0), 50.0f);
}

TEST(Board, AnIntegralGainOfNextToNothingIsNone) {
  Bench bench;
  bench.ArmInto(Mode::kHold);
  bench.Run(100);
  const float drive = bench.board.loops[0].drive;
  ASSERT_GT(drive, 0.0f);
  ASSERT_EQ(bench.Set(kLengthI, 0, 1e-40f), Answer::kGood);
  EXPECT_EQ(bench.board.loops[0].pid.integral, 0.0f);
  bench.Run(100);
  EXPECT_TRUE(std::isfinite(bench.board.loops[0].pid.integral));
  EXPECT_LT(std::fabs(bench.board.loops[0].drive), 2 * drive) << "and not all that there is";
}

TEST(Board, RefusesAReferenceThatAFloatDoesNotHave) {
  Bench bench;
  const auto set = [&bench](std::int32_t counts) {
    return bench.Ask(Request::kDo, static_cast<std::uint8_t>(Action::kSetReference), 0,
                     static_cast<std::uint32_t>(counts));
  };
  EXPECT_EQ(set(kMostReference), Answer::kGood);
  EXPECT_EQ(set(-kMostReference), Answer::kGood);
  EXPECT_EQ(set(kMostReference + 1), Answer::kOutOfRange);
  EXPECT_EQ(set(-kMostReference - 1), Answer::kOutOfRange);
  EXPECT_EQ(set(INT32_MIN), Answer::kOutOfRange);
  EXPECT_EQ(bench.board.loops[0].counts, -kMostReference);
}

// Such a tension results from the maximum of `winding_counts_per_count` and a jump of the encoder.
TEST(Board, ReportsATensionThatHasNoPlaceInAFrameAsTheMost) {
  Bench bench;
  for (const float counts : {1100.0f, 17000.0f, 3e5f}) {
    bench.board.loops[0].tension_counts = counts;
    std::uint8_t frame[kFrameSize];
    MakeFrame(bench.board, frame);
    EXPECT_EQ(DecodeStatus(frame).motors[0].tension_quarters, 4 * 1023) << counts;
  }
}

TEST(Board, AnEncoderThatJumpsMakesNoHeatOfOtherSign) {
  Watch watch;
  for (int i = 0; i < 255; ++i) FeelHeat(kFullWidth, i % 2 == 0 ? INT16_MIN : INT16_MAX, watch);
  EXPECT_EQ(watch.step_step, 255 * 2000 * 2000);
}

}  // namespace
}  // namespace taut::board
