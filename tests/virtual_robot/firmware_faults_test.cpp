// Electronic faults, one after the other, with the firmware on all boards and a PC that keeps
// sending: no tension above its limit, motors held or released, every fault reported, and recovery
// possible.
#include "tests/virtual_robot/firmware_fixture.h"

namespace taut::virtual_robot {
namespace {

using board::Mode;

constexpr double kLimit_n = 50;

FaultSpec Fault(FaultKind kind, double at_s, double for_s) {
  FaultSpec fault;
  fault.kind = kind;
  fault.at_s = at_s;
  fault.for_s = for_s;
  return fault;
}
FaultSpec BoardFault(FaultKind kind, int board, double at_s, double for_s) {
  FaultSpec fault = Fault(kind, at_s, for_s);
  fault.board = board;
  return fault;
}
FaultSpec CableFault(FaultKind kind, int cable, double at_s) {
  FaultSpec fault = Fault(kind, at_s, FaultSpec{}.for_s);
  fault.cable = cable;
  return fault;
}

/// Twelve motors under impedance control from about 0.3 s on, unless `mode` is different
class Session {
 public:
  explicit Session(std::vector<FaultSpec> faults, Mode mode = Mode::kImpedance) {
    RobotOptions options;
    options.program = Firmware();
    options.faults = std::move(faults);
    options.log = [this](Time at, std::string_view who, std::string_view what) {
      log += LogLine(at, who, what);
    };
    robot = std::make_unique<Robot>(plant, options);
    master = std::make_unique<Master>(*robot);
    master->Begin();
    master->Run(0.02);
    if (mode == Mode::kPosition) {
      master->Reference();
      master->ArmInto(Mode::kHold);
      master->say.mode = Mode::kPosition;
    } else {
      master->ArmInto(mode);
    }
    master->Run(0.1);
    EXPECT_EQ(master->bad_frames, 0);
    EXPECT_LT(robot->now(), 490 * kMillisecond);
    for (int b = 0; b < board::kBoards; ++b) EXPECT_EQ(master->status[b].mode, mode) << b;
  }
  ~Session() { EXPECT_LE(plant.most_n, kLimit_n); }

  void RunTo(double time_s) {
    master->Run(time_s - static_cast<double>(robot->now()) / (1e9 * kNanosecond));
  }
  void IdleTo(double time_s) { robot->AdvanceTo(static_cast<Time>(time_s * 1e9) * kNanosecond); }
  std::uint8_t FaultsOf(int motor) {
    const auto reply = master->Ask(static_cast<std::uint8_t>(motor / 2),
                                   {board::Request::kAsk, 0xf1, board::kMotors, 0, 0});
    return reply ? reply->payload[motor % 2] : 0;
  }
  std::uint8_t BoardFaultsOf(int b) {
    const auto reply = master->Ask(static_cast<std::uint8_t>(b),
                                   {board::Request::kAsk, 0xf1, board::kMotors, 0, 0});
    return reply ? reply->payload[2] : 0xff;
  }
  void ExpectAll(Mode mode, bool timeout = false) {
    for (int b = 0; b < board::kBoards; ++b) {
      EXPECT_EQ(master->status[b].mode, mode) << b;
      EXPECT_EQ(master->status[b].timeout, timeout) << b;
    }
  }
  void ExpectAWayBack() {
    master->Recover(Mode::kImpedance);
    master->Run(0.3);
    const int bad = master->bad_frames;
    master->Run(0.1);
    EXPECT_EQ(master->bad_frames, bad);
    ExpectAll(Mode::kImpedance);
    for (int b = 0; b < board::kBoards; ++b)
      EXPECT_FALSE(master->status[b].faulty)
          << b << ": " << int{FaultsOf(2 * b)} << " " << int{FaultsOf(2 * b + 1)} << " "
          << int{BoardFaultsOf(b)};
  }
  void ExpectInLog(const std::string& text) {
    EXPECT_NE(log.find(text), std::string::npos) << text << "\n" << log;
  }

