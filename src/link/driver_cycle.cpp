// Communication cycle with the boards: requests, broadcast of commands, replies.
#include <algorithm>
#include <cmath>
#include <utility>

#include "link/frames.h"
#include "taut/link/driver.h"

namespace taut::link {
namespace {

using board::Mode;

constexpr std::size_t kBoardsPerReply = 3;  // number of boards per reply, limited by the adapter
constexpr int kReadTries = 2;               // attempts to read a frame within a cycle
constexpr int kLookForLost = 10;            // cycles between two attempts to reach a lost board
// A board processes a request within 2 ms, so its answer may be available in the next cycle.
constexpr int kAnswerCycles = 2;
constexpr double kReconnect_s = 0.25;
/// Time for which missing replies are excused: a busy computer delays them, which is not a fault of
/// the boards. Boards do not time out within this time either.
constexpr double kAdapterPatience_s = 0.001 * board::kTimeoutTicks;

}  // namespace

std::int16_t Driver::OnWire(int motor) const {
  const MotorFigures& figures = figures_[At(motor)];
  double units = 0;
  switch (say_.mode) {
    case Mode::kPosition:
      units = (figures.rest_length_at_reference_m - values_[At(motor)]) / figures.m_per_count;
      // Command the present position, because 0 may be far away.
      if (!std::isfinite(units)) {
        units = static_cast<double>(state_.motors[At(motor)].encoder_counts);
      }
      break;
    case Mode::kImpedance:
      units = values_[At(motor)] / double{board::kSpeedUnit_m_per_s};
      break;
    case Mode::kDuty:
      units = values_[At(motor)] * 32767.0;
      break;
    default:
      break;
  }
  return std::isfinite(units) ? board::ToWire(units) : std::int16_t{0};
}

void Driver::BeginCycle() {
  const double now_s = port_.now_s();
  LinkView& link = state_.link;
  link.lateness_s = now_s - next_cycle_s_;
  link.longest_lateness_s = std::max(link.longest_lateness_s, link.lateness_s);
  cycle_begun_s_ = now_s;
  next_cycle_s_ += options_.period_s;
  // Skip cycles that were missed completely.
  if (now_s >= next_cycle_s_) {
    ++link.late_cycles;
    next_cycle_s_ = now_s + options_.period_s;
  }
  under_way_ = true;
  steps_.clear();
  step_ = 0;
  std::fill(heard_.begin(), heard_.end(), false);
  silent_in_cycle_ = false;

  if (state_.stopping) {
    std::uint8_t stop[board::kStopSize];
    board::EncodeStop(stop);
    const Bytes frame = UsbIss::WriteFrame(board::kBroadcastAddress, stop);
    for (int i = 0; i < std::max(1, stops_left_); ++i) {
      steps_.push_back({Step::Kind::kStop, frame, {1}});
    }
    stops_left_ = 0;
  }
  AddRequest();
  ++say_.sequence;
  say_.clear_faults = std::exchange(clear_due_, false);
  for (int motor = 0; motor < options_.motors; ++motor) say_.values[motor] = OnWire(motor);
  std::uint8_t message[board::kCyclicSize];
  board::Encode(say_, message);
  steps_.push_back(
      {Step::Kind::kBroadcast, UsbIss::WriteFrame(board::kBroadcastAddress, message), {1}});
  AddReads();
}

void Driver::AddRequest() {
  for (Waiting& waiting : waiting_) waiting.rest = std::max(0, waiting.rest - 1);
  for (Waiting& waiting : waiting_) {
    // A board answers only its last request, so a board has one open request at a time.
    const bool first = &*std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& one) {
      return one.board == waiting.board;
    }) == &waiting;
    if (!first || waiting.rest > 0) continue;
    std::uint8_t request[board::kDoSize];
    const std::size_t size = board::Encode(waiting.asking, request);
    const auto address = board::BoardAddress(static_cast<std::uint8_t>(waiting.board));
    steps_.push_back({Step::Kind::kRequest, UsbIss::WriteFrame(address, {request, size}), {1}});
    waiting.rest = kAnswerCycles;
    ++waiting.tries;
    return;  // one request per cycle, since requests to six boards would make a cycle late
  }
}

