// Each kind of fault: its effects on boards, bus and host, and recovery
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/virtual_robot/probe_host.h"

namespace taut::virtual_robot {
namespace {

/// A robot with a fault script, whose host sends the same duties every 10 ms
class FaultyRobot {
 public:
  explicit FaultyRobot(std::vector<FaultSpec> faults, double duty = 0.1) : duty_(duty) {
    RobotOptions options;
    options.program = ProbeProgram();
    options.load_cell.noise_counts = 0;
    options.faults = std::move(faults);
    options.log = [this](Time at, std::string_view who, std::string_view what) {
      log += LogLine(at, who, what);
    };
    robot = std::make_unique<Robot>(plant, options);
    host = std::make_unique<ProbeHost>(*robot);
    host->Configure();
  }
  /// Runs cycles of 10 ms up to `until`.
  void RunTo(Time until) {
    while (robot->now() < until) {
      const Time next = (robot->now() / (10 * kMillisecond) + 1) * 10 * kMillisecond;
      ++sent;
      taken += host->Send(std::vector<double>(12, duty_), true);
      if (robot->now() < next) robot->AdvanceTo(next);
    }
  }
  bool Logged(const std::string& text) const { return log.find(text) != std::string::npos; }

  SpringPlant plant;
  std::unique_ptr<Robot> robot;
  std::unique_ptr<ProbeHost> host;
  std::string log;
  int sent = 0, taken = 0;

