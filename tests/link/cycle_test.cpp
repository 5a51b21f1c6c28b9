// Communication cycles: timing, requests, replies, and missing replies.
#include "link/fake_robot.h"

namespace taut::link {
namespace {

using board::Mode;

bool IsGroup(const Bytes& frame) { return frame[0] == 0x57; }
bool IsRead(const Bytes& frame) { return frame[0] == 0x54 && (frame[1] & 1) != 0; }

TEST(Cycles, AreTenMillisecondsApart) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.driver->ForgetStatistics();
  std::vector<double> times_s;
  const std::size_t from = rig.robot.frames.size();
  rig.driver->on_cycle = [&](const State& state) { times_s.push_back(state.time_s); };
  const double begun_s = rig.robot.now_s();
  rig.driver->RunUntil(begun_s + 0.998);
  EXPECT_EQ(times_s.size(), 100u);
  double due_s = begun_s;
  for (std::size_t i = from; i < rig.robot.frames.size(); ++i) {
    const auto& [at_s, frame] = rig.robot.frames[i];
    if (frame.size() != 32) continue;
    EXPECT_NEAR(at_s, due_s, 2e-6);
    due_s += 0.01;
  }
  const LinkView& link = rig.state().link;
  EXPECT_EQ(link.cycles, 100);
  EXPECT_EQ(link.late_cycles, 0);
  EXPECT_LT(link.longest_lateness_s, 2e-6);
  EXPECT_NEAR(link.mean_cycle_s, 0.0056, 0.0003);
  EXPECT_LT(link.longest_cycle_s, 0.007);
  EXPECT_EQ(rig.robot.frames.size() - from, 300u) << "a broadcast and two reads";
}

TEST(Cycles, ThatComeLateAreCountedAndNotMadeUpFor) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.driver->Cycle(3);
  rig.driver->ForgetStatistics();
  rig.driver->Cycle(1);
  rig.robot.Wait(rig.robot.now_s() + 0.035);  // the PC was busy
  const std::size_t from = rig.robot.frames.size();
  rig.driver->RunUntil(rig.robot.now_s() + 0.0995);
  EXPECT_EQ(rig.state().link.late_cycles, 1);
  EXPECT_NEAR(rig.state().link.longest_lateness_s, 0.0315, 0.002);
  EXPECT_EQ(rig.robot.Broadcasts(from).size(), 10u);
}

TEST(Cycles, NumberTheirBroadcasts) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.driver->Cycle(600);
  const auto said = rig.robot.Broadcasts();
  ASSERT_EQ(said.size(), 600u);
  for (std::size_t i = 1; i < said.size(); ++i) {
    EXPECT_EQ(said[i].sequence, static_cast<std::uint8_t>(said[i - 1].sequence + 1));
  }
  EXPECT_EQ(rig.state().boards[3].status.sequence, said.back().sequence);
}

TEST(Readings, AreNewtonsAndMetres) {
  Rig rig;
  ASSERT_TRUE(rig.Configure({{{0, 1, board::kNewtonsPerCount}, 0.3F},
                             {{0, 1, board::kCountsAtZero}, 20},
                             {{0, 1, board::kStiffness}, 400},
                             {{0, 1, board::kReferenceLength}, 0.3F}}));
  ASSERT_TRUE(rig.driver->SetReference(1, 0.3, rig.out));
  rig.board(0).motors[1].adc_stuck = 120;
  rig.driver->Cycle(20);
  const MotorView& motor = rig.state().motors[1];
  EXPECT_NEAR(motor.tension_n, 30, 0.1);  // 0.3 N x (120 - 20)
  EXPECT_NEAR(motor.rest_length_m, 0.3, 1e-6);
  EXPECT_NEAR(motor.length_m, 0.3 + 30.0 / 400, 1e-3);
  EXPECT_TRUE(std::isnan(motor.set_point_n));
  EXPECT_NEAR(rig.state().motors[0].tension_n, 11.35, 0.2);
  EXPECT_NEAR(rig.state().motors[0].length_m - rig.state().motors[0].rest_length_m, 0.05, 1e-3);
}

TEST(Readings, HaveASetPointUnderImpedanceControl) {
  Rig rig;
  rig.Run(Mode::kImpedance, true);
  rig.driver->Cycle(5);
  EXPECT_NEAR(rig.state().motors[7].set_point_n, 11.35, 0.5);
}

TEST(Readings, OfTheEncoderGoOnWhereSixteenBitsEnd) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  ASSERT_TRUE(rig.driver->SetReference(2, 0.2, rig.out));
  rig.driver->Cycle(2);
  board::BenchMotor& motor = rig.board(1).motors[0];
  motor.adc_stuck = 100;
  for (const double end_m : {-2.0, 1.5}) {  // 1e5 counts in all, below 0 and above
    const double begin_m = motor.wound_m;
    for (int i = 1; i <= 300; ++i) {
      motor.wound_m = begin_m + (end_m - begin_m) * i / 300;
      rig.driver->Cycle(1);
    }
    rig.driver->Cycle(2);
    const double counts = (end_m - 0.05) / 1.34e-5;
    EXPECT_NEAR(static_cast<double>(rig.state().motors[2].encoder_counts), counts, 2);
    EXPECT_NEAR(rig.state().motors[2].rest_length_m, 0.2 - (end_m - 0.05), 1e-4);
  }
}

