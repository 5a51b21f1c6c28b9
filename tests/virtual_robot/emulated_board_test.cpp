// One emulated board with the probe's program
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/virtual_robot/board_fixture.h"

namespace taut::virtual_robot {
namespace {

TEST(Board, HasTheIdentityOfItsEeprom) {
  Board board(ProbeProgram(), {.id = 4});
  RunTo(board, kBoot);
  EXPECT_EQ(board.Memory(kBoxId), 4);
  EXPECT_EQ(board.Eeprom()[0], 4);
  EXPECT_EQ(board.Eeprom()[1], 0xFF);
  EXPECT_EQ(board.Memory(kBoxCause), 1) << "power on";
  EXPECT_EQ(board.Memory(kBoxBoots), 1);
}

TEST(Board, TicksOnceAMillisecondToTheCycle) {
  Board board(ProbeProgram(), {});
  std::vector<std::uint64_t> begins;
  board.on_marker = [&](std::uint64_t cycle, std::uint8_t value) {
    if (value == 1) begins.push_back(cycle);
  };
  RunTo(board, 1005 * kMillisecond);
  ASSERT_GE(begins.size(), 1000U);
  const std::uint64_t span = begins[1000 - 1] - begins[0];
  EXPECT_NEAR(static_cast<double>(span), 999.0 * 16000,
              20.0);  // 20: an interrupt may delay the tick
  EXPECT_EQ(Long(board, kBoxTicks), begins.size());
}

TEST(Board, NeverRunsFarBeyondWhereItWasSentWhateverItSleeps) {
  // Limit for all cores: asleep at the end of a run, falling asleep with the last instruction, or
  // awake. The longest instruction takes 5 cycles, an interrupt 8 more.
  for (const Time slice : {137 * kNanosecond, 1009 * kNanosecond, 20 * kMicrosecond}) {
    Board board(ProbeProgram(), {});
    std::uint64_t most = 0;
    for (Time until = slice; until < 20 * kMillisecond; until += slice) {
      board.RunUntil(until);
      const auto wanted = static_cast<std::uint64_t>(until * 16 / kMicrosecond);
      ASSERT_GE(board.cycle(), wanted);
      most = std::max(most, board.cycle() - wanted);
    }
    EXPECT_LE(most, 13U);
  }
}

TEST(Board, AnInterruptTakesItsTimeToBegin) {
  // Data sheet, "Interrupt Response Time": four cycles, four more out of sleep, and the vector's
  // jump of three. An awake core first finishes its instruction, which adds zero to two cycles.
  Diagnostics found;
  const auto program = ReadAvrProgram(TAUT_LATENCY_ELF, found);
  ASSERT_TRUE(program) << found.Format();
  Board board(program, {});
  for (int i = 0; i < 200; ++i) {
    board.SetMemory(0x131, 0);
    RunTo(board, board.now() + 37 * kMicrosecond);
    EXPECT_GE(board.Memory(0x130), 4 + 3);
    EXPECT_LE(board.Memory(0x130), 4 + 3 + 2);
    board.SetMemory(0x131, 1);
    RunTo(board, board.now() + 50 * kMicrosecond);
    EXPECT_EQ(board.Memory(0x130), 4 + 4 + 3);
  }
}

TEST(Board, AClockThatIsFastByAThousandthTicksAThousandthMore) {
  Board right(ProbeProgram(), {}), fast(ProbeProgram(), {.drift_ppm = 1000}),
      slow(ProbeProgram(), {.drift_ppm = -5000});
  for (Board* board : {&right, &fast, &slow}) RunTo(*board, kSecond);
  EXPECT_EQ(right.cycle() / 100, 160'000U);
  EXPECT_NEAR(static_cast<double>(fast.cycle()), 16'016'000.0, 10.0);
  EXPECT_NEAR(static_cast<double>(slow.cycle()), 15'920'000.0, 10.0);
  EXPECT_EQ(Long(fast, kBoxTicks), Long(right, kBoxTicks) + 1);
  EXPECT_EQ(Long(slow, kBoxTicks), Long(right, kBoxTicks) - 5);
  slow.SetDrift(kSecond, 0);
  const std::uint64_t before = slow.cycle();
  RunTo(slow, 2 * kSecond);
  EXPECT_NEAR(static_cast<double>(slow.cycle() - before), 16e6, 10.0);
}

TEST(Board, DutyDirectionAndEnableArriveAtTheMotors) {
  Board board(ProbeProgram(), {});
  RunTo(board, kBoot);
  EXPECT_FALSE(board.Drive(0).enabled);
  for (const int duty : {0, 1, 100, 257, 399, 400}) {
    for (const int winds_in : {0, 1, 2, 3}) {
      for (int motor = 0; motor < 2; ++motor) {
        const int code = motor == 0 ? duty : 400 - duty;
        board.SetMemory(static_cast<std::uint16_t>(kBoxDuty + 2 * motor),
                        static_cast<std::uint8_t>(code));
        board.SetMemory(static_cast<std::uint16_t>(kBoxDuty + 2 * motor + 1),
                        static_cast<std::uint8_t>(code >> 8));
      }
      board.SetMemory(kBoxWindsIn, static_cast<std::uint8_t>(winds_in));
      board.SetMemory(kBoxEnable, 1);
      board.SetMemory(kBoxNewDuty, 1);
      RunTo(board, board.now() + 2 * kMillisecond);
      const double first = duty / 400.0, second = (400 - duty) / 400.0;
      EXPECT_EQ(board.Drive(0).duty, (winds_in & 1) ? first : -first);
      EXPECT_EQ(board.Drive(1).duty, (winds_in & 2) ? second : -second);
      EXPECT_TRUE(board.Drive(0).enabled && board.Drive(1).enabled);
    }
  }
  RunTo(board,
        board.now() + 110 * kMillisecond);  // without messages the probe switches its motors off
  EXPECT_FALSE(board.Drive(0).enabled);
}

// Only mode 8 of Timer 1 is emulated. A program that selects another mode, inverts its outputs or
// stops its clock drives nothing, so that a wrong program cannot appear to work.
TEST(Board, OtherModesOfItsTimerDriveNothing) {
  Board board(ProbeProgram(), {});
  RunTo(board, kBoot);
  board.SetMemory(kBoxDuty, 100);
  board.SetMemory(kBoxDuty + 2, 100);
  board.SetMemory(kBoxEnable, 1);
  board.SetMemory(kBoxNewDuty, 1);
  RunTo(board, board.now() + 2 * kMillisecond);
  ASSERT_NEAR(std::fabs(board.Drive(0).duty), 0.25, 1e-12);
  constexpr std::uint8_t kOutputs = 0xA0, kInverted = 0xF0, kMode8 = 0x11;
  for (const auto& [a, b] :
       std::vector<std::pair<int, int>>{{kOutputs, 0x01},      // 0, normal
                                        {kOutputs | 1, 0x01},  // 1, eight bits
                                        {kOutputs, 0x09},      // 4, clear on compare
                                        {kOutputs | 2, 0x19},  // 14, fast
                                        {kInverted, kMode8},
                                        {kOutputs, 0x10}}) {  // 8, without a clock
    board.SetMemory(kBoxTimer1, static_cast<std::uint8_t>(a));
    board.SetMemory(kBoxTimer1 + 1, static_cast<std::uint8_t>(b));
    board.SetMemory(kBoxOrder, kOrderTimer1);
    RunTo(board, board.now() + 2 * kMillisecond);
    EXPECT_EQ(board.Drive(0).duty, 0) << a << " " << b;
    EXPECT_EQ(board.Drive(1).duty, 0) << a << " " << b;
  }
  board.SetMemory(kBoxTimer1, kOutputs);
  board.SetMemory(kBoxTimer1 + 1, kMode8);
  board.SetMemory(kBoxOrder, kOrderTimer1);
  RunTo(board, board.now() + 2 * kMillisecond);
  EXPECT_NEAR(std::fabs(board.Drive(0).duty), 0.25, 1e-12);
}

TEST(Board, EveryCodeOfTheConverterIsRead) {
  Board board(ProbeProgram(), {});
  int code[2] = {0, 0};
  board.adc_code = [&](int channel, Time) { return code[channel]; };
  RunTo(board, kBoot);
  for (int value = 0; value < 1024; ++value) {
    code[0] = value;
    code[1] = 1023 - value;
    RunTo(board, board.now() + 2 * kMillisecond);
    ASSERT_EQ(Word(board, kBoxAdc), value);
    ASSERT_EQ(Word(board, kBoxAdc + 2), 1023 - value);
  }
  EXPECT_EQ(board.Memory(kBoxBandgap), 225) << "1.1 V of 5 V";
  EXPECT_EQ(Word(board, kBoxEarly), 225)
      << "until a conversion ends, the result is that of the last";
}

TEST(Board, AConversionShowsWhatWasThereWhenItBegan) {
  Board board(ProbeProgram(), {});
  std::vector<Time> begins;
  board.adc_code = [&](int, Time at) {
    begins.push_back(at);
    return static_cast<int>(begins.size() % 1024);
  };
  RunTo(board, kBoot);
  // Conversions after a tick of the probe: 13 cycles of 125 kHz each, plus the interrupt.
  ASSERT_GE(begins.size(), 6U);
  const std::size_t tick = begins.size() / 2 * 2 - 2;
  EXPECT_NEAR(ToSeconds(begins[tick + 1] - begins[tick]), 104e-6, 8e-6);
  const int second = static_cast<int>(begins.size());
  EXPECT_EQ(std::max(Word(board, kBoxAdc), Word(board, kBoxAdc + 2)), second);
}

TEST(Board, QuadratureAtTenThousandStatesASecondLosesNothing) {
  Board board(ProbeProgram(), {});
  RunTo(board, kBoot);
  constexpr int kStates = 8000;  // 0.8 s
  const Time from = board.now();
  int sent = 0;
  std::vector<EncoderEdge> all = Edges(kStates, from, from + 800 * kMillisecond);
  while (sent < kStates) {
    std::vector<EncoderEdge> forth, back;
    for (;
         sent < kStates && all[static_cast<std::size_t>(sent)].at < board.now() + 20 * kMicrosecond;
         ++sent) {
      forth.push_back(all[static_cast<std::size_t>(sent)]);
      back.push_back(
          Edges(-(sent + 1), 0, 1).back());  // the same number of states in the other direction
      back.back().at = forth.back().at;
    }
    board.SetEncoderEdges(0, forth);
    board.SetEncoderEdges(1, back);
    board.RunUntil(board.now() + 20 * kMicrosecond);
  }
  RunTo(board, board.now() + kMillisecond);
  EXPECT_EQ(Count(board, 0), kStates / 2) << "A changes with every second state";
  EXPECT_EQ(Count(board, 1), -kStates / 2);
  EXPECT_EQ(board.resets(), 0U);
}

TEST(Board, MeasuresItsStack) {
  Board board(ProbeProgram(), {});
  RunTo(board, 100 * kMillisecond);
  // Stack: main's return address and at most one interrupt of the probe with its saved registers.
  EXPECT_GT(board.DeepestStack(), 10);
  EXPECT_LT(board.DeepestStack(), 60);
  EXPECT_EQ(board.StaticMemory(), 0x103) << "the mailbox and three bytes";
}

TEST(AvrProgram, RefusesWhatIsNone) {
  Diagnostics found;
  EXPECT_EQ(ReadAvrProgram("/nowhere.elf", found), nullptr);
  EXPECT_EQ(ReadAvrProgram(TAUT_SOURCE_DIR "/README.md", found), nullptr);
  EXPECT_EQ(ReadAvrProgram("/bin/true", found), nullptr);
  ASSERT_EQ(found.items().size(), 3U) << found.Format();
  EXPECT_NE(found.items()[1].what.find("is not an ELF file"), std::string::npos);
  EXPECT_NE(found.items()[1].hint.find("avr-gcc"), std::string::npos);
  EXPECT_NE(found.items()[2].what.find("for another machine"), std::string::npos);
}

}  // namespace
}  // namespace taut::virtual_robot