 private:
  double duty_;
};

constexpr double kForEver = FaultSpec{}.for_s;

TEST(Fault, ClockDriftMakesABoardTickFaster) {
  FaultyRobot faulty({{.kind = FaultKind::kClockDrift,
                       .at_s = 0.1,
                       .for_s = 0.5,
                       .board = 2,
                       .drift_ppm = 20'000}});
  faulty.RunTo(kSecond);
  const auto ticks = [&](int board) { return Long(faulty.robot->board(board), kBoxTicks); };
  EXPECT_NEAR(ticks(2), ticks(1) + 10, 1) << "two in a hundred, for half a second";
  EXPECT_EQ(ticks(0), ticks(1));
  EXPECT_EQ(faulty.taken, faulty.sent) << "the bus does not mind";
  EXPECT_TRUE(faulty.Logged("0.100000000 fault: clock_drift of board 2 begins"));
  EXPECT_TRUE(faulty.Logged("0.600000000 fault: clock_drift of board 2 ends"));
}

TEST(Fault, ABoardThatIsLostDoesNotAnswerAndComesBackAsNew) {
  FaultyRobot faulty({{.kind = FaultKind::kBoardLoss, .at_s = 0.1, .for_s = 0.2, .board = 4}});
  faulty.RunTo(200 * kMillisecond);
  EXPECT_EQ(faulty.taken, faulty.sent) << "the others take the broadcast";
  EXPECT_EQ(faulty.host->Read(4), Bytes(16, 0xFF));
  EXPECT_EQ(faulty.host->ReadDirect(4), (Bytes{0x00, 0x01}));
  EXPECT_FALSE(faulty.robot->Drive(8).enabled);
  EXPECT_TRUE(faulty.robot->Drive(7).enabled);
  const double lost_at = faulty.plant.RotorAngle(8);
  faulty.RunTo(300 * kMillisecond);
  EXPECT_EQ(faulty.plant.RotorAngle(8), lost_at);
  faulty.RunTo(400 * kMillisecond);
  EXPECT_TRUE(faulty.Logged("board 4: reset: power on"));
  EXPECT_EQ(faulty.robot->board(4).Memory(kBoxCause), 1);
  EXPECT_EQ(faulty.host->ReadDirect(4).size(), 18U);
  EXPECT_TRUE(faulty.robot->Drive(8).enabled) << "the host went on sending";
}

TEST(Fault, ABrownOutReleasesTheMotorsAndKeepsMemory) {
  FaultyRobot faulty({{.kind = FaultKind::kBrownOut, .at_s = 0.1, .for_s = 0.05, .board = 1}});
  faulty.RunTo(140 * kMillisecond);
  EXPECT_FALSE(faulty.robot->Drive(2).enabled || faulty.robot->Drive(3).enabled);
  faulty.RunTo(300 * kMillisecond);
  EXPECT_TRUE(faulty.Logged("board 1: reset: brown-out"));
  EXPECT_EQ(faulty.robot->board(1).Memory(kBoxCause), 4);
  EXPECT_EQ(faulty.robot->board(1).Memory(kBoxBoots), 2);
  EXPECT_TRUE(faulty.robot->Drive(2).enabled);
}

TEST(Fault, AProgramThatHangsDrivesOnUntilTheWatchdogBites) {
  FaultyRobot faulty({{.kind = FaultKind::kFirmwareHang, .at_s = 0.1, .board = 0}});
  faulty.RunTo(100 * kMillisecond + 5 * kMillisecond);
  const Time hung = 100 * kMillisecond;
  EXPECT_TRUE(faulty.robot->Drive(0).enabled);
  Time released = 0, stuck = 0;
  faulty.robot->after_plant_step = [&](Time now) {
    if (!faulty.robot->Drive(0).enabled && released == 0) released = now;
  };
  while (faulty.robot->now() < hung + 200 * kMillisecond) {
    if (!faulty.host->Send(std::vector<double>(12, 0.1), true)) stuck = faulty.robot->now();
  }
  EXPECT_NEAR(ToSeconds(released - hung), 0.064, 0.005);
  EXPECT_GT(stuck, hung) << "a hung board held the clock";
  EXPECT_LT(stuck, hung + 90 * kMillisecond);
  EXPECT_TRUE(faulty.Logged("board 0: reset: watchdog"));
  EXPECT_EQ(faulty.robot->board(0).Memory(kBoxCause), 8);
  EXPECT_TRUE(faulty.robot->Drive(0).enabled) << "messages come again";
}

TEST(Fault, NoiseSpoilsMessagesWhileItLasts) {
  FaultyRobot faulty(
      {{.kind = FaultKind::kBusNoise, .at_s = 0.1, .for_s = 0.3, .flips_per_bit = 0.02}});
  faulty.RunTo(100 * kMillisecond);
  EXPECT_EQ(faulty.robot->bus().flipped_bits(), 0U);
  faulty.RunTo(400 * kMillisecond);
  const std::uint64_t flips = faulty.robot->bus().flipped_bits();
  EXPECT_GT(flips, 30U);
  faulty.RunTo(600 * kMillisecond);
  EXPECT_EQ(faulty.robot->bus().flipped_bits(), flips);
  EXPECT_EQ(faulty.host->ReadDirect(3).size(), 18U);
}

TEST(Fault, AnIllegalStartSpoilsOneMessage) {
  FaultyRobot faulty({{.kind = FaultKind::kBusError, .at_s = 0.1051}});
  faulty.RunTo(300 * kMillisecond);
  EXPECT_EQ(faulty.taken, faulty.sent - 1);
  EXPECT_TRUE(faulty.Logged("fault: bus_error begins"));
}

TEST(Fault, AStuckLineStopsAllMessagesAndTheMotorsWithThem) {
  for (const BusLine line : {BusLine::kData, BusLine::kClock}) {
    FaultyRobot faulty({{.kind = FaultKind::kBusStuck, .at_s = 0.1, .for_s = 0.3, .line = line}});
    faulty.RunTo(100 * kMillisecond);
    const int before = faulty.taken;
    EXPECT_TRUE(faulty.robot->Drive(5).enabled);
    faulty.RunTo(370 * kMillisecond);
    EXPECT_EQ(faulty.taken, before);
    EXPECT_FALSE(faulty.robot->Drive(5).enabled) << "100 ms without a message";
    faulty.RunTo(600 * kMillisecond);
    EXPECT_GT(faulty.taken, before + 10);
    EXPECT_TRUE(faulty.robot->Drive(5).enabled);
  }
}

TEST(Fault, ACutCableFeelsNothing) {
  FaultyRobot faulty({{.kind = FaultKind::kCutCable, .at_s = 0.201, .cable = 7}});
  faulty.RunTo(200 * kMillisecond);
  EXPECT_GT(faulty.plant.LoadCellForce(7), 0.5);
  faulty.RunTo(250 * kMillisecond);
  EXPECT_EQ(faulty.plant.LoadCellForce(7), 0.0);
  EXPECT_EQ(Word(faulty.robot->board(3), kBoxAdc + 2), LoadCellCode({}, 0.0, 0.0));
  EXPECT_GT(faulty.plant.LoadCellForce(6), 0.5);
}

TEST(Fault, AStuckLoadCellShowsOneForce) {
  FaultyRobot faulty({{.kind = FaultKind::kStuckLoadCell, .at_s = 0.1, .for_s = 0.2, .cable = 2},
                      {.kind = FaultKind::kStuckLoadCell,
                       .at_s = 0.1,
                       .for_s = 0.2,
                       .cable = 3,
                       .force_n = 33.0}});
  faulty.RunTo(100 * kMillisecond);
  const int then = LoadCellCode({}, faulty.plant.LoadCellForce(2), 0.0);
  faulty.RunTo(290 * kMillisecond);
  EXPECT_EQ(Word(faulty.robot->board(1), kBoxAdc), then);
  EXPECT_EQ(Word(faulty.robot->board(1), kBoxAdc + 2), LoadCellCode({}, 33.0, 0.0));
  EXPECT_GT(Word(faulty.robot->board(2), kBoxAdc), then + 2) << "one that is well";
  faulty.RunTo(400 * kMillisecond);
  EXPECT_EQ(Word(faulty.robot->board(1), kBoxAdc), Word(faulty.robot->board(2), kBoxAdc));
}

TEST(Fault, AStuckEncoderCountsNothing) {
  FaultyRobot faulty({{.kind = FaultKind::kStuckEncoder, .at_s = 0.1, .for_s = 0.2, .cable = 11}});
  faulty.RunTo(110 * kMillisecond);
  const int then = Count(faulty.robot->board(5), 1);
  faulty.RunTo(290 * kMillisecond);
  EXPECT_EQ(Count(faulty.robot->board(5), 1), then);
  EXPECT_GT(Count(faulty.robot->board(5), 0), then + 50);
  faulty.RunTo(400 * kMillisecond);
  EXPECT_GT(Count(faulty.robot->board(5), 1), then + 30) << "but what it missed is gone";
  EXPECT_LT(Count(faulty.robot->board(5), 1), Count(faulty.robot->board(5), 0) - 50);
}

TEST(Fault, DriversWithAFaultDriveNothingAndSaySo) {
  FaultyRobot faulty({{.kind = FaultKind::kDriverFault, .at_s = 0.1, .for_s = 0.1, .board = 5}});
  constexpr std::uint16_t kPinb = 0x23, kFaultPin = 1 << 4;
  faulty.RunTo(150 * kMillisecond);
  EXPECT_FALSE(faulty.robot->Drive(10).enabled);
  EXPECT_TRUE(faulty.robot->Drive(8).enabled);
  EXPECT_EQ(faulty.robot->board(5).Memory(kPinb) & kFaultPin, 0);
  EXPECT_NE(faulty.robot->board(4).Memory(kPinb) & kFaultPin, 0);
  faulty.RunTo(250 * kMillisecond);
  EXPECT_TRUE(faulty.robot->Drive(10).enabled);
  EXPECT_NE(faulty.robot->board(5).Memory(kPinb) & kFaultPin, 0);
}

TEST(Fault, WithoutMotorSupplyBoardsLiveOn) {
  FaultyRobot faulty({{.kind = FaultKind::kMotorSupplyLoss, .at_s = 0.1, .for_s = 0.1}});
  faulty.RunTo(150 * kMillisecond);
  const std::vector<double> then = ProbeHost::Angles(faulty.plant);
  for (int motor = 0; motor < 12; ++motor) EXPECT_FALSE(faulty.robot->Drive(motor).enabled);
  faulty.RunTo(190 * kMillisecond);
  EXPECT_EQ(ProbeHost::Angles(faulty.plant), then);
  EXPECT_EQ(faulty.taken, faulty.sent);
  faulty.RunTo(250 * kMillisecond);
  EXPECT_TRUE(faulty.robot->Drive(0).enabled);
}

TEST(Fault, WithoutUsbTheMotorsAreReleasedAndTheAdapterForgetsItsMode) {
  FaultyRobot faulty({{.kind = FaultKind::kUsbLoss, .at_s = 0.1, .for_s = 0.2}});
  faulty.RunTo(100 * kMillisecond);
  EXPECT_TRUE(faulty.robot->Drive(1).enabled);
  EXPECT_EQ(faulty.host->Ask({0x5A, 0x01}), Bytes{});
  faulty.robot->AdvanceTo(kSecond);
  EXPECT_FALSE(faulty.robot->Drive(1).enabled);
  EXPECT_TRUE(faulty.robot->usb_connected());
  EXPECT_EQ(faulty.host->Ask({0x5A, 0x01}), (Bytes{0x07, 8, UsbIss::kPowerUpMode}));
  EXPECT_TRUE(faulty.host->Configure());
  EXPECT_TRUE(faulty.host->Send(std::vector<double>(12, 0.1), true));
}

TEST(Fault, UsbLostWithinAMessageLeavesBoardsThatRecover) {
  for (int microseconds = 0; microseconds < 1200; microseconds += 37) {
    FaultyRobot faulty(
        {{.kind = FaultKind::kUsbLoss, .at_s = 0.1 + microseconds * 1e-6, .for_s = 0.01}});
    faulty.RunTo(100 * kMillisecond);
    faulty.robot->HostWrites(Bytes{0x54, 0x00, 0x03, 0xC1, 1, 2});
    faulty.robot->AdvanceTo(200 * kMillisecond);
    faulty.robot->HostReads();
    ASSERT_TRUE(faulty.host->Configure()) << microseconds;
    ASSERT_TRUE(faulty.host->Send(std::vector<double>(12, 0.1), true)) << microseconds;
    ASSERT_EQ(faulty.host->ReadDirect(0).size(), 18U) << microseconds;
  }
}

TEST(Fault, AMessageThatUsbLeftInTheMiddleIsNotTaken) {
  // Within the bytes of a message: 0.25 ms on USB, then 23 us per byte.
  FaultyRobot faulty({{.kind = FaultKind::kUsbLoss, .at_s = 0.10035, .for_s = 0.01}});
  faulty.RunTo(100 * kMillisecond);
  faulty.robot->HostWrites(Bytes{0x54, 0x00, 0x07, 0xC1, 1, 2, 3, 4, 5, 6});
  faulty.robot->AdvanceTo(150 * kMillisecond);
  EXPECT_EQ(faulty.robot->board(0).Memory(kBoxReceivedCount), 14) << "that of the last one";
}

TEST(Fault, WithAHostThatIsGoneTheMotorsAreReleased) {
  FaultyRobot faulty({{.kind = FaultKind::kHostKilled, .at_s = 0.1, .for_s = kForEver}});
  faulty.RunTo(100 * kMillisecond);
  EXPECT_TRUE(faulty.robot->Drive(1).enabled);
  faulty.robot->AdvanceTo(185 * kMillisecond);
  EXPECT_TRUE(faulty.robot->Drive(1).enabled);
  faulty.robot->AdvanceTo(195 * kMillisecond);
  for (int motor = 0; motor < 12; ++motor) EXPECT_FALSE(faulty.robot->Drive(motor).enabled);
  EXPECT_FALSE(faulty.robot->host_alive());
  Bytes message{0x54, 0x00, 14, 0xC1};
  message.resize(17, 0x10);
  faulty.robot->HostWrites(message);
  faulty.robot->AdvanceTo(220 * kMillisecond);
  EXPECT_FALSE(faulty.robot->Drive(1).enabled) << "what a dead program writes";
  EXPECT_EQ(faulty.host->Ask({0x5A, 0x01}), Bytes{});
}

TEST(Fault, WhatEndsDoesSoBeforeWhatBeginsThen) {
  FaultSchedule schedule({{.kind = FaultKind::kUsbLoss, .at_s = 2, .for_s = 1},
                          {.kind = FaultKind::kHostKilled, .at_s = 1, .for_s = 1}},
                         6, 12);
  const auto changes = schedule.TakeUntil(2 * kSecond);
  ASSERT_EQ(changes.size(), 3U);
  EXPECT_TRUE(changes[0].begins && !changes[1].begins && changes[2].begins);
  EXPECT_EQ(changes[1].fault->kind, FaultKind::kHostKilled);
}

TEST(Fault, OfTwoThatOverlapTheEndOfOneLeavesTheOther) {
  FaultSchedule schedule(
      {{.kind = FaultKind::kBusNoise, .at_s = 1, .for_s = 3, .flips_per_bit = 0.1},
       {.kind = FaultKind::kBusNoise, .at_s = 2, .for_s = 1, .flips_per_bit = 0.2},
       {.kind = FaultKind::kBoardLoss, .at_s = 2, .for_s = 4, .board = 1},
       {.kind = FaultKind::kBoardLoss, .at_s = 3, .for_s = 1, .board = 1}},
      6, 12);
  const auto at = [&](double time_s) {
    EXPECT_LE(schedule.NextAt(), FromSeconds(time_s));
    schedule.TakeUntil(FromSeconds(time_s));
    return schedule.State();
  };
  EXPECT_EQ(at(1).flips_per_bit, 0.1);
  EXPECT_EQ(at(2).flips_per_bit, 0.2);
  EXPECT_EQ(at(3).flips_per_bit, 0.1);
  const FaultState state = at(4);
  EXPECT_EQ(state.flips_per_bit, 0.0);
  EXPECT_TRUE(state.boards[1].lost);
  EXPECT_FALSE(at(6).boards[1].lost);
  EXPECT_EQ(schedule.NextAt(), kNever);
}

}  // namespace
}  // namespace taut::virtual_robot
