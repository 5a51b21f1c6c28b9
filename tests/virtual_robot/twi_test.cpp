// Two-wire interface (I2C) of the boards: status codes recorded by the probe, and times in closed
// form. Codes: data sheet of the ATmega328P, tables "Status Codes for Slave Receiver Mode" and "...
// Slave Transmitter Mode".
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "tests/virtual_robot/probe_fixture.h"

namespace taut::virtual_robot {
namespace {

using TwiKind = BusStep::Kind;
using TwiBytes = std::vector<std::uint8_t>;

constexpr Time kTwiBit = 2'500 * kNanosecond;
constexpr Time kTwiByte = 9 * kTwiBit;

/// Boards and a bus, without motors
class Wires {
 public:
  explicit Wires(int boards) : bus(3) {
    for (int i = 0; i < boards; ++i) {
      all.push_back(std::make_unique<Board>(ProbeProgram(), BoardOptions{i, {}, drift_ppm * i}));
      bus.Attach(all.back()->bus_side());
    }
    RunTo(5 * kMillisecond);
  }

  void Advance(Time limit) {
    const Time next = std::min({limit, now + 20 * kMicrosecond, bus.SafeUntil(now)});
    ASSERT_GT(next, now);
    for (const auto& board : all) board->RunUntil(next);
    now = next;
    bus.Step(now);
  }
  void RunTo(Time until) {
    while (now < until) Advance(until);
  }
  BusResult Transfer(std::vector<BusStep> steps, Time limit = 100 * kMillisecond) {
    began = now;
    bus.Begin(now, std::move(steps), {});
    const Time end = now + limit;
    while (bus.Busy() && now < end) Advance(end);
    EXPECT_FALSE(bus.Busy());
    const BusResult result = bus.result();
    RunTo(now + 500 * kMicrosecond);  // interrupts caused by the stop
    return result;
  }
  Board& board(int i) { return *all[static_cast<std::size_t>(i)]; }
  /// Returns the codes since the last call.
  std::string Codes(int i) {
    Board& one = board(i);
    std::string text;
    for (int n = 0; n < one.Memory(kBoxStatusCount); ++n) {
      const unsigned char code = one.Memory(static_cast<std::uint16_t>(kBoxStatus + n));
      text += (n == 0 ? "" : " ") + Hex(&code, 1);
    }
    one.SetMemory(kBoxStatusCount, 0);
    return text;
  }