TEST(Readings, TheByteThatMeansManyThingsIsSortedByItsNumber) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  board::Board& board = rig.board(4).core;
  board.counters.bad_messages = 3;
  board.counters.overruns = 4;
  board.counters.missed = 5;
  board.counters.recoveries = 6;
  board.boot.reset_cause = board::kBrownOut;
  board.temperature_c[1] = 77;
  board.board_faults = board::kBusStuck;
  board.faults[1] = board::kSlack;
  rig.driver->Cycle(17);
  const BoardView& seen = rig.state().boards[4];
  EXPECT_EQ(seen.bad_messages, 3);
  EXPECT_EQ(seen.late_ticks, 4);
  EXPECT_EQ(seen.missed_broadcasts, 5);
  EXPECT_EQ(seen.bus_recoveries, 6);
  EXPECT_EQ(seen.reset_cause, board::kBrownOut);
  EXPECT_EQ(seen.faults, board::kBusStuck);
  EXPECT_EQ(rig.state().motors[9].faults, board::kSlack);
  EXPECT_EQ(rig.state().motors[8].faults, 0);
  EXPECT_GT(rig.state().motors[9].temperature_c, 20);
}

TEST(Frames, OfTheWrongBoardOrWithAWrongBitAreReadAgain) {
  for (const bool crossed : {false, true}) {
    Rig rig;
    ASSERT_TRUE(rig.Configure());
    rig.driver->Cycle(3);
    rig.driver->ForgetStatistics();
    int times = 0;
    rig.robot.spoil = [&](const Bytes& frame, Bytes& reply) {
      if (!IsGroup(frame) || times++ > 0) return;
      if (crossed) {
        std::swap_ranges(reply.begin() + 2, reply.begin() + 18, reply.begin() + 18);
      } else {
        reply[2 + 16 + 4] ^= 0x10;
      }
    };
    const std::size_t from = rig.robot.frames.size();
    rig.driver->Cycle(1);
    EXPECT_EQ(rig.state().boards[0].bad_frames, crossed ? 1 : 0);
    EXPECT_EQ(rig.state().boards[1].bad_frames, 1);
    EXPECT_EQ(rig.state().boards[2].bad_frames, 0);
    EXPECT_EQ(rig.robot.frames.size() - from, crossed ? 5u : 4u);
    EXPECT_NEAR(rig.state().boards[1].heard_s, rig.state().time_s, 0.003) << "in the same cycle";
  }
}

TEST(Frames, ThatStayWrongAreNoReadings) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.driver->Cycle(3);
  rig.driver->ForgetStatistics();
  const double tension_n = rig.state().motors[2].tension_n;
  rig.robot.spoil = [&](const Bytes& frame, Bytes& reply) {
    if (IsGroup(frame) && frame[3] == 0x21) reply[2 + 16 + 2] ^= 0x80;
    if (frame == UsbIss::ReadFrame(0x11, 16)) reply[2] ^= 0x80;
  };
  rig.driver->Cycle(2);
  EXPECT_EQ(rig.state().motors[2].tension_n, tension_n);
  EXPECT_EQ(rig.state().boards[1].bad_frames, 6) << "one in a group and two alone, twice";
  EXPECT_EQ(rig.state().boards[0].bad_frames, 0);
}

TEST(Frames, ThatAnswerARequestAreFollowedByAStatus) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  std::vector<std::optional<board::Reply>> got;
  rig.driver->Request(2, {board::Request::kAsk, board::kStiffness, 1, 0, 0},
                      [&](const auto& reply) { got.push_back(reply); });
  for (int i = 0; i < 5; ++i) {
    const double before_s = rig.state().boards[2].heard_s;
    rig.driver->Cycle(1);
    EXPECT_GT(rig.state().boards[2].heard_s, before_s);
  }
  ASSERT_EQ(got.size(), 1u);
  ASSERT_TRUE(got[0]);
  EXPECT_EQ(got[0]->answer, board::Answer::kGood);
  EXPECT_EQ(board::internal::FromBits(board::internal::Get32(got[0]->payload)), 227);
  EXPECT_EQ(rig.state().boards[2].bad_frames, 0);
}