void Driver::AddReads() {
  std::vector<int> group;
  const auto close = [&] {
    if (group.empty()) return;
    std::vector<std::uint8_t> addresses;
    for (const int b : group)
      addresses.push_back(board::BoardAddress(static_cast<std::uint8_t>(b)));
    steps_.push_back({Step::Kind::kGroup,
                      UsbIss::ReadsFrame(addresses, board::kFrameSize),
                      {group.size() * board::kFrameSize, true},
                      group});
    group.clear();
  };
  for (int b = 0; b < board_count(); ++b) {
    // Exclude absent boards: one absent board makes the whole group read fail.
    if (state_.boards[static_cast<std::size_t>(b)].there) {
      group.push_back(b);
    } else if (state_.link.cycles % kLookForLost == 0) {
      ReadAgain(b, kReadTries);
    }
    if (group.size() == kBoardsPerReply) close();
  }
  close();
}

void Driver::ReadAgain(int board, int tries) {
  const auto address = board::BoardAddress(static_cast<std::uint8_t>(board));
  steps_.push_back({Step::Kind::kOne,
                    UsbIss::ReadFrame(address, board::kFrameSize),
                    {board::kFrameSize},
                    {board},
                    tries});
}

bool Driver::Poll() {
  if (state_.stage == Stage::kUnconfigured) return false;
  if (!state_.link.connected && !TryReconnect()) return false;
  if (!under_way_) {
    if (port_.now_s() < next_cycle_s_) return false;
    BeginCycle();
  }
  for (;;) {
    if (transfer_under_way_) {
      const UsbIss::State how = adapter_.Poll();
      if (how == UsbIss::State::kPending) return false;
      transfer_under_way_ = false;
      if (how == UsbIss::State::kLost) {
        Lost();
        return false;
      }
      EndStep(how);
      ++step_;
    }
    if (step_ == steps_.size()) {
      under_way_ = false;
      EndCycle();
      return true;
    }
    adapter_.Begin(steps_[step_].frame, steps_[step_].shape, options_.patience_s);
    transfer_under_way_ = true;
  }
}

bool Driver::IsExcused() const {
  return silent_in_cycle_ && port_.now_s() < replied_s_ + kAdapterPatience_s;
}

double Driver::due_s() const {
  if (!state_.link.connected) return reconnect_s_;
  return transfer_under_way_ ? adapter_.due_s() : next_cycle_s_;
}

void Driver::EndStep(UsbIss::State how) {
  const Step step = steps_[step_];  // copy, since the code below may add steps
  const Bytes& reply = adapter_.reply();
  const bool silent = how == UsbIss::State::kSilent;
  if (silent) {
    ++state_.link.silent_transfers;
    silent_in_cycle_ = true;
  } else {
    replied_s_ = port_.now_s();
  }
  switch (step.kind) {
    case Step::Kind::kStop:
    case Step::Kind::kRequest:
      break;
    case Step::Kind::kBroadcast: {
      const bool heard = !silent && reply[0] != 0;
      if (!IsExcused()) unheard_in_row_ = heard ? 0 : unheard_in_row_ + 1;
      if (heard) break;
      ++state_.link.unheard_broadcasts;
      if (step.tries + 1 < kReadTries && !silent) {
        Step again = step;  // boards that have received the command ignore its repeated sequence
                            // number
        ++again.tries;
        steps_.insert(steps_.begin() + static_cast<std::ptrdiff_t>(step_) + 1, again);
      }
      break;
    }
    case Step::Kind::kGroup: {
      const bool whole =
          !silent && reply[0] == 0xff && reply.size() == 2 + step.boards.size() * board::kFrameSize;
      if (!whole && !silent) ++state_.link.failed_group_reads;
      for (std::size_t i = 0; i < step.boards.size(); ++i) {
        if (whole) {
          TakeFrame(step.boards[i],
                    std::span(reply).subspan(2 + i * board::kFrameSize, board::kFrameSize), 0);
        } else if (!silent) {
          ReadAgain(step.boards[i], 1);  // a board may be absent, so read each one separately
        } else {
          ++state_.boards[static_cast<std::size_t>(step.boards[i])].bad_frames;
        }
      }
      break;
    }
    case Step::Kind::kOne: {
      const int board = step.boards[0];
      if (silent) {
        CountBad(board, step.tries);
      } else {
        TakeFrame(board, reply, step.tries);
      }
    }
  }
}

/// Counts a bad frame. The last attempt to read a lost board does not count, since it usually
/// fails.
void Driver::CountBad(int board, int tries) {
  BoardView& view = state_.boards[static_cast<std::size_t>(board)];
  if (view.there || tries < kReadTries) ++view.bad_frames;
}

