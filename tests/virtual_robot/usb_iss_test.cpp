// Frames of the USB-ISS adapter, byte by byte, after Devantech's documents usb_iss_tech and
// usb_iss_i2c_tech
#include "apps/virtual_robot/emulated_usb_iss.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/virtual_robot/fake_slave.h"

namespace taut::virtual_robot {
namespace {

/// An adapter with a slave at address 0x10
class Desk {
 public:
  explicit Desk(UsbIssOptions options = {})
      : bus(1), adapter(bus, std::move(options)), slave(0x10) {
    bus.Attach(slave);
    slave.general_call = true;
  }
  /// Sends a frame. Returns the reply within a second, or nothing.
  Bytes Ask(const Bytes& frame) {
    asked = now;
    adapter.Receive(now, frame);
    return Wait();
  }
  Bytes Wait() {
    const Time end = now + kSecond;
    while (now < end) {
      Time next = std::min({end, now + 20 * kMicrosecond, bus.SafeUntil(now)});
      if (adapter.NextAt() > now) next = std::min(next, adapter.NextAt());
      now = next;
      bus.Step(now);
      adapter.Step(now);
      if (auto reply = adapter.TakeReply(now)) return *reply;
    }
    return {};
  }
  /// Returns the address and data bytes on the bus since the last call.
  Bytes Wires() {
    Bytes bytes;
    for (const BusEvent& event : slave.events) {
      const bool is_byte =
          event.kind == BusEvent::Kind::kAddress || event.kind == BusEvent::Kind::kByte;
      if (is_byte) bytes.push_back(event.byte);
    }
    slave.events.clear();
    return bytes;
  }