TEST(Requests, OfOneBoardComeOneAfterTheOther) {
  Rig rig;
  rig.Run(Mode::kImpedance);
  std::vector<int> order;
  for (int i = 0; i < 3; ++i) {
    const board::Asking asking{board::Request::kSet, board::kTensionOffset, 0,
                               board::internal::ToBits(static_cast<float>(5 + i)), 0};
    rig.driver->Request(1, asking, [&order, i](const auto& reply) {
      order.push_back(reply && reply->answer == board::Answer::kGood ? i : -1);
    });
  }
  rig.driver->Cycle(8);
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(rig.board(1).core.parameters.motor[0][board::kTensionOffset], 7);
  rig.ExpectAll(Mode::kImpedance);
}

TEST(Requests, AreOneACycleAndNoneTwice) {
  Rig rig;
  rig.Run(Mode::kHold);
  int answers = 0;
  for (int b = 0; b < 6; ++b) {
    rig.driver->Request(b, {board::Request::kAsk, board::kStiffness, 1, 0, 0},
                        [&](const auto& reply) { answers += reply.has_value(); });
  }
  int requests = 0;
  for (int cycle = 0; cycle < 10; ++cycle) {
    const std::size_t from = rig.robot.frames.size();
    rig.driver->Cycle(1);
    int now = 0;
    for (std::size_t i = from; i < rig.robot.frames.size(); ++i) {
      const Bytes& frame = rig.robot.frames[i].second;
      now += frame[0] == 0x54 && frame[1] != 0 && (frame[1] & 1) == 0;
    }
    EXPECT_LE(now, 1);
    requests += now;
  }
  EXPECT_EQ(answers, 6);
  EXPECT_EQ(requests, 6);
  EXPECT_EQ(rig.state().link.late_cycles, 0);
}

TEST(Requests, AreTriedThriceAndThenGivenUp) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.board(1).mute = true;
  int answers = 0, nothings = 0;
  rig.driver->Request(1, {board::Request::kAsk, board::kStiffness, 1, 0, 0},
                      [&](const auto& reply) { ++(reply ? answers : nothings); });
  const std::size_t from = rig.robot.frames.size();
  rig.driver->Cycle(7);
  EXPECT_EQ(answers, 0);
  EXPECT_EQ(nothings, 1);
  int tries = 0;
  for (std::size_t i = from; i < rig.robot.frames.size(); ++i) {
    tries += rig.robot.frames[i].second[1] == 0x22 && rig.robot.frames[i].second[0] == 0x54;
  }
  EXPECT_EQ(tries, 3);
}

TEST(Requests, ABoardThatSaysNothingElseDoesNotHoldUpTheOthers) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.board(1).always_replies = true;
  rig.driver->Request(1, {board::Request::kAsk, board::kStiffness, 1, 0, 0});
  const std::size_t from = rig.robot.frames.size();
  rig.driver->RunUntil(rig.robot.now_s() + 0.2);
  EXPECT_GT(rig.robot.Broadcasts(from).size(), 10u);
  EXPECT_EQ(rig.Heard("board 1 does not answer"), 1) << rig.Events();
}

TEST(Groups, FallBackToSingleReadsWhereOneIsAbsent) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.driver->Cycle(3);
  rig.board(1).there = false;
  const std::size_t from = rig.robot.frames.size();
  rig.driver->Cycle(1);
  int singles = 0;
  for (std::size_t i = from; i < rig.robot.frames.size(); ++i) {
    singles += IsRead(rig.robot.frames[i].second);
  }
  EXPECT_EQ(singles, 4) << "0, 1 twice, 2";
  for (const std::size_t b : {0u, 2u, 3u, 4u, 5u}) {
    EXPECT_NEAR(rig.state().boards[b].heard_s, rig.state().time_s, 0.01) << b;
    EXPECT_EQ(rig.state().boards[b].bad_frames, 0) << b;
  }
  EXPECT_EQ(rig.state().link.failed_group_reads, 1);
  EXPECT_TRUE(rig.state().boards[1].there) << "it may have been a moment";
  rig.driver->Cycle(3);
  EXPECT_FALSE(rig.state().boards[1].there);
  // Now group reads include only the boards that reply, and the missing board is polled from time
  // to time.
  const std::size_t later = rig.robot.frames.size();
  rig.driver->Cycle(10);
  singles = 0;
  for (std::size_t i = later; i < rig.robot.frames.size(); ++i) {
    singles += IsRead(rig.robot.frames[i].second);
  }
  EXPECT_EQ(singles, 1);
}

TEST(StaleFrames, AreCounted) {
  Rig rig;
  ASSERT_TRUE(rig.Configure());
  rig.driver->Cycle(3);
  rig.driver->ForgetStatistics();
  rig.driver->Cycle(10);
  EXPECT_EQ(rig.state().boards[0].stale_frames, 0);
  rig.board(0).deaf = true;
  rig.driver->Cycle(4);
  EXPECT_EQ(rig.state().boards[0].stale_frames, 4);
  EXPECT_EQ(rig.state().boards[1].stale_frames, 0);
}

}  // namespace
}  // namespace taut::link