  static constexpr double drift_ppm = 40;
  I2cBus bus;
  std::vector<std::unique_ptr<Board>> all;
  Time now = 0, began = 0;
};

std::vector<BusStep> TwiWrite(std::uint8_t address, const TwiBytes& bytes) {
  std::vector<BusStep> steps{{TwiKind::kStart}, {TwiKind::kWrite, address}};
  for (const std::uint8_t byte : bytes) steps.push_back({TwiKind::kWrite, byte});
  steps.push_back({TwiKind::kStop});
  return steps;
}
std::vector<BusStep> TwiRead(std::uint8_t address, int count) {
  std::vector<BusStep> steps{{TwiKind::kStart}, {TwiKind::kWrite, address}};
  for (int i = 0; i < count; ++i) steps.push_back({TwiKind::kRead, 0, i + 1 < count});
  steps.push_back({TwiKind::kStop});
  return steps;
}
constexpr std::uint8_t To(int board) { return static_cast<std::uint8_t>((0x10 + board) << 1); }
constexpr std::uint8_t From(int board) { return static_cast<std::uint8_t>(To(board) | 1); }

TEST(Twi, AGeneralCallReachesAllBoards) {
  Wires wires(3);
  const TwiBytes message{0xC3, 1, 2, 3, 0xFF, 0x00};
  const BusResult result = wires.Transfer(TwiWrite(0, message));
  EXPECT_EQ(result.outcome, BusOutcome::kDone);
  EXPECT_EQ(result.written, 7);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(wires.Codes(i), "70 90 90 90 90 90 90 a0") << i;
    EXPECT_EQ(wires.board(i).Memory(kBoxReceivedCount), message.size());
    EXPECT_EQ(Bytes8(wires.board(i), kBoxReceived, 6), message);
  }
}

TEST(Twi, AnAddressReachesItsBoardAlone) {
  Wires wires(3);
  EXPECT_EQ(wires.Transfer(TwiWrite(To(1), {0xAB})).outcome, BusOutcome::kDone);
  EXPECT_EQ(wires.Codes(0), "");
  EXPECT_EQ(wires.Codes(1), "60 80 a0");
  EXPECT_EQ(wires.Codes(2), "");
}

TEST(Twi, SixteenBytesAreReadAtOnce) {
  Wires wires(2);
  TwiBytes expected;
  for (int i = 0; i < 16; ++i) {
    expected.push_back(static_cast<std::uint8_t>(17 * i + 3));
    wires.board(1).SetMemory(static_cast<std::uint16_t>(kBoxSend + i), expected.back());
  }
  const BusResult result = wires.Transfer(TwiRead(From(1), 16));
  EXPECT_EQ(result.read, expected);
  EXPECT_EQ(wires.Codes(1), "a8 b8 b8 b8 b8 b8 b8 b8 b8 b8 b8 b8 b8 b8 b8 b8 c0");
  EXPECT_EQ(wires.Codes(0), "");
  // An immediate second transfer shows that no state is left over.
  EXPECT_EQ(wires.Transfer(TwiRead(From(1), 16)).read, expected);
}

TEST(Twi, NobodyAnswersForABoardThatIsNotThere) {
  Wires wires(2);
  const BusResult result = wires.Transfer(TwiRead(From(5), 4));
  EXPECT_EQ(result.outcome, BusOutcome::kNoAcknowledge);
  EXPECT_EQ(result.written, 0);
  EXPECT_TRUE(result.read.empty());
  // Start, address, stop; no slave holds the clock.
  EXPECT_EQ(result.ended - wires.began, kTwiBit + kTwiByte + kTwiBit);
  EXPECT_EQ(wires.Codes(0) + wires.Codes(1), "");
}

TEST(Twi, ASlaveRefusesBytes) {
  Wires wires(1);
  wires.board(0).SetMemory(kBoxNackFrom, 3);
  const BusResult result = wires.Transfer(TwiWrite(To(0), {1, 2, 3, 4, 5}));
  EXPECT_EQ(result.outcome, BusOutcome::kNoAcknowledge);
  EXPECT_EQ(result.written, 3) << "the address and two bytes";
  EXPECT_EQ(wires.Codes(0), "60 80 80 88");
  wires.board(0).SetMemory(kBoxNackFrom, 0);
  EXPECT_EQ(wires.Transfer(TwiWrite(To(0), {6})).outcome, BusOutcome::kDone);
  EXPECT_EQ(wires.Codes(0), "60 80 a0");
}

// TWSTO of a slave: "... returns to a well-defined unaddressed slave mode"; it sends no stop.
TEST(Twi, ASlaveThatLetsGoIsNotAddressedUntilTheNextStart) {
  Wires wires(2);
  wires.board(0).SetMemory(kBoxLetGo, 2);
  const BusResult result = wires.Transfer(TwiWrite(To(0), {1, 2, 3, 4, 5}));
  EXPECT_EQ(result.outcome, BusOutcome::kNoAcknowledge);
  EXPECT_EQ(result.written, 3) << "the address and two bytes";
  EXPECT_EQ(wires.Codes(0), "60 80 80") << "not even a stop";
  EXPECT_EQ(wires.Transfer(TwiWrite(0, {0xC3, 1, 2})).outcome, BusOutcome::kDone);
  EXPECT_EQ(wires.Codes(0), "70 90 90");
  EXPECT_EQ(wires.Codes(1), "70 90 90 90 a0") << "others stay";
  wires.board(0).SetMemory(kBoxLetGo, 0);
  EXPECT_EQ(wires.Transfer(TwiWrite(To(0), {6})).outcome, BusOutcome::kDone);
  EXPECT_EQ(wires.Codes(0), "60 80 a0");
}

TEST(Twi, ABoardThatRefusesDoesNotStopAGeneralCall) {
  Wires wires(2);
  wires.board(0).SetMemory(kBoxNackFrom, 1);
  EXPECT_EQ(wires.Transfer(TwiWrite(0, {0xC3, 9, 9})).outcome, BusOutcome::kDone);
  EXPECT_EQ(wires.Codes(0), "70 98");
  EXPECT_EQ(wires.Codes(1), "70 90 90 90 a0");
}

TEST(Twi, ASlaveThatHasNoMoreSendsOnes) {
  Wires wires(1);
  for (std::uint16_t i = 0; i < 4; ++i) wires.board(0).SetMemory(kBoxSend + i, 0x21);
  wires.board(0).SetMemory(kBoxLastByte, 2);
  EXPECT_EQ(wires.Transfer(TwiRead(From(0), 4)).read, (TwiBytes{0x21, 0x21, 0xFF, 0xFF}));
  EXPECT_EQ(wires.Codes(0), "a8 b8 c8");
}

TEST(Twi, ARepeatedStartEndsAMessageAndBeginsTheNext) {
  Wires wires(1);
  wires.board(0).SetMemory(kBoxSend, 0x5A);
  const BusResult result = wires.Transfer({{TwiKind::kStart},
                                           {TwiKind::kWrite, To(0)},
                                           {TwiKind::kWrite, 0xD2},
                                           {TwiKind::kStart},
                                           {TwiKind::kWrite, From(0)},
                                           {TwiKind::kRead, 0, false},
                                           {TwiKind::kStop}});
  EXPECT_EQ(result.outcome, BusOutcome::kDone);
  EXPECT_EQ(result.read, TwiBytes{0x5A});
  EXPECT_EQ(wires.Codes(0), "60 80 a0 a8 c0");
}

TEST(Twi, TheClockIsHeldForAsLongAsTheInterruptTakes) {
  // The time of a byte is 9 bits plus the wait for the slowest interrupt. The difference between
  // two lengths of the interrupt is exact to the cycle: a loop of the probe.
  constexpr int kBytes = 6;
  Time took[3] = {};
  for (const int extra : {0, 1, 4}) {
    Wires wires(1);
    wires.board(0).SetMemory(kBoxStretch, static_cast<std::uint8_t>(extra));
    const BusResult result = wires.Transfer(TwiWrite(To(0), TwiBytes(kBytes, 0xEE)));
    took[extra == 4 ? 2 : extra] = result.ended - wires.began;
    EXPECT_EQ(wires.Codes(0), "60 80 80 80 80 80 80 a0");
    const StretchStats& stretch = wires.bus.stretch();
    EXPECT_EQ(stretch.bytes, kBytes + 1U);
    // The statistics contain all waits except the last, for the stop.
    const Time waits = took[extra == 4 ? 2 : extra] - 2 * kTwiBit - (kBytes + 1) * kTwiByte;
    EXPECT_NEAR(ToSeconds(stretch.sum), ToSeconds(waits) * kBytes / (kBytes + 1), 4e-6);
  }
  const Time plain = took[0] - 2 * kTwiBit - (kBytes + 1) * kTwiByte;
  EXPECT_GT(plain, (kBytes + 1) * kMicrosecond);
  EXPECT_LT(plain, (kBytes + 1) * 10 * kMicrosecond);
  const double one = ToSeconds(took[1] - took[0]), four = ToSeconds(took[2] - took[0]);
  EXPECT_NEAR(one / (kBytes + 1), 10e-6, 1e-6);
  EXPECT_NEAR(four, 4 * one, 2e-6);
}

TEST(Twi, TheSlowestBoardSetsThePaceOfAGeneralCall) {
  const auto took = [](std::initializer_list<int> stretches) {
    Wires wires(3);
    int i = 0;
    for (const int stretch : stretches) {
      wires.board(i++).SetMemory(kBoxStretch, static_cast<std::uint8_t>(stretch));
    }
    const BusResult result = wires.Transfer(TwiWrite(0, {0xC3, 1, 2, 3}));
    EXPECT_EQ(result.outcome, BusOutcome::kDone);
    return ToSeconds(result.ended - wires.began);
  };
  const double one = took({0, 3, 0}), all = took({3, 3, 3}), none = took({0, 0, 0});
  EXPECT_GT(one, none + 5 * 25e-6);
  EXPECT_NEAR(one, all, 5 * 3e-6);
}

TEST(Twi, AHungBoardHoldsTheClockUntilTheMasterGivesUp) {
  Wires wires(2);
  wires.board(0).Hang();
  const BusResult result = wires.Transfer(TwiWrite(0, {0xC3, 1}));
  EXPECT_EQ(result.outcome, BusOutcome::kStuck);
  EXPECT_NEAR(ToSeconds(result.ended - wires.began), 25e-3, 0.1e-3);
  // The watchdog resets the board, which leaves the bus; then transfers work again.
  wires.RunTo(wires.now + 100 * kMillisecond);
  wires.Codes(0), wires.Codes(1);
  EXPECT_EQ(wires.Transfer(TwiWrite(0, {0xC3, 1})).outcome, BusOutcome::kDone);
  EXPECT_EQ(wires.Codes(0), "70 90 90 a0");
  EXPECT_EQ(wires.Codes(1), "a0 70 90 90 a0") << "only the next start ended the message for it";
}

TEST(Twi, AnIllegalStartIsSeenAsABusErrorAndRecoveredFrom) {
  Wires wires(2);
  wires.bus.DisturbNextByte();
  EXPECT_EQ(wires.Transfer(TwiWrite(0, {0xC3, 1, 2})).outcome, BusOutcome::kError);
  EXPECT_EQ(wires.Codes(0), "") << "before it was addressed it is nothing to it";
  std::vector<BusStep> steps = TwiWrite(To(1), {0xC3, 1, 2});
  wires.began = wires.now;
  wires.bus.Begin(wires.now, steps, {});
  wires.RunTo(wires.now + 40 * kMicrosecond);  // within the first byte after the address
  wires.bus.DisturbNextByte();
  wires.RunTo(wires.now + kMillisecond);
  EXPECT_EQ(wires.bus.result().outcome, BusOutcome::kError);
  EXPECT_EQ(wires.Codes(1).substr(0, 2), "60");
  EXPECT_EQ(wires.Transfer(TwiWrite(To(1), {7})).outcome, BusOutcome::kDone);
  EXPECT_EQ(wires.Codes(1), "60 80 a0");
}

TEST(Twi, WhatIsDueInTheCycleThatACoreHasEndedHappensAtOnce) {
  // The core has already reached that time, and does not run again before the bus queries it.
  for (int extra = 0; extra < 40; ++extra) {
    Board board(ProbeProgram(), {});
    const Time time = 5 * kMillisecond + extra * 31 * kNanosecond;
    board.RunUntil(time);
    I2cSlave& slave = board.bus_side();
    slave.Schedule({.kind = BusEvent::Kind::kAddress, .at = time, .byte = 0x20});
    board.RunUntil(time);
    EXPECT_TRUE(slave.Acked() && slave.HoldsClock()) << extra;
  }
}

TEST(Twi, WhatIsDueWhileACoreEntersAnInterruptHappensBeforeTheBusLooks) {
  Board board(ProbeProgram(), {});
  board.RunUntil(5 * kMillisecond);
  I2cSlave& slave = board.bus_side();
  // The tick comes every 16000 cycles; events from just before it to just after.
  for (int cycles = 0; cycles < 16'000; cycles += 3) {
    const Time from = board.now() + (cycles % 60) * 63 * kNanosecond;
    const Time due = from + (cycles % 13) * 63 * kNanosecond;
    slave.Schedule({.kind = BusEvent::Kind::kAddress, .at = due, .byte = 0x20});
    board.RunUntil(from);
    board.RunUntil(due);
    ASSERT_TRUE(slave.Acked()) << cycles;
    board.RunUntil(due + 40 * kMicrosecond);
    slave.Schedule({.kind = BusEvent::Kind::kStop, .at = board.now() + kMicrosecond});
    board.RunUntil(board.now() + 100 * kMicrosecond);
  }
}

TEST(Twi, TheNextMessageWaitsForTheInterruptOfTheLast) {
  Wires wires(1);
  wires.board(0).SetMemory(kBoxStretch, 9);
  wires.began = wires.now;
  wires.bus.Begin(wires.now, TwiWrite(To(0), {1}), {});
  while (wires.bus.Busy()) wires.Advance(wires.now + kSecond);
  wires.bus.Begin(wires.now, TwiWrite(To(0), {2}), {});  // the interrupt of the stop has just begun
  while (wires.bus.Busy()) wires.Advance(wires.now + kSecond);
  wires.RunTo(wires.now + kMillisecond);
  EXPECT_EQ(wires.Codes(0), "60 80 a0 60 80 a0");
  EXPECT_EQ(wires.board(0).Memory(kBoxReceived), 2);
}

}  // namespace
}  // namespace taut::virtual_robot