  I2cBus bus;
  UsbIss adapter;
  FakeSlave slave;
  Time now = 0, asked = 0;
};

Bytes Fast() { return {0x5A, 0x02, 0x70, 0x04}; }  // 400 kHz by hardware

TEST(UsbIss, SaysWhatItIs) {
  Desk desk;
  EXPECT_EQ(desk.Ask({0x5A, 0x01}), (Bytes{0x07, 8, 0x40}));
  EXPECT_EQ(desk.Ask({0x5A, 0x03}), (Bytes{'0', '0', '0', '0', '0', '0', '0', '1'}));
  EXPECT_EQ(desk.Ask(Fast()), (Bytes{0xFF, 0x00}));
  EXPECT_EQ(desk.Ask({0x5A, 0x01}), (Bytes{0x07, 8, 0x70}));
}

TEST(UsbIss, KnowsItsModesAndRefusesOthers) {
  Desk desk;
  for (const int mode : {0x20, 0x30, 0x40, 0x50, 0x60, 0x70, 0x80, 0x00, 0x90, 0x93}) {
    EXPECT_EQ(desk.Ask({0x5A, 0x02, static_cast<std::uint8_t>(mode), 0x04}), (Bytes{0xFF, 0x00}));
    EXPECT_EQ(desk.adapter.mode(), mode);
  }
  EXPECT_EQ(desk.Ask({0x5A, 0x02, 0x71, 0x01, 0x37}), (Bytes{0xFF, 0x00})) << "with serial port";
  EXPECT_EQ(desk.Ask({0x5A, 0x02, 0x01, 0x01, 0x37, 0x00}), (Bytes{0xFF, 0x00}));
  EXPECT_EQ(desk.Ask({0x5A, 0x02, 0x55, 0x04}), (Bytes{0x00, 0x05}));
  EXPECT_EQ(desk.Ask({0x5A, 0x09}), (Bytes{0x00, 0x05}));
  EXPECT_EQ(desk.adapter.mode(), 0x01) << "as before";
  EXPECT_EQ(desk.Ask({0x53, 0x20, 0x01}), Bytes{}) << "no bus in this mode";
  desk.Ask(Fast());
  EXPECT_EQ(desk.Ask({0x5A, 0x02, 0x10, 0x04}), (Bytes{0xFF, 0x00})) << "IO_CHANGE";
  EXPECT_EQ(desk.adapter.mode(), 0x70) << "it changes pins only";
}

TEST(UsbIss, SpeedFollowsTheMode) {
  for (const auto& [mode, hertz] : {std::pair{0x20, 20e3},
                                    {0x30, 50e3},
                                    {0x40, 100e3},
                                    {0x50, 400e3},
                                    {0x60, 100e3},
                                    {0x70, 400e3},
                                    {0x80, 1e6}}) {
    Desk desk;
    desk.Ask({0x5A, 0x02, static_cast<std::uint8_t>(mode), 0x04});
    ASSERT_EQ(desk.Ask({0x53, 0x20, 0x01}), Bytes{0xFF});
    // Two bytes of nine bits, a start, a stop, and a quarter of a millisecond in each direction.
    EXPECT_NEAR(ToSeconds(desk.now - desk.asked), 0.5e-3 + 20 / hertz, 1e-9);
  }
}

TEST(UsbIss, SingleBytes) {
  Desk desk;
  desk.Ask(Fast());
  EXPECT_EQ(desk.Ask({0x53, 0x20, 0xA7}), Bytes{0xFF});
  EXPECT_EQ(desk.Wires(), (Bytes{0x20, 0xA7}));
  EXPECT_EQ(desk.Ask({0x53, 0x21}), Bytes{0x40});
  EXPECT_EQ(desk.Wires(), (Bytes{0x21, 0x40}));
  EXPECT_EQ(desk.Ask({0x53, 0x30, 0xA7}), Bytes{0x00}) << "nobody there";
  EXPECT_EQ(desk.Ask({0x53, 0x31}), Bytes{0xFF}) << "a read cannot say so";
}

TEST(UsbIss, BytesWithoutRegister) {
  Desk desk;
  desk.Ask(Fast());
  EXPECT_EQ(desk.Ask({0x54, 0x20, 0x03, 9, 8, 7}), Bytes{0xFF});
  EXPECT_EQ(desk.Wires(), (Bytes{0x20, 9, 8, 7}));
  EXPECT_EQ(desk.Ask({0x54, 0x21, 0x04}), (Bytes{0x40, 0x41, 0x42, 0x43}));
  EXPECT_EQ(desk.Ask({0x54, 0x31, 0x03}), (Bytes{0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(desk.Ask({0x54, 0x00, 0x02, 1, 2}), Bytes{0xFF}) << "a general call";
  desk.slave.takes = 0;
  EXPECT_EQ(desk.Ask({0x54, 0x20, 0x02, 1, 2}), Bytes{0x00}) << "refused";
}

TEST(UsbIss, BytesOfARegister) {
  Desk desk;
  desk.Ask(Fast());
  EXPECT_EQ(desk.Ask({0x55, 0x20, 0x0A, 0x02, 5, 6}), Bytes{0xFF});
  EXPECT_EQ(desk.Wires(), (Bytes{0x20, 0x0A, 5, 6}));
  EXPECT_EQ(desk.Ask({0x55, 0x21, 0x0A, 0x02}), (Bytes{0x40, 0x41}));
  EXPECT_EQ(desk.Wires(), (Bytes{0x20, 0x0A, 0x21, 0x40, 0x41}));
  EXPECT_EQ(desk.Ask({0x56, 0x20, 0x0A, 0x0B, 0x01, 5}), Bytes{0xFF});
  EXPECT_EQ(desk.Wires(), (Bytes{0x20, 0x0A, 0x0B, 5}));
  EXPECT_EQ(desk.Ask({0x56, 0x21, 0x0A, 0x0B, 0x01}), (Bytes{0x42}));
  EXPECT_EQ(desk.Wires(), (Bytes{0x20, 0x0A, 0x0B, 0x21, 0x42}));
}

TEST(UsbIss, TestsWhetherSomebodyIsThere) {
  Desk desk;
  EXPECT_EQ(desk.Ask({0x58, 0x20}), Bytes{0xFF});
  EXPECT_EQ(desk.Ask({0x58, 0x30}), Bytes{0x00});
  Desk old({.firmware_version = 4});
  EXPECT_EQ(old.Ask({0x58, 0x20}), Bytes{}) << "came with version 5";
}

TEST(UsbIss, DirectDoesWhatItIsTold) {
  Desk desk;
  desk.Ask(Fast());
  EXPECT_EQ(desk.Ask({0x57, 0x01, 0x32, 0x20, 4, 5, 0x03}), (Bytes{0xFF, 0}));
  EXPECT_EQ(desk.Wires(), (Bytes{0x20, 4, 5}));
  // Writes a register, repeats the start, reads two bytes, the last without acknowledgement.
  EXPECT_EQ(desk.Ask({0x57, 0x01, 0x31, 0x20, 9, 0x02, 0x30, 0x21, 0x20, 0x04, 0x20, 0x03}),
            (Bytes{0xFF, 2, 0x40, 0x41}));
  std::vector<bool> acked;
  for (const BusEvent& event : desk.slave.events) {
    if (event.master_reads) acked.push_back(event.master_acked);
  }
  EXPECT_EQ(acked, (std::vector<bool>{true, false}));
  desk.slave.send_from = 0;
  EXPECT_EQ(desk.Ask({0x57, 0x01, 0x30, 0x21, 0x04, 0x2F, 0x03}).size(), 18U);
}

TEST(UsbIss, DirectNamesItsErrors) {
  Desk desk;
  desk.Ask(Fast());
  EXPECT_EQ(desk.Ask({0x57, 0x01, 0x30, 0x30, 0x03}), (Bytes{0x00, 0x01})) << "nobody there";
  EXPECT_EQ(desk.slave.events.back().kind, BusEvent::Kind::kStop);
  EXPECT_EQ(desk.Ask({0x57, 0x01, 0x35, 0x20, 1}), (Bytes{0x00, 0x03})) << "too few bytes";
  EXPECT_EQ(desk.slave.events.back().kind, BusEvent::Kind::kStop);
  EXPECT_EQ(desk.Ask({0x57, 0x01, 0x77}), (Bytes{0x00, 0x04})) << "unknown";
  Bytes lengthy(60, 0x01);
  lengthy[0] = 0x57;
  EXPECT_EQ(desk.Ask(lengthy), (Bytes{0x00, 0x02})) << "too long";
  lengthy.pop_back();
  EXPECT_EQ(desk.Ask(lengthy), (Bytes{0xFF, 0x00}));
  EXPECT_EQ(desk.Ask({0x57, 0x01, 0x30, 0x21, 0x2F, 0x2F, 0x2F, 0x2F, 0x03}), (Bytes{0x00, 0x02}))
      << "reads more than it can send";
}

TEST(UsbIss, BeforeVersionEightARefusalLeftTheBusOpen) {
  for (const int version : {7, 8}) {
    Desk desk({.firmware_version = version});
    EXPECT_EQ(desk.Ask({0x57, 0x01, 0x30, 0x30, 0x03}), (Bytes{0x00, 0x01}));
    EXPECT_EQ(desk.slave.events.back().kind,
              version < 8 ? BusEvent::Kind::kAddress : BusEvent::Kind::kStop);
  }
}

TEST(UsbIss, AFrameThatIsNotCompleteIsIgnored) {
  Desk desk;
  desk.Ask(Fast());
  for (const Bytes& frame :
       {Bytes{0x5A}, Bytes{0x5A, 0x02}, Bytes{0x5A, 0x02, 0x70}, Bytes{0x53}, Bytes{0x53, 0x20},
        Bytes{0x54, 0x20, 0x03, 1, 2}, Bytes{0x55, 0x20}, Bytes{0x56, 0x21, 1}, Bytes{0x58},
        Bytes{0x00}, Bytes{0x59, 1, 2}, Bytes{0xFF, 0xFF}, Bytes{0x54, 0x20, 0x00}}) {
    const std::uint64_t before = desk.adapter.ignored();
    EXPECT_EQ(desk.Ask(frame), Bytes{});
    EXPECT_EQ(desk.adapter.ignored(), before + 1);
  }
  // Bytes after a gap are a new frame.
  desk.adapter.Receive(desk.now, Bytes{0x54, 0x20, 0x02, 1});
  EXPECT_EQ(desk.Wait(), Bytes{});
  EXPECT_EQ(desk.Ask({2}), Bytes{});
  EXPECT_EQ(desk.Ask({0x54, 0x20, 0x01, 3}), Bytes{0xFF}) << "it is well again";
  Bytes much(3 + 61, 0);
  much[0] = 0x54, much[1] = 0x20, much[2] = 61;
  EXPECT_EQ(desk.Ask(much), Bytes{}) << "longer than its memory";
  much.resize(5 + 60);
  much[0] = 0x56, much[4] = 60;
  EXPECT_EQ(desk.Ask(much), Bytes{}) << "with two registers";
  much.resize(5 + 59);
  much[4] = 59;
  EXPECT_EQ(desk.Ask(much), Bytes{0xFF});
  EXPECT_EQ(desk.Ask({0x55, 0x21, 0, 61}), Bytes{});
  EXPECT_EQ(desk.Ask({0x55, 0x21, 0, 60}).size(), 60U);
  EXPECT_EQ(desk.Ask({0x56, 0x21, 0, 0, 65}), Bytes{});
  EXPECT_EQ(desk.Ask({0x56, 0x21, 0, 0, 64}).size(), 64U);
}

TEST(UsbIss, SeveralCommandsInABurstAreAnsweredTogether) {
  Desk desk;
  desk.Ask(Fast());
  EXPECT_EQ(desk.Ask({0x5A, 0x01, 0x53, 0x20, 0x07, 0x53, 0x21}),
            (Bytes{0x07, 8, 0x70, 0xFF, 0x40}));
}

TEST(UsbIss, AFrameBeforeTheReplyIsLost) {
  Desk desk;
  desk.Ask(Fast());
  desk.adapter.Receive(desk.now, Bytes{0x53, 0x20, 0x01});
  desk.adapter.Receive(desk.now, Bytes{0x53, 0x20, 0x02});
  EXPECT_EQ(desk.Wait(), Bytes{0xFF});
  EXPECT_EQ(desk.Wait(), Bytes{});
  EXPECT_EQ(desk.Wires(), (Bytes{0x20, 0x01}));
}

TEST(UsbIss, PulledOutItForgetsItsMode) {
  Desk desk;
  desk.Ask(Fast());
  desk.adapter.Receive(desk.now, Bytes{0x53, 0x20, 0x01});
  desk.adapter.PowerCycle();
  EXPECT_EQ(desk.Wait(), Bytes{});
  EXPECT_EQ(desk.Ask({0x5A, 0x01}), (Bytes{0x07, 8, UsbIss::kPowerUpMode}));
}

}  // namespace
}  // namespace taut::virtual_robot
