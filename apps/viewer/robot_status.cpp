#include "robot_status.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "taut/link/names.h"

namespace taut::viewer {
namespace {

/// Age of a cycle that counts as silence. Boards time out after 0.1 s; a cycle takes 0.01 s.
constexpr double kSilence_s = 0.3;

const char* StageName(link::Stage stage) {
  switch (stage) {
    case link::Stage::kUnconfigured:
      return "unconfigured";
    case link::Stage::kInactive:
      return "inactive";
    case link::Stage::kReady:
      return "ready";
    case link::Stage::kActive:
      return "active";
  }
  return "unconfigured";
}

bool IsWell(const link::BoardView& board) {
  return board.there && !board.status.faulty && !board.status.timeout && board.faults == 0 &&
         board.status.mode != board::Mode::kStopped;
}

Json BoardJson(const link::State& state, std::size_t b, const std::vector<std::string>& cables) {
  const link::BoardView& board = state.boards[b];
  const std::string faults = link::FaultsOf(state, static_cast<int>(b), cables);
  return {{"there", board.there},
          {"well", IsWell(board) && faults.empty()},
          {"mode", link::ModeName(board.status.mode)},
          {"referenced", board.status.referenced},
          {"timeout", board.status.timeout},
          {"was_reset", board.status.was_reset},
          {"faults", faults},
          {"bad_messages", board.bad_messages},
          {"bad_frames", board.bad_frames},
          {"missed_broadcasts", board.missed_broadcasts},
          {"stale_frames", board.stale_frames},
          {"late_ticks", board.late_ticks},
          {"bus_recoveries", board.bus_recoveries},
          {"loop_time_s", board.loop_time_s}};
}

Json LinkJson(const link::LinkView& link) {
  return {{"connected", link.connected},
          {"cycles", link.cycles},
          {"late_cycles", link.late_cycles},
          {"silent_transfers", link.silent_transfers},
          {"unheard_broadcasts", link.unheard_broadcasts},
          {"reconnections", link.reconnections},
          {"cycle_s", link.cycle_s},
          {"mean_cycle_s", link.mean_cycle_s},
          {"longest_cycle_s", link.longest_cycle_s},
          {"lateness_s", link.lateness_s},
          {"mean_lateness_s", link.mean_lateness_s},
          {"longest_lateness_s", link.longest_lateness_s}};
}

}  // namespace

std::vector<std::string> AlarmsOf(const link::State& state, const std::vector<std::string>& cables,
                                  const std::string& port, double age_s) {
  std::vector<std::string> alarms;
  if (state.stopping) alarms.push_back("emergency stop: motors stay off until faults are cleared");
  if (!state.link.connected) {
    alarms.push_back(fmt::format("the adapter at {} is gone: the displayed data are old", port));
    return alarms;  // boards that do not answer
  }
  if (age_s > kSilence_s) alarms.push_back(fmt::format("no cycle for {:.1f} s", age_s));
  // Alarms common to several boards are merged.
  std::vector<std::size_t> absent, faulty, timed_out, stopped;
  for (std::size_t b = 0; b < state.boards.size(); ++b) {
    const link::BoardView& board = state.boards[b];
    const std::string faults = link::FaultsOf(state, static_cast<int>(b), cables);
    if (!board.there) {
      absent.push_back(b);
    } else if (!faults.empty()) {
      alarms.push_back(fmt::format("board {}: {}", b, faults));
    } else if (board.status.faulty) {
      faulty.push_back(b);
    } else if (board.status.timeout) {
      timed_out.push_back(b);
    } else if (board.status.mode == board::Mode::kStopped && !state.stopping) {
      stopped.push_back(b);
    }
  }
  const auto say = [&](const std::vector<std::size_t>& who, const char* one, const char* several) {
    if (who.empty()) return;
    alarms.push_back(fmt::format("board{} {} {}", who.size() > 1 ? "s" : "", fmt::join(who, ", "),
                                 who.size() > 1 ? several : one));
  };
  say(absent, "does not answer", "do not answer");
  say(faulty, "has latched faults", "have latched faults");
  say(timed_out, "timed out without a broadcast", "timed out without a broadcast");
  say(stopped, "was stopped: clear faults", "were stopped: clear faults");
  return alarms;
}

Json StatusJson(const link::State& state, const std::vector<std::string>& cables,
                const Gains& gains) {
  Json boards = Json::array(), motors = Json::array();
  for (std::size_t b = 0; b < state.boards.size(); ++b) {
    boards.push_back(BoardJson(state, b, cables));
  }
  for (std::size_t m = 0; m < state.motors.size(); ++m) {
    const link::MotorView& motor = state.motors[m];
    motors.push_back({{"tension_n", motor.tension_n},
                      {"setpoint_n", motor.set_point_n},
                      {"rest_length_m", motor.rest_length_m},
                      {"encoder_counts", motor.encoder_counts},
                      {"duty", motor.duty},
                      {"temperature_c", motor.temperature_c},
                      {"faults", link::MotorFaultNames(motor.faults)},
                      {"gains", gains[m]}});
  }
  return {{"stage", StageName(state.stage)},
          {"commanded", link::ModeName(state.stopping ? board::Mode::kStopped : state.commanded)},
          {"stopping", state.stopping},
          {"boards", boards},
          {"motors", motors},
          {"link", LinkJson(state.link)}};
}

}  // namespace taut::viewer