  BenchPlant plant;
  std::string log;
  std::unique_ptr<Robot> robot;
  std::unique_ptr<Master> master;
};

TEST(FirmwareFaults, ClocksThatDriftDoNoHarm) {
  std::vector<FaultSpec> faults;
  for (int b = 0; b < board::kBoards; ++b) {
    faults.push_back(BoardFault(FaultKind::kClockDrift, b, 0.1, FaultSpec{}.for_s));
    faults.back().drift_ppm = b % 2 == 0 ? 5000 : -5000;  // a ceramic resonator
  }
  Session session(faults);
  session.RunTo(1.5);
  session.ExpectAll(Mode::kImpedance);
  EXPECT_EQ(session.master->bad_frames, 0);
  for (int b = 0; b < board::kBoards; ++b)
    EXPECT_EQ(session.master->more[b][static_cast<int>(board::More::kOverruns)], 0);
}

TEST(FirmwareFaults, ABoardThatIsGoneIsNoticedAndTheOthersGoOn) {
  Session session({BoardFault(FaultKind::kBoardLoss, 2, 0.5, 0.3)});
  session.RunTo(0.7);
  EXPECT_GT(session.master->bad_frames, 10);
  for (int b : {0, 1, 3, 4, 5}) EXPECT_EQ(session.master->status[b].mode, Mode::kImpedance) << b;
  session.RunTo(1.0);  // it is back, without any command
  EXPECT_EQ(session.master->status[2].mode, Mode::kOff);
  EXPECT_TRUE(session.master->status[2].was_reset);
  EXPECT_FALSE(session.robot->Drive(4).enabled);
  session.ExpectInLog("board_loss");
  session.ExpectAWayBack();
}

TEST(FirmwareFaults, ABrownOutReleasesItsMotorsAndSaysSo) {
  Session session({BoardFault(FaultKind::kBrownOut, 1, 0.5, 0.02)});
  session.RunTo(0.8);
  EXPECT_EQ(session.master->status[1].mode, Mode::kOff);
  EXPECT_TRUE(session.master->status[1].was_reset);
  EXPECT_FALSE(session.master->status[1].referenced);
  EXPECT_EQ(session.master->more[1][static_cast<int>(board::More::kResetCause)] & board::kBrownOut,
            board::kBrownOut);
  EXPECT_FALSE(session.robot->Drive(2).enabled);
  session.ExpectInLog("brown");
  session.ExpectAWayBack();
}

TEST(FirmwareFaults, AProgramThatHangsIsResetByTheWatchdog) {
  Session session({BoardFault(FaultKind::kFirmwareHang, 3, 0.5, FaultSpec{}.for_s)});
  session.RunTo(0.8);
  EXPECT_EQ(session.robot->board(3).resets(), 1u);
  EXPECT_EQ(session.master->status[3].mode, Mode::kOff);
  EXPECT_EQ(session.master->more[3][static_cast<int>(board::More::kResetCause)] & board::kWatchdog,
            board::kWatchdog);
  session.ExpectInLog("watchdog");
  session.ExpectAWayBack();
}

TEST(FirmwareFaults, NoiseOnTheBusIsCountedAndNothingElse) {
  FaultSpec noise = Fault(FaultKind::kBusNoise, 0.5, 1.0);
  noise.flips_per_bit = 3e-4;
  Session session({noise});
  session.RunTo(1.6);
  EXPECT_GT(session.robot->bus().flipped_bits(), 10u);
  EXPECT_GT(session.master->bad_frames, 0);
  int counted = 0;
  for (int b = 0; b < board::kBoards; ++b)
    counted += session.master->more[b][static_cast<int>(board::More::kCrcErrors)];
  EXPECT_GT(counted, 0);
  session.ExpectAll(Mode::kImpedance);
  session.ExpectAWayBack();
}

TEST(FirmwareFaults, AnIllegalStartIsSurvived) {
  Session session({Fault(FaultKind::kBusError, 0.5, FaultSpec{}.for_s)});
  session.RunTo(0.9);
  session.ExpectAll(Mode::kImpedance);
  const int bad = session.master->bad_frames;
  session.master->Run(0.2);
  EXPECT_EQ(session.master->bad_frames, bad);
}

TEST(FirmwareFaults, ALineThatIsStuckEndsInATimeout) {
  for (const BusLine line : {BusLine::kData, BusLine::kClock}) {
    FaultSpec stuck = Fault(FaultKind::kBusStuck, 0.5, 0.3);
    stuck.line = line;
    Session session({stuck});
    session.RunTo(1.1);
    session.ExpectAll(Mode::kImpedance, true);  // boards hold, with V0 = 0
    session.ExpectAWayBack();
  }
}

TEST(FirmwareFaults, ACableThatIsCutStopsItsMotor) {
  Session session({CableFault(FaultKind::kCutCable, 5, 0.5)});
  session.RunTo(2.5);
  EXPECT_EQ(session.master->status[2].mode, Mode::kHold);
  EXPECT_TRUE(session.master->status[2].faulty);
  EXPECT_NE(session.FaultsOf(5) & board::kSlack, 0);
  EXPECT_EQ(session.FaultsOf(4), 0);
  EXPECT_EQ(session.robot->Drive(5).duty, 0.0);
  for (int b : {0, 1, 3, 4, 5}) EXPECT_EQ(session.master->status[b].mode, Mode::kImpedance) << b;
  session.ExpectInLog("cut_cable");
}

TEST(FirmwareFaults, ALoadCellThatStandsStillIsNotWoundAgainstForEver) {
  Session session({CableFault(FaultKind::kStuckLoadCell, 0, 0.5)});
  session.RunTo(0.6);
  const double before_m = session.plant.motors[0].wound_m;
  for (auto& value : session.master->say.values) value = -2500;  // winds in
  session.RunTo(2.5);
  EXPECT_NE(session.FaultsOf(0) & board::kSensor, 0);
  EXPECT_LT(session.plant.motors[0].wound_m - before_m, 0.05);
  EXPECT_EQ(session.robot->Drive(0).duty, 0.0);
}

TEST(FirmwareFaults, AnEncoderThatStandsStopsItsMotor) {
  Session session({CableFault(FaultKind::kStuckEncoder, 3, 0.5)}, Mode::kPosition);
  session.RunTo(0.6);
  session.master->say.values[3] = 3000;
  session.RunTo(1.5);
  EXPECT_NE(session.FaultsOf(3) & board::kStall, 0);
  EXPECT_EQ(session.robot->Drive(3).duty, 0.0);
  EXPECT_EQ(session.master->status[1].mode, Mode::kHold);
}

TEST(FirmwareFaults, ADriverThatSaysFaultIsOffUntilItIsArmedAnew) {
  Session session({BoardFault(FaultKind::kDriverFault, 4, 0.5, 0.1)});
  session.RunTo(0.9);
  EXPECT_EQ(session.master->status[4].mode, Mode::kOff);
  EXPECT_NE(session.BoardFaultsOf(4) & board::kDriverFault, 0);
  EXPECT_FALSE(session.robot->Drive(8).enabled);
  session.ExpectAWayBack();
}

// The drivers signal a too low supply voltage.
TEST(FirmwareFaults, WithoutSupplyMotorsAreOffUntilTheyAreArmedAnew) {
  Session session({Fault(FaultKind::kMotorSupplyLoss, 0.5, 0.4)}, Mode::kPosition);
  for (auto& value : session.master->say.values) value = 2500;
  session.RunTo(1.1);
  session.ExpectAll(Mode::kOff);
  for (int b = 0; b < board::kBoards; ++b) {
    EXPECT_NE(session.BoardFaultsOf(b) & board::kDriverFault, 0) << b;
  }
  session.ExpectAWayBack();
}

TEST(FirmwareFaults, WithoutThePcTheRobotHolds) {
  for (const FaultKind kind : {FaultKind::kUsbLoss, FaultKind::kHostKilled}) {
    Session session({Fault(kind, 0.5, 0.5)});
    session.RunTo(0.49);
    for (auto& value : session.master->say.values) value = -1000;
    session.IdleTo(0.99);
    const std::vector<board::BenchMotor> held = session.plant.motors;
    session.RunTo(1.2);
    session.ExpectAll(Mode::kImpedance, true);
    for (std::size_t i = 0; i < held.size(); ++i) {
      EXPECT_NEAR(session.plant.motors[i].wound_m, held[i].wound_m, 2e-3) << i;
    }
    session.ExpectAWayBack();
  }
}

TEST(FirmwareFaults, AnEmergencyStopIsOneFrame) {
  Session session({});
  std::uint8_t stop[board::kStopSize];
  board::EncodeStop(stop);
  Bytes frame{0x54, 0x00, board::kStopSize};
  frame.insert(frame.end(), stop, stop + sizeof stop);
  const Time asked = session.robot->now();
  session.robot->Transfer(frame);
  session.robot->AdvanceTo(asked + 2 * kMillisecond);
  for (int i = 0; i < board::kCables; ++i) EXPECT_FALSE(session.robot->Drive(i).enabled) << i;
  session.master->Run(0.3);
  session.ExpectAll(Mode::kStopped);
  session.ExpectAWayBack();
}

}  // namespace
}  // namespace taut::virtual_robot
