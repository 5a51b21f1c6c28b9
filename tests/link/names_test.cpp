// Names of bytes on the wire, parameters as typed by a user, and the rows of a log.
#include "taut/link/names.h"

#include "link/fake_robot.h"
#include "taut/link/log.h"

namespace taut::link {
namespace {

std::string Wrong(const std::string& text) {
  Diagnostics out;
  EXPECT_FALSE(ReadParameter(text, "--board", out)) << text;
  return out.Format();
}

TEST(ReadParameter, TakesANameAndANumber) {
  Diagnostics out;
  const auto of_motor = ReadParameter("duty_limit=0.5", "--board", out);
  ASSERT_TRUE(of_motor) << out.Format();
  EXPECT_TRUE(of_motor->of_motor);
  EXPECT_EQ(of_motor->parameter, board::kDutyLimit);
  EXPECT_EQ(of_motor->value, 0.5F);
  const auto of_board = ReadParameter("supply_v=1.1e1", "--board", out);
  ASSERT_TRUE(of_board) << out.Format();
  EXPECT_FALSE(of_board->of_motor);
  EXPECT_EQ(of_board->parameter, board::kSupply);
  EXPECT_EQ(of_board->value, 11);
  EXPECT_TRUE(ReadParameter("tension_filter_share=0.001", "--board", out)) << "its very least";
}

TEST(ReadParameter, IsStrict) {
  for (const char* text : {"duty_limit", "duty_limit=", "duty_limit=half", "duty_limit=0.5x",
                           "duty_limit= 0.5", "duty_limit=0.5 ", "=", ""}) {
    EXPECT_NE(Wrong(text).find("expected the form name=number"), std::string::npos) << Wrong(text);
  }
  for (const char* text :
       {"duty_limit=1.01", "duty_limit=-0.01", "duty_limit=nan", "duty_limit=inf", "supply_v=4"}) {
    EXPECT_NE(Wrong(text).find("the value must be within"), std::string::npos) << Wrong(text);
  }
  EXPECT_NE(Wrong("duty_limit=1e999"), "");
  EXPECT_NE(Wrong("duty_limit=1e-999"), "");
  EXPECT_NE(Wrong("duty_limt=0.5").find("duty_limit"), std::string::npos) << "a hint";
  EXPECT_NE(Wrong("colour=1").find("docs/hardware/parameters.md"), std::string::npos);
}

TEST(ForAll, IsOneAMotorOrOneABoard) {
  const auto of_motors = ForAll({true, board::kDutyLimit, 0.5F}, 5);
  ASSERT_EQ(of_motors.size(), 5u);
  EXPECT_EQ(of_motors[4].place.board, 2);
  EXPECT_EQ(of_motors[4].place.index, 0);
  const auto of_boards = ForAll({false, board::kSupply, 11}, 5);
  ASSERT_EQ(of_boards.size(), 3u);
  EXPECT_EQ(of_boards[2].place.board, 2);
  EXPECT_EQ(of_boards[2].place.index, board::kMotors);
}

TEST(Names, GoThereAndBack) {
  for (const board::Mode mode :
       {board::Mode::kOff, board::Mode::kHold, board::Mode::kPosition, board::Mode::kImpedance,
        board::Mode::kDuty, board::Mode::kStopped}) {
    EXPECT_EQ(ModeOf(ModeName(mode)), mode);
  }
  EXPECT_FALSE(ModeOf("walk"));
  EXPECT_EQ(MotorFaultNames(board::kOverTension | board::kHot), "over_tension, hot");
  EXPECT_EQ(MotorFaultNames(0x7f), "over_tension, sensor, slack, stall, polarity, runaway, hot");
  EXPECT_EQ(BoardFaultNames(board::kDriverFault | board::kBusStuck), "driver, bus_stuck");
  EXPECT_EQ(BoardFaultNames(0x3f),
            "driver, overruns, parameters_lost, unreferenced, not_armed, bus_stuck");
  EXPECT_EQ(ResetCauseNames(board::kBrownOut | board::kWatchdog), "brown_out, watchdog");
  for (int answer = 0; answer < 6; ++answer) {
    EXPECT_STRNE(AnswerText(static_cast<board::Answer>(answer)), "unknown answer");
  }
}

TEST(FaultText, NamesCablesAndTheBoard) {
  State state;
  state.motors.resize(4);
  state.boards.resize(2);
  EXPECT_EQ(FaultText(state, 1, {}), "no faults");
  state.motors[3].faults = board::kStall;
  state.boards[1].faults = board::kBusStuck;
  EXPECT_EQ(FaultText(state, 1, {"a", "b", "c", "d"}), "d: stall; board: bus_stuck");
  EXPECT_EQ(FaultText(state, 1, {}), "motor 3: stall; board: bus_stuck");
  EXPECT_EQ(FaultText(state, 0, {}), "no faults");
}

TEST(RobotLog, HasAColumnOfItsOwnForEverything) {
  RobotLog log({"front", "back", "left"});
  State state;
  state.motors.resize(3);
  state.boards.resize(2);
  state.time_s = 10;
  state.commanded = board::Mode::kImpedance;
  const auto at = [&](const std::string& name) {
    const double* const row = log.Row(state);
    for (std::size_t i = 0; i < log.channels().size(); ++i) {
      if (log.channels()[i].name == name) return row[i];
    }
    ADD_FAILURE() << "no channel " << name;
    return -1.0;
  };
  MotorView& motor = state.motors[1];
  motor = {12.5, 13.5, 1234567, 0.15, 0.25, -0.5, board::kStall, 66};
  EXPECT_EQ(at("cable/back/tension_n"), 12.5);
  EXPECT_EQ(at("cable/back/setpoint_n"), 13.5);
  EXPECT_EQ(at("cable/back/encoder_counts"), 1234567);
  EXPECT_EQ(at("cable/back/rest_length_m"), 0.15);
  EXPECT_EQ(at("cable/back/length_m"), 0.25);
  EXPECT_EQ(at("cable/back/duty"), -0.5);
  EXPECT_EQ(at("cable/back/faults"), board::kStall);
  EXPECT_EQ(at("cable/back/winding_temperature_c"), 66);
  EXPECT_EQ(at("cable/left/tension_n"), 0);
  BoardView& board = state.boards[1];
  EXPECT_EQ(at("board/1/age_s"), -1) << "never heard";
  board.there = true;
  board.heard_s = 9.75;
  board.status.mode = board::Mode::kHold;
  board.faults = board::kBusStuck;
  board.loop_time_s = 8e-4;
  board.bad_frames = 3;
  board.stale_frames = 4;
  board.bad_messages = 5;
  board.late_ticks = 6;
  board.missed_broadcasts = 7;
  board.bus_recoveries = 8;
  board.reset_cause = board::kBrownOut;
  EXPECT_EQ(at("board/1/mode"), 1);
  EXPECT_EQ(at("board/1/age_s"), 0.25);
  EXPECT_EQ(at("board/1/faults"), board::kBusStuck);
  EXPECT_EQ(at("board/1/loop_time_s"), 8e-4);
  EXPECT_EQ(at("board/1/bad_frames"), 3);
  EXPECT_EQ(at("board/1/stale_frames"), 4);
  EXPECT_EQ(at("board/1/bad_messages"), 5);
  EXPECT_EQ(at("board/1/late_ticks"), 6);
  EXPECT_EQ(at("board/1/missed_broadcasts"), 7);
  EXPECT_EQ(at("board/1/bus_recoveries"), 8);
  EXPECT_EQ(at("board/1/reset_cause"), board::kBrownOut);
  const auto state_with = [&](bool board::Status::*flag) {
    board.status = {};
    board.status.*flag = true;
    return at("board/1/state");
  };
  EXPECT_EQ(state_with(&board::Status::referenced), 1);
  EXPECT_EQ(state_with(&board::Status::faulty), 2);
  EXPECT_EQ(state_with(&board::Status::timeout), 4);
  EXPECT_EQ(state_with(&board::Status::overrun), 8);
  EXPECT_EQ(state_with(&board::Status::was_reset), 16);
  EXPECT_EQ(at("board/0/state"), 32) << "not there";
  EXPECT_EQ(at("link/commanded_mode"), 3);
  state.stopping = true;
  EXPECT_EQ(at("link/commanded_mode"), 7);
  state.link = {true, 9, 1, 2, 3, 4, 5, 0.006, 0, 0, 0.001, 0, 0, 6};
  EXPECT_EQ(at("link/late_cycles"), 1);
  EXPECT_EQ(at("link/silent_transfers"), 2);
  EXPECT_EQ(at("link/unheard_broadcasts"), 3);
  EXPECT_EQ(at("link/adapter_resets"), 4);
  EXPECT_EQ(at("link/reconnections"), 5);
  EXPECT_EQ(at("link/failed_group_reads"), 6);
  EXPECT_EQ(at("link/cycle_s"), 0.006);
  EXPECT_EQ(at("link/lateness_s"), 0.001);
}

}  // namespace
}  // namespace taut::link
