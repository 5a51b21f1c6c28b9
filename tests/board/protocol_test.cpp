// Protocol between PC and boards: checksums with published values, encoding and decoding of every
// message, detection of every single error.
#include "taut/board/protocol.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace taut::board {
namespace {

constexpr std::uint8_t kCheck[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};

TEST(BoardCrc, HasThePublishedCheckValues) {
  EXPECT_EQ(Crc16(kCheck, sizeof kCheck), 0x29b1);
  EXPECT_EQ(Crc8(kCheck, sizeof kCheck), 0xf4);
}

// The definition of a CRC, bit by bit.
TEST(BoardCrc, IsThePolynomialsRemainder) {
  std::uint16_t crc16 = kCrc16Start;
  std::uint8_t crc8 = kCrc8Start;
  std::uint32_t random = 1;
  for (int i = 0; i < 2000; ++i) {
    random = random * 1664525u + 1013904223u;
    const auto byte = static_cast<std::uint8_t>(random >> 24);
    std::uint32_t slow16 = crc16 ^ static_cast<std::uint32_t>(byte << 8), slow8 = crc8 ^ byte;
    for (int bit = 0; bit < 8; ++bit) {
      slow16 = (slow16 & 0x8000u) != 0 ? (slow16 << 1) ^ 0x1021u : slow16 << 1;
      slow8 = (slow8 & 0x80u) != 0 ? (slow8 << 1) ^ 0x07u : slow8 << 1;
    }
    crc16 = AddToCrc16(crc16, byte);
    crc8 = AddToCrc8(crc8, byte);
    ASSERT_EQ(crc16, slow16 & 0xffffu);
    ASSERT_EQ(crc8, slow8 & 0xffu);
  }
}

Cyclic SomeCyclic() {
  Cyclic message;
  message.sequence = 200;
  message.mode = Mode::kImpedance;
  message.capture = true;
  message.arm = Arm::kGo;
  for (int i = 0; i < kCables; ++i) message.values[i] = static_cast<std::int16_t>(-3000 + 541 * i);
  return message;
}

TEST(BoardProtocol, EveryBoardReadsItsPartOfABroadcast) {
  const Cyclic sent = SomeCyclic();
  std::uint8_t frame[kCyclicSize];
  Encode(sent, frame);
  EXPECT_EQ(frame[0], 0xc1);
  EXPECT_EQ(frame[0] & 1, 1) << "an even first byte after the general call means something to I2C";
  for (std::uint8_t board = 0; board < kBoards; ++board) {
    Command got;
    ASSERT_EQ(Decode(frame, sizeof frame, static_cast<std::uint8_t>(2 * board), got),
              Decoded::kGood);
    EXPECT_EQ(got.sequence, 200);
    EXPECT_EQ(got.mode, Mode::kImpedance);
    EXPECT_TRUE(got.capture);
    EXPECT_FALSE(got.clear_faults);
    EXPECT_FALSE(got.zero_inputs);
    EXPECT_EQ(got.arm, Arm::kGo);
    EXPECT_EQ(got.values[0], sent.values[2 * board]);
    EXPECT_EQ(got.values[1], sent.values[2 * board + 1]);
  }
}

TEST(BoardProtocol, EachFlagHasABitOfItsOwn) {
  for (int flags = 0; flags < 8; ++flags) {
    for (int arm = 0; arm < 3; ++arm) {
      Cyclic sent;
      sent.capture = (flags & 1) != 0;
      sent.clear_faults = (flags & 2) != 0;
      sent.zero_inputs = (flags & 4) != 0;
      sent.arm = static_cast<Arm>(arm);
      std::uint8_t frame[kCyclicSize];
      Encode(sent, frame);
      Command got;
      ASSERT_EQ(Decode(frame, sizeof frame, 0, got), Decoded::kGood);
      EXPECT_EQ(got.capture, sent.capture);
      EXPECT_EQ(got.clear_faults, sent.clear_faults);
      EXPECT_EQ(got.zero_inputs, sent.zero_inputs);
      EXPECT_EQ(got.arm, sent.arm);
    }
  }
}

// A CRC of 16 bits detects every burst of up to 16 bits.
TEST(BoardProtocol, NoBurstOfDamagePassesForABroadcast) {
  std::uint8_t good[kCyclicSize];
  Encode(SomeCyclic(), good);
  for (std::size_t first = 0; first < 8 * kCyclicSize; ++first) {
    for (std::uint32_t pattern = 1; pattern < 0x10000u; pattern += 2 * 37) {
      std::uint8_t frame[kCyclicSize];
      std::memcpy(frame, good, sizeof frame);
      for (std::size_t bit = 0; bit < 16 && first + bit < 8 * kCyclicSize; ++bit) {
        if ((pattern >> bit & 1u) != 0)
          frame[(first + bit) / 8] ^= static_cast<std::uint8_t>(0x80u >> (first + bit) % 8);
      }
      Command got;
      ASSERT_NE(Decode(frame, sizeof frame, 0, got), Decoded::kGood) << first << " " << pattern;
    }
  }
}

TEST(BoardProtocol, SaysWhatIsWrongWithABroadcast) {
  std::uint8_t frame[kCyclicSize];
  Encode(SomeCyclic(), frame);
  Command got;
  EXPECT_EQ(Decode(frame, kCyclicSize - 1, 0, got), Decoded::kWrongSize);
  EXPECT_EQ(Decode(frame, 0, 0, got), Decoded::kUnknown);
  frame[0] = 0xc2;
  EXPECT_EQ(Decode(frame, kCyclicSize, 0, got), Decoded::kWrongVersion);
  frame[0] = 0x31;
  EXPECT_EQ(Decode(frame, kCyclicSize, 0, got), Decoded::kUnknown);
  for (int mode = 5; mode < 8; ++mode) {  // a reply or a stop is never commanded this way
    Cyclic odd = SomeCyclic();
    odd.mode = static_cast<Mode>(mode);
    Encode(odd, frame);
    EXPECT_EQ(Decode(frame, kCyclicSize, 0, got), Decoded::kWrongValue);
  }
  Cyclic odd = SomeCyclic();
  odd.arm = static_cast<Arm>(3);
  Encode(odd, frame);
  EXPECT_EQ(Decode(frame, kCyclicSize, 0, got), Decoded::kWrongValue);
}

TEST(BoardProtocol, StopIsKnownAndNothingElseIsStop) {
  std::uint8_t frame[kStopSize];
  EncodeStop(frame);
  EXPECT_TRUE(IsStop(frame, sizeof frame));
  EXPECT_FALSE(IsStop(frame, sizeof frame - 1));
  for (std::size_t bit = 0; bit < 8 * kStopSize; ++bit) {
    frame[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    EXPECT_FALSE(IsStop(frame, sizeof frame));
    Command command;
    EXPECT_NE(Decode(frame, sizeof frame, 0, command), Decoded::kGood);
    frame[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
  }
}

TEST(BoardProtocol, RequestsAreReadAsTheyWereWritten) {
  const Asking all[] = {{Request::kSet, 7, 1, 0x3f800000u, 0},
                        {Request::kAsk, 0xf0, 2, 0, 0},
                        {Request::kDo, 0xe4, 0, 0xfffffff0u, 0x1234}};
  for (const Asking& sent : all) {
    std::uint8_t frame[kDoSize];
    const std::size_t size = Encode(sent, frame);
    EXPECT_EQ(size, SizeOf(sent.request));
    Asking got;
    ASSERT_EQ(Decode(frame, size, got), Decoded::kGood);
    EXPECT_EQ(got.request, sent.request);
    EXPECT_EQ(got.what, sent.what);
    EXPECT_EQ(got.index, sent.index);
    EXPECT_EQ(got.value, sent.value);
    EXPECT_EQ(got.nonce, sent.nonce);
    EXPECT_EQ(Decode(frame, size - 1, got), Decoded::kWrongSize);
    for (std::size_t bit = 8; bit < 8 * size; ++bit) {
      frame[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
      EXPECT_EQ(Decode(frame, size, got), Decoded::kWrongCrc);
      frame[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    }
  }
}

TEST(BoardProtocol, AStatusIsReadAsItWasWritten) {
  Status sent;
  sent.sequence = 77;
  sent.mode = Mode::kPosition;
  sent.referenced = sent.timeout = sent.was_reset = true;
  sent.motors[0] = {0xabc, 0x123, 0xfedc, -127};
  sent.motors[1] = {0x001, 0xfff, 0x0102, 90};
  sent.more = 0x5a;
  std::uint8_t frame[kFrameSize];
  Encode(sent, 3, frame);
  ASSERT_TRUE(IsFrame(frame, sizeof frame, 3));
  EXPECT_FALSE(IsReply(frame));
  const Status got = DecodeStatus(frame);
  EXPECT_EQ(got.sequence, 77);
  EXPECT_EQ(got.mode, Mode::kPosition);
  EXPECT_TRUE(got.referenced && got.timeout && got.was_reset);
  EXPECT_FALSE(got.faulty || got.overrun);
  for (int m = 0; m < kMotors; ++m) {
    EXPECT_EQ(got.motors[m].tension_quarters, sent.motors[m].tension_quarters);
    EXPECT_EQ(got.motors[m].set_point_quarters, sent.motors[m].set_point_quarters);
    EXPECT_EQ(got.motors[m].encoder_counts, sent.motors[m].encoder_counts);
    EXPECT_EQ(got.motors[m].duty, sent.motors[m].duty);
  }
  EXPECT_EQ(got.more, 0x5a);
}

// Without a reply the adapter returns 0xff; another board's frame is not a reply either.
TEST(BoardProtocol, WhatIsNotOfThisBoardIsNoFrame) {
  std::uint8_t frame[kFrameSize];
  Encode(Status{}, 3, frame);
  for (std::uint8_t board = 0; board < kBoards; ++board) {
    EXPECT_EQ(IsFrame(frame, sizeof frame, board), board == 3);
  }
  for (const int nobody : {0xff, 0x00}) {
    std::memset(frame, nobody, sizeof frame);
    for (std::uint8_t board = 0; board < kBoards; ++board) {
      EXPECT_FALSE(IsFrame(frame, sizeof frame, board)) << nobody << " " << int{board};
    }
  }
}

TEST(BoardProtocol, AReplyIsReadAsItWasWritten) {
  Reply sent;
  sent.what = 0xf0;
  sent.index = 2;
  sent.answer = Answer::kOutOfRange;
  Info info;
  info.protocol_min = 1;
  info.protocol_max = 2;
  info.firmware_major = 3;
  info.firmware_minor = 4;
  info.parameters_version = 0xdeadbeef;
  info.nonce = 0x0506;
  info.board = 5;
  Encode(info, sent.payload);
  std::uint8_t frame[kFrameSize];
  Encode(sent, 5, frame);
  ASSERT_TRUE(IsFrame(frame, sizeof frame, 5));
  ASSERT_TRUE(IsReply(frame));
  const Reply got = DecodeReply(frame);
  EXPECT_EQ(got.what, 0xf0);
  EXPECT_EQ(got.index, 2);
  EXPECT_EQ(got.answer, Answer::kOutOfRange);
  const Info read = DecodeInfo(got.payload);
  EXPECT_EQ(read.protocol_min, 1);
  EXPECT_EQ(read.protocol_max, 2);
  EXPECT_EQ(read.firmware_major, 3);
  EXPECT_EQ(read.firmware_minor, 4);
  EXPECT_EQ(read.parameters_version, 0xdeadbeefu);
  EXPECT_EQ(read.nonce, 0x0506);
  EXPECT_EQ(read.board, 5);
}

TEST(BoardProtocol, EveryMessageFitsTheBusBuffers) {
  static_assert(kCyclicSize <= kMaxMessageSize && kDoSize <= kMaxMessageSize &&
                kFrameSize <= kMaxMessageSize);
}

}  // namespace
}  // namespace taut::board
