// Frames to and from a USB-ISS adapter, byte by byte as documented by Devantech (usb_iss_tech,
// usb_iss_i2c_tech).
#include "link/fake_robot.h"

namespace taut::link {
namespace {

TEST(UsbIssFrames, AreThoseOfTheMaker) {
  const std::vector<std::uint8_t> bytes{0xce, 0x53};
  EXPECT_EQ(UsbIss::WriteFrame(0x00, bytes), (Bytes{0x54, 0x00, 0x02, 0xce, 0x53}));
  EXPECT_EQ(UsbIss::WriteFrame(0x11, bytes), (Bytes{0x54, 0x22, 0x02, 0xce, 0x53}));
  EXPECT_EQ(UsbIss::ReadFrame(0x11, 16), (Bytes{0x54, 0x23, 0x10}));
}

// Start, write one byte (the address), read 15, not acknowledged: read 1; stop.
TEST(UsbIssFrames, ReadsOfSeveralSlavesAreOneDirectFrame) {
  const std::vector<std::uint8_t> three{0x10, 0x11, 0x15};
  EXPECT_EQ(UsbIss::ReadsFrame(three, 16),
            (Bytes{0x57, 0x01, 0x30, 0x21, 0x2e, 0x04, 0x20, 0x03,  //
                   0x01, 0x30, 0x23, 0x2e, 0x04, 0x20, 0x03,        //
                   0x01, 0x30, 0x2b, 0x2e, 0x04, 0x20, 0x03}));
  EXPECT_EQ(UsbIss::ReadsFrame(std::vector<std::uint8_t>{0x10}, 1),
            (Bytes{0x57, 0x01, 0x30, 0x21, 0x04, 0x20, 0x03}));
  EXPECT_LT(UsbIss::ReadsFrame(three, 16).size(), 60u) << "what its buffer holds";
}

TEST(UsbIssTransfers, AskWhoItIsAndSetItsMode) {
  FakeRobot robot;
  UsbIss adapter(robot);
  const auto info = adapter.Identify();
  ASSERT_TRUE(info);
  EXPECT_EQ(info->module_id, kModuleId);
  EXPECT_EQ(info->firmware_version, 8);
  EXPECT_EQ(info->mode, 0x40);
  EXPECT_EQ(info->serial_number, "00042107");
  EXPECT_TRUE(adapter.SetMode());
  EXPECT_TRUE(adapter.Test(0x12));
  EXPECT_FALSE(adapter.Test(0x17));
  ASSERT_EQ(robot.frames.size(), 5u);
  EXPECT_EQ(robot.frames[0].second, (Bytes{0x5a, 0x01}));
  EXPECT_EQ(robot.frames[1].second, (Bytes{0x5a, 0x03}));
  EXPECT_EQ(robot.frames[2].second, (Bytes{0x5a, 0x02, 0x70, 0x04}));
  EXPECT_EQ(robot.frames[3].second, (Bytes{0x58, 0x24}));
  robot.refuses_mode = true;
  EXPECT_FALSE(adapter.SetMode());
}

TEST(UsbIssTransfers, AReplyInPiecesIsOneReply) {
  FakeRobot robot;
  UsbIss adapter(robot);
  ASSERT_TRUE(adapter.SetMode());
  const std::vector<std::uint8_t> addresses{0x10, 0x11, 0x12};
  adapter.Begin(UsbIss::ReadsFrame(addresses, 16), {48, true}, 0.1);
  EXPECT_EQ(adapter.Poll(), UsbIss::State::kPending);
  robot.Wait(robot.now_s() + 0.1);
  EXPECT_EQ(adapter.Poll(), UsbIss::State::kDone);
  ASSERT_EQ(adapter.reply().size(), 50u);
  EXPECT_EQ(adapter.reply()[0], 0xff);
  EXPECT_EQ(adapter.reply()[1], 48);
}

TEST(UsbIssTransfers, AnErrorOfADirectFrameIsAWholeReply) {
  FakeRobot robot(1);
  UsbIss adapter(robot);
  ASSERT_TRUE(adapter.SetMode());
  const std::vector<std::uint8_t> addresses{0x10, 0x11};
  const double begun_s = robot.now_s();
  EXPECT_EQ(adapter.Transfer(UsbIss::ReadsFrame(addresses, 16), {32, true}), (Bytes{0x00, 0x01}));
  EXPECT_LT(robot.now_s() - begun_s, 0.01) << "it waited for more";
}

TEST(UsbIssTransfers, SilenceEndsAfterItsPatience) {
  FakeRobot robot;
  UsbIss adapter(robot);
  robot.swallow = [](const Bytes&) { return true; };
  adapter.Begin(Bytes{0x5a, 0x01}, {3}, 0.04);
  robot.Wait(robot.now_s() + 0.039);
  EXPECT_EQ(adapter.Poll(), UsbIss::State::kPending);
  robot.Wait(robot.now_s() + 0.002);
  EXPECT_EQ(adapter.Poll(), UsbIss::State::kSilent);
  const double begun_s = robot.now_s();
  EXPECT_FALSE(adapter.Identify());
  EXPECT_NEAR(robot.now_s() - begun_s, 1.5, 0.01) << "what the maker asks for, three times";
}

TEST(UsbIssTransfers, WhatComesTooLateIsNotTheNextReply) {
  FakeRobot robot;
  UsbIss adapter(robot);
  ASSERT_TRUE(adapter.SetMode());
  robot.delay_s = 0.05;
  adapter.Begin(UsbIss::ReadFrame(0x10, 16), {16}, 0.04);
  robot.Wait(robot.now_s() + 0.04);
  EXPECT_EQ(adapter.Poll(), UsbIss::State::kSilent);
  robot.delay_s = 0;
  robot.Wait(robot.now_s() + 0.1);  // until it has arrived
  const auto version = adapter.Transfer(Bytes{0x5a, 0x01}, {3});
  ASSERT_TRUE(version);
  EXPECT_EQ((*version)[0], 7);
}

TEST(UsbIssTransfers, AnAdapterThatIsGoneIsSaidToBe) {
  FakeRobot robot;
  UsbIss adapter(robot);
  adapter.Begin(Bytes{0x5a, 0x01}, {3}, 0.04);
  robot.gone = true;
  EXPECT_EQ(adapter.Poll(), UsbIss::State::kLost);
  adapter.Begin(Bytes{0x5a, 0x01}, {3}, 0.04);
  EXPECT_EQ(adapter.Poll(), UsbIss::State::kLost);
  EXPECT_FALSE(adapter.Identify());
}

}  // namespace
}  // namespace taut::link
