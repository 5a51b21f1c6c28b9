// The I2C bus alone, with minimal slaves
#include "apps/virtual_robot/i2c_bus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/virtual_robot/fake_slave.h"

namespace taut::virtual_robot {
namespace {

using Kind = BusStep::Kind;
using Bytes = std::vector<std::uint8_t>;

constexpr Time kBit = 2'500 * kNanosecond;
constexpr Time kByte = 9 * kBit;

std::vector<BusStep> Write(std::uint8_t address, const Bytes& bytes) {
  std::vector<BusStep> steps{{Kind::kStart}, {Kind::kWrite, address}};
  for (const std::uint8_t byte : bytes) steps.push_back({Kind::kWrite, byte});
  steps.push_back({Kind::kStop});
  return steps;
}
std::vector<BusStep> Read(std::uint8_t address, int count) {
  std::vector<BusStep> steps{{Kind::kStart}, {Kind::kWrite, address}};
  for (int i = 0; i < count; ++i) steps.push_back({Kind::kRead, 0, i + 1 < count});
  steps.push_back({Kind::kStop});
  return steps;
}

/// Advances time as far as the bus allows, at most 20 us at a time.
void Finish(I2cBus& bus, Time& now, Time limit = kSecond) {
  const Time end = now + limit;
  while (bus.Busy() && now < end) {
    const Time next = std::min(now + 20 * kMicrosecond, bus.SafeUntil(now));
    ASSERT_GT(next, now);
    now = next;
    bus.Step(now);
  }
}

TEST(I2cBus, TakesNineBitsAByteAndOneForStartAndStop) {
  for (const Time bit : {kSecond / 20'000, kBit, kSecond / 1'000'000}) {
    I2cBus bus(1);
    FakeSlave slave(0x10);
    bus.Attach(slave);
    Time now = 3 * kMicrosecond;
    bus.Begin(now, Write(0x20, {1, 2, 3}), {.bit = bit});
    Finish(bus, now);
    EXPECT_EQ(bus.result().outcome, BusOutcome::kDone);
    EXPECT_EQ(bus.result().ended, 3 * kMicrosecond + 2 * bit + 4 * 9 * bit);
    EXPECT_EQ(slave.received, (Bytes{1, 2, 3}));
  }
}

TEST(I2cBus, AGapAndAHeldClockAreAddedToEachByte) {
  I2cBus bus(1);
  FakeSlave slave(0x10);
  slave.hold = 7 * kMicrosecond;
  bus.Attach(slave);
  Time now = 0;
  bus.Begin(now, Write(0x20, {1, 2, 3}), {.byte_gap = 2 * kMicrosecond});
  Finish(bus, now);
  EXPECT_EQ(bus.result().ended, 2 * kBit + 4 * (kByte + 9 * kMicrosecond));
  EXPECT_EQ(bus.stretch().longest, 7 * kMicrosecond);
  EXPECT_EQ(bus.stretch().sum, 3 * 7 * kMicrosecond) << "the last one delays the stop";
}

TEST(I2cBus, NothingHappensBeforeSlavesHaveHeardOfIt) {
  for (const Time hold : {Time{0}, 100 * kNanosecond, 7 * kMicrosecond, 39 * kMicrosecond}) {
    for (const std::size_t takes : {std::size_t{0}, std::size_t{2}, SIZE_MAX}) {
      I2cBus bus(1);
      FakeSlave slave(0x10);
      slave.hold = hold;
      slave.takes = takes;
      bus.Attach(slave);
      Time now = 0;
      slave.now = &now;
      for (const auto& steps : {Write(0x20, {1, 2, 3, 4}), Read(0x21, 3), Write(0x30, {1})}) {
        bus.Begin(now, steps, {});
        while (bus.Busy()) {
          now = bus.SafeUntil(now);
          bus.Step(now);
        }
      }
      EXPECT_FALSE(slave.late);
    }
  }
}

TEST(I2cBus, WhatTwoSendIsTheAndOfIt) {
  I2cBus bus(1);
  FakeSlave one(0x10), other(0x10);
  one.send_from = 0xF0;
  other.send_from = 0x3C;
  bus.Attach(one);
  bus.Attach(other);
  Time now = 0;
  bus.Begin(now, Read(0x21, 2), {});
  Finish(bus, now);
  EXPECT_EQ(bus.result().read, (Bytes{0xF0 & 0x3C, 0xF1 & 0x3D}));
}

TEST(I2cBus, WithoutAStopAfterARefusalTheBusStaysOpen) {
  I2cBus bus(1);
  FakeSlave slave(0x10);
  slave.takes = 1;
  bus.Attach(slave);
  Time now = 0;
  bus.Begin(now, Write(0x20, {1, 2, 3}), {}, false);
  Finish(bus, now);
  EXPECT_EQ(bus.result().outcome, BusOutcome::kNoAcknowledge);
  EXPECT_EQ(slave.events.back().kind, BusEvent::Kind::kByte);
  bus.Begin(now, Write(0x20, {4}), {});
  Finish(bus, now);
  EXPECT_EQ(slave.events.back().kind, BusEvent::Kind::kStop);
}

TEST(I2cBus, NoiseTurnsOverItsShareOfBitsTheSameEveryTime) {
  const auto run = [](std::uint64_t seed, double share, Bytes& received) {
    I2cBus bus(seed);
    FakeSlave slave(0x10);
    slave.general_call = true;
    bus.Attach(slave);
    Time now = 0;
    for (int i = 0; i < 2000; ++i) {
      bus.SetNoise(0.0);
      bus.Begin(now, Write(0x20, Bytes(10, 0x55)), {});
      while (slave.received.size() < static_cast<std::size_t>(10 * i + 1) && bus.Busy()) {
        now = bus.SafeUntil(now);
        bus.Step(now);
      }
      bus.SetNoise(share);
      Finish(bus, now);
      slave.received.resize(static_cast<std::size_t>(10 * (i + 1)), 0x55);
    }
    received = slave.received;
    return bus.flipped_bits();
  };
  Bytes first, again, other, none;
  const std::uint64_t flips = run(1, 0.01, first);
  // A refused byte ends a message early: draws are 9 bits per byte for at most 9 bytes.
  EXPECT_GT(flips, 2000 * 9 * 3 * 0.01);
  EXPECT_LT(flips, 2000 * 9 * 10 * 0.01 * 1.1);
  EXPECT_EQ(run(1, 0.01, again), flips);
  EXPECT_EQ(first, again);
  run(2, 0.01, other);
  EXPECT_NE(first, other);
  EXPECT_EQ(run(1, 0.0, none), 0U);
  EXPECT_EQ(none, Bytes(20'000, 0x55));
}

TEST(I2cBus, BitsFlipIndependently) {
  I2cBus bus(9);
  FakeSlave slave(0x10);
  bus.Attach(slave);
  bus.SetNoise(0.05);
  Time now = 0;
  std::uint64_t sent = 0, wrong = 0, ones[8] = {};
  for (int i = 0; i < 3000; ++i) {
    bus.Begin(now, {{Kind::kWrite, 0x00}}, {});  // counting flips needs no slave
    Finish(bus, now);
    ++sent;
    const std::uint8_t byte = slave.events.back().byte;
    for (int bit = 0; bit < 8; ++bit) ones[bit] += (byte >> bit) & 1U;
    wrong += byte != 0;
  }
  const auto n = static_cast<double>(sent);
  for (const std::uint64_t count : ones) {
    EXPECT_NEAR(static_cast<double>(count), 0.05 * n, 5 * std::sqrt(0.05 * 0.95 * n));
  }
  EXPECT_NEAR(static_cast<double>(wrong), (1 - std::pow(0.95, 8)) * n, 5 * std::sqrt(0.25 * n));
}

TEST(I2cBus, ALineHeldLowStopsTheMasterUntilItIsFreeOrPatienceEnds) {
  for (const bool data : {true, false}) {
    I2cBus bus(1);
    FakeSlave slave(0x10);
    bus.Attach(slave);
    const auto hold = [&](bool low) { data ? bus.HoldDataLow(low) : bus.HoldClockLow(low); };
    hold(true);
    Time now = 0;
    bus.Begin(now, Write(0x20, {1}), {});
    Finish(bus, now);
    EXPECT_EQ(bus.result().outcome, BusOutcome::kStuck);
    EXPECT_NEAR(ToSeconds(bus.result().ended), 25e-3, 30e-6);
    const Time begun = now;
    bus.Begin(now, Write(0x20, {1}), {});
    Finish(bus, now, 10 * kMillisecond);
    ASSERT_TRUE(bus.Busy());
    hold(false);
    Finish(bus, now);
    EXPECT_EQ(bus.result().outcome, BusOutcome::kDone);
    EXPECT_NEAR(ToSeconds(bus.result().ended - begun), 10e-3 + ToSeconds(2 * kBit + 2 * kByte),
                30e-6);
  }
}

TEST(I2cBus, DataHeldLowReadsAsZeros) {
  I2cBus bus(1);
  FakeSlave slave(0x10);
  bus.Attach(slave);
  Time now = 0;
  bus.Begin(now, Read(0x21, 3), {});
  now = bus.SafeUntil(now);
  bus.Step(now);
  while (slave.events.size() < 3) {
    now = bus.SafeUntil(now);
    bus.Step(now);
  }
  bus.HoldDataLow(true);
  Finish(bus, now);
  EXPECT_EQ(bus.result().read, (Bytes{0x40, 0, 0})) << "the first was on its way";
}

TEST(I2cBus, AMasterThatIsGoneSendsNoStop) {
  I2cBus bus(1);
  FakeSlave slave(0x10);
  bus.Attach(slave);
  Time now = 0;
  bus.Begin(now, Write(0x20, {1, 2, 3}), {});
  while (slave.received.empty()) {
    now = bus.SafeUntil(now);
    bus.Step(now);
  }
  bus.Abandon(now);
  Finish(bus, now);
  EXPECT_EQ(bus.result().outcome, BusOutcome::kError);
  EXPECT_NE(slave.events.back().kind, BusEvent::Kind::kStop);
}

}  // namespace
}  // namespace taut::virtual_robot
