// Discovery of a robot's boards: present, missing and refused boards.
#include "link/fake_robot.h"

namespace taut::link {
namespace {

TEST(Configure, FindsBoardsSetsAndReadsWhatNumbersMean) {
  Rig rig;
  ASSERT_TRUE(rig.Configure({{{1, 0, board::kStiffness}, 300},
                             {{1, 1, board::kNewtonsPerCount}, 0.2F},
                             {{5, board::kMotors, board::kSupply}, 11}}))
      << rig.out.Format();
  EXPECT_EQ(rig.state().stage, Stage::kInactive);
  EXPECT_TRUE(rig.state().link.connected);
  EXPECT_EQ(rig.board(1).core.parameters.motor[0][board::kStiffness], 300);
  EXPECT_EQ(rig.board(5).core.parameters.board[board::kSupply], 11);
  EXPECT_EQ(rig.driver->figures(2).stiffness_n_per_m, 300);
  EXPECT_EQ(rig.driver->figures(3).n_per_count, double{0.2F});
  EXPECT_EQ(rig.driver->figures(0).n_per_count, double{0.1567F});
  EXPECT_EQ(rig.driver->adapter().serial_number, "00042107");
  for (std::size_t b = 0; b < 6; ++b) {
    EXPECT_TRUE(rig.state().boards[b].there);
    EXPECT_EQ(rig.state().boards[b].info.board, b);
    EXPECT_EQ(rig.state().boards[b].info.nonce, 1);
    EXPECT_EQ(rig.state().boards[b].reset_cause, board::kPowerOn);
  }
  EXPECT_TRUE(rig.robot.Broadcasts().empty()) << "nothing has been commanded";
  rig.driver->Cycle(3);
  rig.ExpectAll(board::Mode::kOff);
  EXPECT_FALSE(rig.robot.AnyPower());
}

TEST(Configure, NamesAllBoardsThatAreNotThere) {
  Rig rig;
  rig.board(2).there = rig.board(4).there = false;
  EXPECT_FALSE(rig.Configure());
  const std::string said = rig.out.Format();
  EXPECT_NE(said.find("board 2 does not answer"), std::string::npos) << said;
  EXPECT_NE(said.find("board 4 does not answer"), std::string::npos) << said;
  EXPECT_EQ(said.find("board 3"), std::string::npos) << said;
  EXPECT_EQ(rig.state().stage, Stage::kUnconfigured);
}

/// Replaces the reply to `Asked::kInfo` of board 1.
void SpoilInfo(Rig& rig, void (*spoil)(board::Info& info)) {
  rig.robot.spoil = [spoil](const Bytes& frame, Bytes& reply) {
    if (frame != UsbIss::ReadFrame(0x11, board::kFrameSize)) return;
    std::uint8_t bytes[board::kFrameSize];
    std::copy(reply.begin(), reply.end(), bytes);
    if (!board::IsReply(bytes) || bytes[0] != 0xf0) return;
    board::Reply said = board::DecodeReply(bytes);
    board::Info info = board::DecodeInfo(said.payload);
    spoil(info);
    board::Encode(info, said.payload);
    board::Encode(said, 1, bytes);
    reply.assign(bytes, bytes + sizeof bytes);
  };
}

TEST(Configure, RefusesFirmwareOfAnotherVersion) {
  void (*const spoils[])(board::Info&) = {
      [](board::Info& info) { ++info.parameters_version; },
      [](board::Info& info) { info.protocol_min = board::kProtocolVersion + 1; },
      [](board::Info& info) { info.protocol_max = board::kProtocolVersion - 1; }};
  for (const auto spoil : spoils) {
    Rig rig;
    SpoilInfo(rig, spoil);
    EXPECT_FALSE(rig.Configure());
    EXPECT_NE(rig.out.Format().find("board 1 has an incompatible firmware version, 0.2"),
              std::string::npos)
        << rig.out.Format();
  }
  Rig rig;
  SpoilInfo(rig, [](board::Info& info) { ++info.firmware_minor; });
  EXPECT_TRUE(rig.Configure()) << "which changes nothing of what is said: " << rig.out.Format();
}

TEST(Configure, SaysWhichValueIsRefusedAndWhy) {
  Rig rig;
  EXPECT_FALSE(rig.Configure({{{3, 1, board::kTensionLimit}, 500}}));
  const std::string said = rig.out.Format();
  EXPECT_NE(
      said.find(
          "board 3 refuses tension_limit_n of motor 1: the value is out of the parameter's range"),
      std::string::npos)
      << said;
}

TEST(Configure, WantsAUsbIssThatIsThere) {
  Rig silent;
  silent.robot.swallow = [](const Bytes&) { return true; };
  EXPECT_FALSE(silent.Configure());
  EXPECT_NE(silent.out.Format().find("no USB-ISS adapter answers"), std::string::npos);
  Rig gone;
  gone.robot.gone = true;
  EXPECT_FALSE(gone.Configure());
  EXPECT_NE(gone.out.Format().find("no USB-ISS adapter answers"), std::string::npos);
  Rig other;
  other.robot.module_id = 9;
  EXPECT_FALSE(other.Configure());
  EXPECT_NE(other.out.Format().find("the adapter is not a USB-ISS: its module number is 9, not 7"),
            std::string::npos)
      << other.out.Format();
  Rig refuses;
  refuses.robot.refuses_mode = true;
  EXPECT_FALSE(refuses.Configure());
  EXPECT_NE(refuses.out.Format().find("rejects I2C mode"), std::string::npos);
  Rig old;
  old.robot.firmware_version = 7;
  EXPECT_TRUE(old.Configure());
  EXPECT_NE(old.out.Format().find("before 8, a board that does not answer blocks the bus"),
            std::string::npos);
}

TEST(Configure, ABadFrameIsAskedForAgain) {
  Rig rig;
  int spoiled = 0;
  rig.robot.spoil = [&](const Bytes& frame, Bytes& reply) {
    if (frame == UsbIss::ReadFrame(0x12, board::kFrameSize) && ++spoiled <= 2) reply[5] ^= 1;
  };
  EXPECT_TRUE(rig.Configure()) << rig.out.Format();
  rig.robot.spoil = [&](const Bytes& frame, Bytes& reply) {
    if (frame == UsbIss::ReadFrame(0x12, board::kFrameSize)) reply[5] ^= 1;
  };
  EXPECT_FALSE(rig.Configure());
  EXPECT_NE(rig.out.Format().find("board 2 does not answer"), std::string::npos);
}

TEST(Configure, AnAnswerToAnotherQuestionIsNone) {
  Rig rig;
  rig.robot.spoil = [](const Bytes& frame, Bytes& reply) {
    if (frame != UsbIss::ReadFrame(0x10, board::kFrameSize)) return;
    std::uint8_t bytes[board::kFrameSize];
    std::copy(reply.begin(), reply.end(), bytes);
    if (!board::IsReply(bytes) || bytes[0] != board::kStiffness) return;
    board::Reply said = board::DecodeReply(bytes);
    said.index = 1 - said.index;
    board::Encode(said, 0, bytes);
    reply.assign(bytes, bytes + sizeof bytes);
  };
  EXPECT_FALSE(rig.Configure());
  EXPECT_NE(rig.out.Format().find("board 0 does not answer"), std::string::npos);
}

TEST(Configure, ARobotThatIsHeldGoesOnBeingHeld) {
  Rig rig;
  rig.Run(board::Mode::kImpedance, true);
  rig.robot.Wait(rig.robot.now_s() + 0.2);  // longer than the board's timeout
  Driver other(rig.robot, {});
  Diagnostics out;
  ASSERT_TRUE(other.Configure({}, out)) << out.Format();
  other.Cycle(5);
  EXPECT_TRUE(rig.robot.AnyPower());
  for (const board::Cyclic& said : rig.robot.Broadcasts(rig.robot.frames.size() - 8)) {
    EXPECT_EQ(said.mode, board::Mode::kHold);
  }
  EXPECT_TRUE(other.state().boards[0].status.timeout);
  Driver third(rig.robot, {});
  ASSERT_TRUE(third.Configure({}, out)) << out.Format();
  third.ClearFaults();
  third.Cycle(1);
  rig.robot.Wait(rig.robot.now_s() + 0.002);
  EXPECT_FALSE(rig.board(0).core.timeout) << "its first broadcast was taken for an old one";
  EXPECT_EQ(third.state().boards[0].stale_frames, 0);
  other.Cycle(3);
  EXPECT_FALSE(other.state().boards[0].status.timeout);
  EXPECT_EQ(other.state().boards[0].status.mode, board::Mode::kHold);
}

TEST(Configure, AgainTurnsMotorsOffAndBeginsAnew) {
  Rig rig;
  rig.Run(board::Mode::kHold);
  ASSERT_TRUE(rig.robot.AnyPower());
  ASSERT_TRUE(rig.Configure()) << rig.out.Format();
  EXPECT_FALSE(rig.robot.AnyPower());
  EXPECT_EQ(rig.state().stage, Stage::kInactive);
}

TEST(Configure, AgainMayLeaveMotorsHolding) {
  Rig rig;
  rig.Run(board::Mode::kImpedance);
  rig.board(2).Begin(board::kWatchdog);
  rig.driver->Cycle(5);
  const double wound_m = rig.board(4).motors[0].wound_m;
  ASSERT_TRUE(rig.driver->Configure({}, rig.out, Driver::Meanwhile::kHold)) << rig.out.Format();
  for (const std::size_t b : {0u, 1u, 3u, 4u, 5u}) EXPECT_TRUE(rig.board(b).IsPowered()) << b;
  ASSERT_TRUE(rig.driver->SetReference(4, 0.2, rig.out)) << "of the new boot: " << rig.out.Format();
  ASSERT_TRUE(rig.driver->SetReference(5, 0.2, rig.out));
  rig.driver->Off();
  rig.driver->ClearFaults();
  rig.driver->Cycle(2);
  EXPECT_TRUE(rig.driver->Enable(board::Mode::kImpedance, false, rig.out)) << rig.out.Format();
  EXPECT_NEAR(rig.board(4).motors[0].wound_m, wound_m, 1e-3);
}

TEST(Configure, OfMotorsThatHoldSetsWhatRunningOnesRefuse) {
  Rig rig;
  rig.Run(board::Mode::kImpedance);
  const std::vector<Setting> settings{{{1, 0, board::kStiffness}, 300}};
  ASSERT_TRUE(rig.driver->Configure(settings, rig.out, Driver::Meanwhile::kHold))
      << rig.out.Format();
  EXPECT_EQ(rig.board(1).core.mode, board::Mode::kHold);
  EXPECT_EQ(rig.board(1).core.parameters.motor[0][board::kStiffness], 300);
}

TEST(Configure, InTheMiddleOfACycleWaitsForItsEnd) {
  Rig rig;
  rig.Run(board::Mode::kImpedance, true);
  rig.driver->Off();
  rig.driver->RunUntil(rig.robot.now_s() + 0.0313);
  int nothings = 0;
  rig.driver->Request(0, {}, [&](const auto& reply) { nothings += !reply; });
  EXPECT_TRUE(rig.Configure()) << rig.out.Format();
  EXPECT_EQ(nothings, 1) << "nobody waits for ever";
}

TEST(Configure, FewerMotorsAreFewerBoards) {
  Rig rig({}, 3);
  ASSERT_TRUE(rig.Configure()) << rig.out.Format();
  EXPECT_EQ(rig.state().boards.size(), 2u);
  EXPECT_EQ(rig.state().motors.size(), 3u);
  rig.driver->Cycle(20);
  EXPECT_EQ(rig.state().boards[1].bad_frames, 0);
}

TEST(Configure, WithoutItNothingIsSaid) {
  Rig rig;
  EXPECT_FALSE(rig.driver->Enable(board::Mode::kHold, false, rig.out));
  EXPECT_FALSE(rig.out.ok());
  rig.driver->Cycle(3);
  rig.driver->RunUntil(rig.robot.now_s() + 0.1);
  EXPECT_TRUE(rig.robot.frames.empty());
  EXPECT_EQ(rig.state().stage, Stage::kUnconfigured);
}

TEST(SetReference, IsWhereTheCableIsAndWantsMotorsThatRest) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  ASSERT_TRUE(rig.driver->SetReference(3, 0.15, rig.out)) << rig.out.Format();
  EXPECT_EQ(rig.board(1).core.loops[1].counts, 3731);  // 0.05 m / 1.34e-5 m
  rig.driver->Cycle(2);
  EXPECT_NEAR(rig.state().motors[3].rest_length_m, 0.15, 1e-5);
  EXPECT_EQ(rig.state().motors[3].encoder_counts, 3731);
  rig.board(1).Begin(board::kBrownOut);  // another boot
  EXPECT_FALSE(rig.driver->SetReference(3, 0.15, rig.out));
  EXPECT_NE(rig.out.Format().find("it was reset after its information was read"),
            std::string::npos);
}

TEST(SetReference, OfMotorsThatRunIsRefused) {
  Rig rig;
  rig.Run(board::Mode::kImpedance, true);
  rig.driver->RunUntil(rig.robot.now_s() + 0.0123);  // in the middle of a cycle
  const std::int64_t counts = rig.state().motors[0].encoder_counts;
  EXPECT_FALSE(rig.driver->SetReference(0, 0.1, rig.out));
  EXPECT_NE(rig.out.Format().find("not allowed in its present mode"), std::string::npos);
  rig.driver->Cycle(3);
  EXPECT_NEAR(static_cast<double>(rig.state().motors[0].encoder_counts),
              static_cast<double>(counts), 200);
  EXPECT_EQ(rig.state().link.silent_transfers, 0);
  EXPECT_EQ(rig.state().boards[0].bad_frames, 0);
}

}  // namespace
}  // namespace taut::link
