// Automatic reactions of a board to faults: the table of docs/hardware/firmware.md.
#include "taut/board/board.h"

#include <gtest/gtest.h>

#include "board/bench_motor.h"

namespace taut::board {
namespace {

TEST(Board, FreezesItsInputsAfter30MsOfSilence) {
  Bench bench;
  bench.ArmInto(Mode::kImpedance);
  bench.say.values[0] = 500;
  bench.Run(100);
  ASSERT_EQ(bench.board.loops[0].velocity_input_m_per_s, 500 * kSpeedUnit_m_per_s);
  bench.Silence(18);
  EXPECT_EQ(bench.board.loops[0].velocity_input_m_per_s, 500 * kSpeedUnit_m_per_s);
  bench.Silence(6);
  EXPECT_EQ(bench.board.loops[0].velocity_input_m_per_s, 0.0f);
  EXPECT_FALSE(bench.board.timeout);
  bench.Run(20);  // broadcasts resume in time: it continues
  EXPECT_EQ(bench.board.loops[0].velocity_input_m_per_s, 500 * kSpeedUnit_m_per_s);
  EXPECT_EQ(bench.board.counters.missed, 1);
}

TEST(Board, HoldsAfter100MsOfSilenceUntilItIsCleared) {
  Bench bench;
  bench.Reference();
  bench.ArmInto(Mode::kPosition, false);
  bench.say.values[0] = 4000;
  bench.Run(200);
  bench.Silence(110);
  EXPECT_TRUE(bench.board.timeout);
  EXPECT_EQ(bench.board.mode, Mode::kHold);
  const double here_m = bench.motors[0].wound_m;
  bench.Silence(2000);
  EXPECT_NEAR(bench.motors[0].wound_m, here_m, 2e-3) << "it ran at 7 cm/s";
  bench.Run(200);  // the PC sends again, and commands position control as before
  EXPECT_EQ(bench.board.mode, Mode::kHold);
  bench.say.mode = Mode::kHold;
  bench.say.clear_faults = true;
  bench.Run(10);
  EXPECT_FALSE(bench.board.timeout);
  bench.say.mode = Mode::kPosition;
  bench.Run(20);
  EXPECT_EQ(bench.board.mode, Mode::kPosition);
}

TEST(Board, GoesOffAfterSilenceWhereItIsToldTo) {
  Bench bench;
  ASSERT_EQ(bench.Ask(Request::kSet, kOnTimeout, kMotors, internal::ToBits(1.0f)), Answer::kGood);
  bench.ArmInto(Mode::kImpedance);
  bench.Silence(101);
  EXPECT_FALSE(IsPowered(bench.board));
  bench.Run(100);
  EXPECT_FALSE(IsPowered(bench.board)) << "it has to be armed again";
}

TEST(Board, RefusesAPositionWithoutAReference) {
  Bench bench;
  bench.ArmInto(Mode::kPosition, false);
  EXPECT_NE(bench.board.mode, Mode::kPosition);
  EXPECT_NE(bench.board.board_faults & kUnreferenced, 0);
  EXPECT_EQ(bench.board.loops[0].drive, 0.0f);
  Bench other;
  other.ArmInto(Mode::kImpedance, false);  // its L0 is undefined
  EXPECT_NE(other.board.mode, Mode::kImpedance);
}

TEST(Board, TakesAReferenceOfThisBootOnly) {
  Boot boot;
  boot.nonce = 7;
  Bench bench(boot);
  bench.nonce = 6;
  EXPECT_EQ(bench.Ask(Request::kDo, static_cast<std::uint8_t>(Action::kSetReference), 0, 100),
            Answer::kStale);
  EXPECT_FALSE(bench.board.referenced[0]);
  bench.nonce = 7;
  EXPECT_EQ(bench.Ask(Request::kDo, static_cast<std::uint8_t>(Action::kSetReference), 0, 100),
            Answer::kGood);
  EXPECT_TRUE(bench.board.referenced[0]);
  EXPECT_EQ(bench.board.loops[0].counts, 100);
}

TEST(Board, AReferenceMovesNoMotorThatHolds) {
  Bench bench;
  bench.ArmInto(Mode::kHold);
  bench.Run(1000);
  const double before_m = bench.motors[0].wound_m;
  EXPECT_EQ(bench.Ask(Request::kDo, static_cast<std::uint8_t>(Action::kSetReference), 0, 5000),
            Answer::kGood);
  bench.Run(500);
  EXPECT_NEAR(bench.motors[0].wound_m, before_m, 3e-5);
  EXPECT_NEAR(bench.board.loops[0].counts, 5000, 3);
}

TEST(Board, NeverPullsAboveItsLimitByItself) {
  for (const Mode mode : {Mode::kDuty, Mode::kPosition, Mode::kImpedance}) {
    Bench bench;
    bench.Reference();
    bench.ArmInto(mode);
    for (int m = 0; m < kMotors; ++m)
      bench.say.values[m] = mode == Mode::kImpedance ? -32767 : 32767;
    bench.Run(6000);
    EXPECT_LE(bench.most_n, 50.0) << static_cast<int>(mode);
    EXPECT_GT(bench.most_n, 40.0) << static_cast<int>(mode);
  }
}

TEST(Board, PaysOutWhenPulledAboveItsLimit) {
  Bench bench;
  bench.ArmInto(Mode::kHold);
  bench.motors[0].wound_m = 55.0 / 227;  // an external pull
  bench.board.loops[0].encoder = bench.motors[0].Encoder();
  bench.Run(20);
  EXPECT_NE(bench.board.faults[0] & kOverTension, 0);
  EXPECT_LT(bench.board.loops[0].drive, 0.0f);
  bench.Run(3000);
  EXPECT_LT(bench.motors[0].Tension(), 41);
  EXPECT_EQ(bench.board.loops[0].drive, 0.0f);
  EXPECT_EQ(bench.board.faults[1], 0);
  EXPECT_EQ(bench.board.mode, Mode::kHold) << "the other motor holds";
}

TEST(Board, NoticesALoadCellAtAnEndOfItsRange) {
  for (const int stuck : {0, 2, 735, 741}) {
    Bench bench;
    ASSERT_EQ(bench.Set(kTensionLimit, 0, 110), Answer::kGood);
    bench.ArmInto(Mode::kImpedance);
    bench.motors[0].adc_stuck = stuck;
    bench.Run(4);
    EXPECT_EQ(bench.board.faults[0], 0) << "fewer than five readings";
    bench.Run(2);
    EXPECT_NE(bench.board.faults[0] & kSensor, 0) << stuck;
    EXPECT_EQ(bench.board.loops[0].drive, 0.0f);
    EXPECT_EQ(bench.board.mode, Mode::kHold);
  }
}

TEST(Board, NoticesALoadCellThatStandsStill) {
  Bench bench;
  bench.Reference();
  bench.ArmInto(Mode::kPosition, false);
  bench.Run(100);
  bench.motors[0].adc_stuck = bench.motors[0].Adc();
  const double before_m = bench.motors[0].wound_m;
  bench.say.values[0] = 8000;
  bench.Run(3000);
  EXPECT_NE(bench.board.faults[0] & kSensor, 0);
  EXPECT_LT(bench.motors[0].wound_m - before_m, 0.035) << "3 cm are allowed";
}

TEST(Board, StopsWindingACableThatIsCut) {
  Bench bench;
  bench.ArmInto(Mode::kImpedance);
  bench.motors[0].cut = true;
  const double before_m = bench.motors[0].wound_m;
  bench.Run(3000);
  EXPECT_NE(bench.board.faults[0] & kSlack, 0);
  EXPECT_LT(bench.motors[0].wound_m - before_m, 0.035) << "3 cm are allowed";
  EXPECT_EQ(bench.board.loops[0].drive, 0.0f);
}

TEST(Board, NoticesAMotorThatIsBlockedAndAnEncoderThatIsDead) {
  Bench bench;
  bench.Reference();
  bench.ArmInto(Mode::kPosition, false);
  bench.motors[0].blocked = true;
  bench.say.values[0] = 2000;
  bench.Run(150);
  EXPECT_NE(bench.board.faults[0] & kStall, 0);
  EXPECT_EQ(bench.board.loops[0].drive, 0.0f);
}

TEST(Board, NoticesAnEncoderThatCountsTheWrongWay) {
  Bench bench;
  bench.motors[0].encoder_sign = -1;
  bench.board.loops[0].encoder = bench.motors[0].Encoder();
  bench.Reference();
  bench.ArmInto(Mode::kPosition, false);
  bench.say.values[0] = 1000;
  bench.Run(300);
  EXPECT_NE(bench.board.faults[0] & kPolarity, 0);
  EXPECT_LT(bench.most_n, 50);
}

TEST(Board, NoticesAMotorThatRunsAway) {
  Bench bench;
  bench.ArmInto(Mode::kHold);
  for (int i = 0; i < 8; ++i) {
    bench.motors[0].wound_m -= 1.5e-4;  // 0.15 m/s
    bench.Step();
  }
  EXPECT_NE(bench.board.faults[0] & kRunaway, 0);
}

TEST(Board, ComputesHowWarmItsWindingsAre) {
  Bench bench;
  bench.Reference();
  ASSERT_EQ(bench.Set(kStallDuty, 0, 1.1f), Answer::kGood);  // high limit, so that only the
                                                             // computed heat stops the motor
  bench.ArmInto(Mode::kDuty);
  bench.motors[0].blocked = true;
  bench.say.values[0] = 32767;
  bench.Run(5000);
  // 12 V at 19.8 ohm: 7.27 W; after 5 s the winding is 72.7 K (1 - exp(-5 / 5.6)) above the
  // housing, and the housing 4.7 K above 25
  const double expected_c =
      25 + 72.7 * (1 - std::exp(-5.0 / 5.6)) + 210.9 * (1 - std::exp(-5.0 / 220));
  EXPECT_NEAR(bench.board.temperature_c[0], expected_c, 2.0);
  bench.Run(15000);
  EXPECT_NE(bench.board.faults[0] & kHot, 0);
  EXPECT_EQ(bench.board.loops[0].drive, 0.0f);
}

// The drive reverses at 10 Hz: the motor hardly moves, and becomes as warm as a stalled motor under
// full voltage less the back EMF. The reference sums the heat of the current over ticks.
TEST(Board, ComputesHeatOfADriveThatChangesItsSign) {
  Bench bench;
  bench.ArmInto(Mode::kDuty);
  double winding_k = 0, housing_k = 0;
  for (int i = 0; i < 20000; ++i) {
    const int sign = i / 50 % 2 == 0 ? 1 : -1;
    bench.say.values[0] = static_cast<std::int16_t>(sign * 32767);
    if (bench.ms % 10 == 0) bench.Say();
    bench.Step();
    const MotorLoop& loop = bench.board.loops[0];
    const double current_a =
        (12.0 * loop.width / kFullWidth - 169.0 * loop.step * 1.34e-5 / 1e-3) / 19.8;
    const double heat_w = current_a * current_a * 19.8;
    winding_k += (heat_w * 10 - winding_k) * 1e-3 / 5.6;
    housing_k += (heat_w * 29 - housing_k) * 1e-3 / 220;
  }
  EXPECT_NEAR(bench.board.temperature_c[0], 25 + winding_k + housing_k, 1.5);
  EXPECT_GT(winding_k, 10);
}

TEST(Board, GoesOffWhenTheDriverSaysFault) {
  Bench bench;
  bench.ArmInto(Mode::kHold);
  bench.driver_fault = true;
  bench.Step();
  EXPECT_FALSE(IsPowered(bench.board));
  bench.driver_fault = false;
  bench.Run(100);
  EXPECT_FALSE(IsPowered(bench.board)) << "latched";
  bench.ArmInto(Mode::kHold);
  EXPECT_TRUE(IsPowered(bench.board));
}

TEST(Board, StopsAtOnceAndStaysStopped) {
  Bench bench;
  bench.ArmInto(Mode::kImpedance);
  std::uint8_t frame[kStopSize];
  EncodeStop(frame);
  Receive(frame, sizeof frame, true, bench.board);
  EXPECT_FALSE(IsPowered(bench.board));
  bench.Step();
  EXPECT_EQ(bench.board.loops[0].drive, 0.0f);
  bench.Run(500);
  EXPECT_FALSE(IsPowered(bench.board));
  bench.ArmInto(Mode::kHold);
  EXPECT_TRUE(IsPowered(bench.board));
}

TEST(Board, TakesNoBroadcastTwiceAndNoneThatIsDamaged) {
  Bench bench;
  bench.ArmInto(Mode::kImpedance);
  bench.Run(50);
  Cyclic again = bench.say;
  again.values[0] = 900;
  bench.Send(again);  // the same sequence number
  bench.Step();
  EXPECT_EQ(bench.board.loops[0].velocity_input_m_per_s, 0.0f);
  ++again.sequence;
  std::uint8_t frame[kCyclicSize];
  Encode(again, frame);
  frame[5] ^= 1;
  Receive(frame, sizeof frame, true, bench.board);
  bench.Step();
  EXPECT_EQ(bench.board.loops[0].velocity_input_m_per_s, 0.0f);
  EXPECT_EQ(bench.board.counters.bad_messages, 1);
  for (int i = 0; i < 110; ++i) {  // damaged messages do not prevent the timeout
    Receive(frame, sizeof frame, true, bench.board);
    bench.Step();
  }
  EXPECT_TRUE(bench.board.timeout);
}

TEST(Board, TooManyLateTicksAreAFault) {
  Bench bench;
  bench.ArmInto(Mode::kHold);
  for (int i = 0; i < 1100; ++i) {
    if (bench.ms % 10 == 0) bench.Say();
    bench.Step(i % 10 == 0 ? 2 : 1);
  }
  EXPECT_NE(bench.board.board_faults & kTooManyOverruns, 0);
  EXPECT_EQ(bench.board.counters.overruns, 110);
}

TEST(Board, BeginsWarmAfterAResetThatWasNoPowerOn) {
  Boot boot;
  boot.reset_cause = kWatchdog;
  Bench bench(boot);
  EXPECT_FALSE(IsPowered(bench.board));
  EXPECT_TRUE(bench.board.was_reset);
  EXPECT_FALSE(bench.board.referenced[0]);
  bench.Run(70);
  EXPECT_GT(bench.board.temperature_c[0], 60);
}

// For any input in any state: the duty stays within its limits, and no number becomes NaN.
TEST(Board, RandomMessagesAndReadingsBreakNothing) {
  std::uint32_t random = 12345;
  const auto next = [&random] { return (random = random * 1664525u + 1013904223u) >> 8; };
  Bench bench;
  for (int i = 0; i < 60000; ++i) {
    const std::uint32_t kind = next() % 16;
    if (kind < 6) {
      bench.say.mode = static_cast<Mode>(next() % 5);
      bench.say.arm = static_cast<Arm>(next() % 8 == 0 ? next() % 3 : 2);
      if (next() % 8 == 0) bench.say.mode = Mode::kOff, bench.say.arm = Arm::kReady;
      bench.say.clear_faults = next() % 4 == 0;
      bench.say.capture = next() % 2 == 0;
      for (std::int16_t& value : bench.say.values) value = static_cast<std::int16_t>(next());
      bench.Say();
    } else if (kind < 10) {
      std::uint8_t frame[kDoSize];
      Asking asking{static_cast<Request>(0xd1 + next() % 3), static_cast<std::uint8_t>(next()),
                    static_cast<std::uint8_t>(next() % 4), next() << 8 | next() % 256,
                    static_cast<std::uint16_t>(next() % 2)};
      if (next() % 2 == 0) asking.what %= 40;
      Receive(frame, Encode(asking, frame), false, bench.board);
    } else if (kind < 12) {
      std::uint8_t noise[40];
      for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(next());
      Receive(noise, next() % 41, next() % 2 == 0, bench.board);
    }
    Inputs in{};
    in.elapsed = static_cast<std::uint8_t>(1 + (next() % 50 == 0 ? next() % 255 : 0));
    in.driver_fault = next() % 500 == 0;
    for (int m = 0; m < kMotors; ++m) {
      in.adc[m] = static_cast<std::uint16_t>(next() % 1024);
      in.encoder[m] = static_cast<std::uint16_t>(next());
    }
    Tick(in, bench.board);
    Feel(bench.board);
    DoSlowWork(bench.board);
    for (const MotorLoop& motor : bench.board.loops) {
      ASSERT_TRUE(motor.drive >= -400.0f && motor.drive <= 400.0f) << i;
      ASSERT_TRUE(std::isfinite(motor.set_point_n) && std::isfinite(motor.pid.integral)) << i;
    }
    std::uint8_t frame[kFrameSize];
    MakeFrame(bench.board, frame);
    ASSERT_TRUE(IsFrame(frame, sizeof frame, 0));
    bench.board.reply_due = false;
    if (bench.board.memory != Memory::kIdle && next() % 4 == 0) bench.board.memory = Memory::kIdle;
  }
}

// Motor off, unwound by its cable: no current flows, whatever the encoder shows.
TEST(Heat, IsNotOfAMotorThatCoasts) {
  Bench bench;
  bench.Run(300);
  const int before_c = bench.board.temperature_c[0];
  for (int i = 0; i < 2000; ++i) {
    bench.motors[0].wound_m -= 3e-4;  // 0.3 m/s
    bench.Run(1);
  }
  EXPECT_EQ(bench.board.mode, Mode::kOff);
  EXPECT_LE(bench.board.temperature_c[0], before_c);
  EXPECT_EQ(bench.board.faults[0], 0);
}

}  // namespace
}  // namespace taut::board