void Driver::TakeFrame(int board, std::span<const std::uint8_t> bytes, int tries) {
  const auto number = static_cast<std::uint8_t>(board);
  if (const auto status = StatusIn(bytes, number)) return TakeStatus(board, *status);
  if (const auto reply = ReplyIn(bytes, number)) {
    TakeReply(board, *reply);
  } else {
    CountBad(board, tries);
  }
  // Read again until the status arrives, up to the limit of tries.
  if (tries < kReadTries) ReadAgain(board, tries + 1);
}

void Driver::TakeStatus(int board, const board::Status& status) {
  const auto b = static_cast<std::size_t>(board);
  BoardView& view = state_.boards[b];
  heard_[b] = true;
  view.heard_s = port_.now_s();
  if (status.sequence != say_.sequence) ++view.stale_frames;
  view.status = status;
  const auto more = static_cast<board::More>(status.sequence % board::kMores);
  for (std::size_t m = 0; m < board::kMotors; ++m) {
    const std::size_t motor = b * board::kMotors + m;
    if (motor >= state_.motors.size()) break;
    MotorView& to = state_.motors[motor];
    const board::MotorStatus& from = status.motors[m];
    const MotorFigures& figures = figures_[motor];
    const auto newtons = [&](std::uint16_t quarters) {
      return board::ForceOf(quarters, figures.n_per_count, figures.counts_at_zero);
    };
    to.tension_n = newtons(from.tension_quarters);
    to.set_point_n = status.mode == Mode::kImpedance ? newtons(from.set_point_quarters)
                                                     : std::numeric_limits<double>::quiet_NaN();
    // The frame contains the lowest 16 bits of the count. Within a cycle, the count changes by less
    // than half of their range.
    to.encoder_counts += static_cast<std::int16_t>(from.encoder_counts -
                                                   static_cast<std::uint16_t>(to.encoder_counts));
    to.rest_length_m = figures.rest_length_at_reference_m -
                       static_cast<double>(to.encoder_counts) * figures.m_per_count;
    to.length_m = control::LengthFromTension(to.rest_length_m, std::max(0.0, to.tension_n),
                                             figures.stiffness_n_per_m);
    to.duty = from.duty / 127.0;
    if (more == (m == 0 ? board::More::kFaults0 : board::More::kFaults1)) {
      TakeFaults(board, static_cast<int>(m), status.more);
    }
    if (more == (m == 0 ? board::More::kTemperature0C : board::More::kTemperature1C)) {
      to.temperature_c = status.more;
    }
  }
  switch (more) {
    case board::More::kBoardFaults:
      TakeFaults(board, board::kMotors, status.more);
      break;
    case board::More::kCrcErrors:
      view.bad_messages = status.more;
      break;
    case board::More::kOverruns:
      view.late_ticks = status.more;
      break;
    case board::More::kLoopTime8us:
      view.loop_time_s = status.more * 8e-6;
      break;
    case board::More::kResetCause:
      view.reset_cause = status.more;
      break;
    case board::More::kMissed:
      view.missed_broadcasts = status.more;
      break;
    case board::More::kRecoveries:
      view.bus_recoveries = status.more;
      break;
    default:
      break;
  }
}

void Driver::TakeReply(int board, const board::Reply& reply) {
  const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& one) {
    return one.tries > 0 && one.board == board && one.asking.what == reply.what &&
           one.asking.index == reply.index;
  });
  if (found == waiting_.end()) return;  // answer to an earlier request
  const auto done = std::move(found->done);
  waiting_.erase(found);
  if (done) done(reply);
}

void Driver::Lost() {
  Event("the adapter is gone");
  state_.link.connected = false;
  under_way_ = false;
  reconnect_s_ = port_.now_s() + kReconnect_s;
}

bool Driver::TryReconnect() {
  if (port_.now_s() < reconnect_s_) return false;
  reconnect_s_ = port_.now_s() + kReconnect_s;
  if (!port_.is_open() && !port_.Reopen()) return false;
  if (!adapter_.SetMode()) return false;
  state_.link.connected = true;
  ++state_.link.reconnections;
  next_cycle_s_ = port_.now_s();
  Event("the adapter is back");
  // The boards have timed out meanwhile: they hold or are off until their faults are cleared.
  if (state_.stage == Stage::kActive) say_.mode = Mode::kHold;
  return true;
}

}  // namespace taut::link
