// Monitoring of boards and cables after each cycle, and reactions to faults.
#include <algorithm>
#include <cstdlib>

#include "taut/link/driver.h"

namespace taut::link {
namespace {

using board::Mode;

constexpr int kRequestTries = 3;
constexpr int kResetAfter = 3;  // consecutive broadcasts without acknowledgment before a bus reset

constexpr double kSlack_n = 0.5, kTaut_n = 2;
constexpr int kSlackCycles = 20;
// If the rest length changes by this distance, the load cell reading must change despite its noise:
// the tension of a spring of 230 N/m changes by 0.7 N.
constexpr double kShowing_m = 0.003;
// Fewer equal readings may occur by chance, since one in three pairs of consecutive readings is
// equal.
constexpr int kSameCycles = 20;

board::Asking AskForFaults() {
  return {board::Request::kAsk, static_cast<std::uint8_t>(board::Asked::kFaults), board::kMotors, 0,
          0};
}

}  // namespace

void Driver::Event(const std::string& text) {
  if (on_event) on_event(port_.now_s(), text);
}

void Driver::React(const std::string& why) {
  if (state_.stage != Stage::kActive) return;
  switch (options_.on_fault) {
    case OnFault::kStop:
      Stop(why);
      return;
    case OnFault::kOff:
      Event("all motors off: " + why);
      Off();
      return;
    case OnFault::kHold:
      if (say_.mode == Mode::kHold) return;
      Event("all motors hold: " + why);
      say_.mode = Mode::kHold;
      say_.capture = false;
  }
}

/// Reports only new faults, since a board may already be faulty when its second motor fails.
void Driver::TakeFaults(int board, int index, std::uint8_t bits) {
  const int motor = board * board::kMotors + index;
  const bool of_motor = index < board::kMotors;
  if (of_motor && motor >= options_.motors) return;
  std::uint8_t& known = of_motor ? state_.motors[At(motor)].faults
                                 : state_.boards[static_cast<std::size_t>(board)].faults;
  const unsigned fresh = bits & ~unsigned{known};
  known = bits;
  if (fresh == 0) return;
  Event(of_motor ? MotorName(motor) + ": " + MotorFaultNames(fresh)
                 : "board " + std::to_string(board) + ": " + BoardFaultNames(fresh));
}

void Driver::LookAt(int board, const BoardView& before) {
  const auto b = static_cast<std::size_t>(board);
  BoardView& now = state_.boards[b];
  const std::string who = "board " + std::to_string(board);
  if (heard_[b]) {
    missed_[b] = 0;
    if (!now.there) Event(who + " answers again");
    now.there = true;
  } else if (now.there && !IsExcused() && ++missed_[b] >= options_.lost_after) {
    now.there = false;
    Event(who + " does not answer");
    if (state_.stage == Stage::kActive) Stop(who + " does not answer");
    return;
  }
  if (!heard_[b]) return;
  const board::Status& was = before.status;
  const board::Status& is = now.status;
  deaf_[b] = is.sequence == was.sequence ? deaf_[b] + 1 : 0;
  if (deaf_[b] == options_.lost_after) {
    Event(who + " receives no broadcasts");
    React(who + " receives no broadcasts");
  }
  if (is.mode != was.mode) Event(who + ": " + ModeName(was.mode) + " -> " + ModeName(is.mode));
  if (is.was_reset && !was.was_reset) {
    Event(who + " was reset");
    Request(board, AskForFaults(), [this, b, who](const std::optional<board::Reply>& reply) {
      if (!reply) return;
      const FaultReport report = DecodeFaults(*reply);
      state_.boards[b].reset_cause = report.reset_cause;
      Event(who + ": reset cause " + ResetCauseNames(report.reset_cause));
    });
    React(who + " was reset");
  }
  if (is.timeout && !was.timeout) {
    Event(who + " received no broadcast in time");
    React(who + " received no broadcast in time");
  }
  if (is.faulty && !was.faulty) {
    Request(board, AskForFaults(), [this, board](const std::optional<board::Reply>& reply) {
      if (!reply) return;
      const FaultReport report = DecodeFaults(*reply);
      TakeFaults(board, board::kMotors, report.board);
      for (int m = 0; m < board::kMotors; ++m) TakeFaults(board, m, report.motor[m]);
    });
    React(who + " has a fault");
  }
  if (!is.faulty && was.faulty) {
    for (int index = 0; index <= board::kMotors; ++index) TakeFaults(board, index, 0);
  }
}

/// Detects cut cables and load cells with a constant reading. Boards detect these faults only after
/// they have wound in a long distance.
void Driver::LookAtCable(int motor) {
  CableWatch& watch = cable_watches_[At(motor)];
  const MotorView& now = state_.motors[At(motor)];
  const std::size_t b = At(motor) / board::kMotors;
  if (state_.stage != Stage::kActive) {
    watch = {};
    return;
  }
  if (!heard_[b]) return;
  watch.slack_cycles = now.tension_n < kSlack_n ? watch.slack_cycles + 1 : 0;
  if (!watch.slack && watch.slack_cycles >= kSlackCycles) {
    watch.slack = true;
    Event(MotorName(motor) + " is slack");
  } else if (watch.slack && now.tension_n > kTaut_n) {
    watch.slack = false;
    Event(MotorName(motor) + " is taut again");
  }
  const int quarters = state_.boards[b].status.motors[motor % board::kMotors].tension_quarters;
  if (quarters != watch.quarters) {
    watch.quarters = quarters;
    watch.counts = now.encoder_counts;
    watch.stands = false;
    watch.same_cycles = 0;
  } else if (++watch.same_cycles >= kSameCycles && !watch.stands && !watch.slack &&
             now.tension_n >= kSlack_n) {
    const double way_m = static_cast<double>(std::abs(now.encoder_counts - watch.counts)) *
                         figures_[At(motor)].m_per_count;
    watch.stands = way_m > kShowing_m;
    if (watch.stands) Event(MotorName(motor) + ": its load cell reading does not change");
  }
}

void Driver::EndCycle() {
  LinkView& link = state_.link;
  ++link.cycles;
  state_.time_s = port_.now_s();
  link.cycle_s = state_.time_s - cycle_begun_s_;
  link.longest_cycle_s = std::max(link.longest_cycle_s, link.cycle_s);
  const double share = 1.0 / static_cast<double>(link.cycles);
  link.mean_cycle_s += (link.cycle_s - link.mean_cycle_s) * share;
  link.mean_lateness_s += (link.lateness_s - link.mean_lateness_s) * share;

  // Give up requests that received no answer.
  for (std::size_t i = 0; i < waiting_.size();) {
    if (waiting_[i].tries < kRequestTries || waiting_[i].rest > 1) {
      ++i;
      continue;
    }
    const auto done = std::move(waiting_[i].done);
    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
    if (done) done(std::nullopt);
  }
  for (int b = 0; b < board_count(); ++b) LookAt(b, before_[static_cast<std::size_t>(b)]);
  for (int motor = 0; motor < options_.motors; ++motor) LookAtCable(motor);
  before_ = state_.boards;
  if (unheard_in_row_ >= kResetAfter) {
    unheard_in_row_ = 0;
    ++link.adapter_resets;
    Event("no board acknowledges broadcasts: the adapter's bus is reset");
    adapter_.SetMode();
  }
  state_.commanded = say_.mode;
  if (on_cycle) on_cycle(state_);
}

}  // namespace taut::link
