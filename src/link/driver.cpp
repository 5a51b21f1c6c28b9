#include "taut/link/driver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/assert.h"

namespace taut::link {
namespace {

using board::Mode;

/// Number of cycles after which a board must have obeyed a command.
constexpr int kObey = 10;
/// First adapter firmware that ends all transfers with an I2C stop condition.
constexpr int kGoodAdapter = 8;
/// Timeout of the stop command that the destructor sends.
constexpr double kLastWords_s = 0.1;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Driver::Driver(Port& port, DriverOptions options)
    : port_(port),
      options_(std::move(options)),
      adapter_(port),
      requests_(adapter_),
      figures_(static_cast<std::size_t>(options_.motors)),
      values_(figures_.size(), kNone) {
  TAUT_ASSERT(options_.motors >= 1 && options_.motors <= board::kCables);
  const std::size_t boards = (figures_.size() + board::kMotors - 1) / board::kMotors;
  state_.motors.resize(figures_.size());
  state_.boards.resize(boards);
  before_ = state_.boards;
  cable_watches_.resize(figures_.size());
  heard_.resize(boards);
  missed_.resize(boards);
  deaf_.resize(boards);
}

Driver::~Driver() {
  on_cycle = {};  // the objects that these callbacks use may no longer exist
  on_event = {};
  if (state_.stage == Stage::kUnconfigured || !port_.is_open()) return;
  if (state_.stage == Stage::kActive) Stop("the driver ends");
  // Send a stop that was requested but not sent yet.
  const double until_s = port_.now_s() + kLastWords_s;
  for (int i = 0; state_.stopping && i < 2; ++i) CycleBy(until_s);
}

std::size_t Driver::At(int motor) const {
  TAUT_ASSERT(motor >= 0 && motor < options_.motors);
  return static_cast<std::size_t>(motor);
}

std::string Driver::MotorName(int motor) const {
  const auto i = static_cast<std::size_t>(motor);
  return i < options_.cables.size() ? options_.cables[i] : "motor " + std::to_string(motor);
}

bool Driver::FindBoards(Diagnostics& out) {
  const auto info = adapter_.Identify();
  if (!info) {
    out.Error("adapter.no_answer", {}, "no USB-ISS adapter answers at the port",
              "check the port, and close other programs that use the adapter");
    return false;
  }
  adapter_info_ = *info;
  if (info->module_id != kModuleId) {
    out.Error("adapter.unknown_module", {},
              "the adapter is not a USB-ISS: its module number is " +
                  std::to_string(info->module_id) + ", not " + std::to_string(kModuleId));
    return false;
  }
  if (info->firmware_version < kGoodAdapter) {
    out.Warning("adapter.old_firmware", {},
                "the adapter has firmware version " + std::to_string(info->firmware_version) +
                    "; with versions before 8, a board that does not answer blocks the bus");
  }
  if (!adapter_.SetMode()) {
    out.Error("adapter.no_i2c", {}, "the adapter rejects I2C mode at 400 kHz");
    return false;
  }
  bool good = true;
  for (int b = 0; b < board_count(); ++b) {
    const auto said = requests_.Info(b, out);
    if (!said) {
      good = false;
      continue;
    }
    BoardView& board = state_.boards[static_cast<std::size_t>(b)];
    board.info = *said;
    board.there = true;
    if (said->protocol_min > board::kProtocolVersion ||
        said->protocol_max < board::kProtocolVersion ||
        said->parameters_version != board::kParametersVersion) {
      out.Error("board.other_firmware", {},
                "board " + std::to_string(b) + " has an incompatible firmware version, " +
                    std::to_string(said->firmware_major) + "." +
                    std::to_string(said->firmware_minor),
                "install the firmware of this taut with `taut robot flash`");
      good = false;
    }
  }
  return good;
}

bool Driver::ReadFigures(Diagnostics& out) {
  for (int motor = 0; motor < options_.motors; ++motor) {
    MotorFigures& figures = figures_[At(motor)];
    const std::pair<board::MotorParameter, double*> wanted[] = {
        {board::kNewtonsPerCount, &figures.n_per_count},
        {board::kCountsAtZero, &figures.counts_at_zero},
        {board::kLengthPerCount, &figures.m_per_count},
        {board::kReferenceLength, &figures.rest_length_at_reference_m},
        {board::kStiffness, &figures.stiffness_n_per_m}};
    for (const auto& [parameter, to] : wanted) {
      const auto value = requests_.Get(PlaceOf(motor, parameter), out);
      if (!value) return false;
      *to = double{*value};
    }
  }
  return true;
}

void Driver::Watch() {
  bool armed = false;
  for (const BoardView& board : state_.boards) {
    armed = armed ||
            (board.there && board.status.mode != Mode::kOff && board.status.mode != Mode::kStopped);
  }
  // Boards that hold because the connection was lost must continue to hold. The broadcast of this
  // mode makes all boards send their readings.
  say_.mode = armed ? Mode::kHold : Mode::kOff;
  say_.arm = armed ? board::Arm::kGo : board::Arm::kNot;
}

void Driver::FinishCycle() {
  if (under_way_) Cycle(1);
}

bool Driver::Configure(std::span<const Setting> settings, Diagnostics& out, Meanwhile meanwhile) {
  FinishCycle();
  if (state_.stage == Stage::kActive) {
    if (meanwhile == Meanwhile::kOff) {
      Off();
    } else {
      Go(Mode::kHold);
    }
    Cycle(2);
  }
  steps_.clear();
  step_ = 0;
  under_way_ = transfer_under_way_ = false;
  state_.stage = Stage::kUnconfigured;
  state_.stopping = false;
  state_.link = {};
  stops_left_ = unheard_in_row_ = 0;
  clear_due_ = false;
  for (const Waiting& waiting : std::exchange(waiting_, {})) {
    if (waiting.done) waiting.done(std::nullopt);
  }
  if (!FindBoards(out)) return false;
  for (const Setting& setting : settings) {
    if (!requests_.Set(setting, out)) return false;
  }
  if (!ReadFigures(out)) return false;
  // Boards send readings only after a broadcast. This broadcast must not change their power state.
  for (int b = 0; b < board_count(); ++b) {
    const auto faults = requests_.Faults(b, out);
    if (!faults) return false;
    BoardView& board = state_.boards[static_cast<std::size_t>(b)];
    board.status.mode = faults->armed ? Mode::kHold : Mode::kOff;
    board.faults = faults->board;
    board.reset_cause = faults->reset_cause;
    for (int m = 0; m < board::kMotors; ++m) {
      const std::size_t motor = static_cast<std::size_t>(b * board::kMotors + m);
      if (motor < state_.motors.size()) state_.motors[motor].faults = faults->motor[m];
    }
    // Boards ignore a broadcast if they have already seen its sequence number.
    if (const auto status = requests_.ReadStatus(b)) say_.sequence = status->sequence;
  }
  say_.sequence = static_cast<std::uint8_t>(say_.sequence + 32);
  say_.clear_faults = say_.capture = false;
  Watch();
  state_.link.connected = true;
  state_.stage = Stage::kInactive;
  next_cycle_s_ = port_.now_s();
  std::fill(missed_.begin(), missed_.end(), 0);
  std::fill(deaf_.begin(), deaf_.end(), 0);
  before_ = state_.boards;
  for (BoardView& board : before_) board.status.was_reset = true;  // the reset cause was just read
  return true;
}

bool Driver::SetReference(int motor, double rest_length_m, Diagnostics& out) {
  FinishCycle();
  const MotorFigures& figures = figures_[At(motor)];
  const double counts = (figures.rest_length_at_reference_m - rest_length_m) / figures.m_per_count;
  const std::size_t b = At(motor) / board::kMotors;
  const auto whole = static_cast<std::int32_t>(counts + (counts < 0 ? -0.5 : 0.5));
  if (!requests_.SetReference(motor, whole, state_.boards[b].info.nonce, out)) return false;
  state_.motors[At(motor)].encoder_counts = whole;
  return true;
}

void Driver::ForgetStatistics() {
  const bool connected = state_.link.connected;
  state_.link = {};
  state_.link.connected = connected;
  for (BoardView& board : state_.boards) board.bad_frames = board.stale_frames = 0;
  if (!under_way_) next_cycle_s_ = port_.now_s();
}

void Driver::Arm() {
  if (state_.stage == Stage::kUnconfigured) return;
  say_.mode = Mode::kOff;
  say_.arm = board::Arm::kReady;
  say_.capture = false;
  state_.stage = Stage::kReady;
}

bool Driver::Go(Mode mode, bool capture) {
  if (state_.stage != Stage::kReady && state_.stage != Stage::kActive) return false;
  if (state_.stage == Stage::kReady) {
    for (const BoardView& board : state_.boards) {
      const board::Status& status = board.status;
      if (!board.there || status.mode != Mode::kOff || status.faulty || status.timeout) {
        return false;
      }
    }
    if (state_.stopping) return false;
  }
  for (std::size_t m = 0; m < values_.size() && mode == Mode::kPosition; ++m) {
    if (!std::isfinite(values_[m])) values_[m] = state_.motors[m].rest_length_m;
  }
  say_.mode = mode;
  say_.arm = board::Arm::kGo;
  say_.capture = capture;
  state_.stage = Stage::kActive;
  state_.power_commanded = true;
  return true;
}

void Driver::Off() {
  say_.mode = Mode::kOff;
  say_.arm = board::Arm::kNot;
  say_.capture = false;
  std::fill(values_.begin(), values_.end(), kNone);
  if (state_.stage != Stage::kUnconfigured) state_.stage = Stage::kInactive;
}

void Driver::Stop(const std::string& why) {
  if (!state_.stopping) Event("emergency stop: " + why);
  Off();
  state_.stopping = true;
  stops_left_ = 3;
}

void Driver::ClearFaults() {
  clear_due_ = true;
  if (say_.mode != Mode::kHold) Off();
  state_.stopping = false;
  stops_left_ = 0;
}

void Driver::Request(int board, const board::Asking& asking,
                     std::function<void(const std::optional<board::Reply>&)> done) {
  waiting_.push_back({board, asking, std::move(done)});
}

void Driver::RunUntil(double time_s) {
  while (port_.now_s() < time_s) {
    Poll();
    const bool idle = state_.stage == Stage::kUnconfigured;
    port_.Wait(idle ? time_s : std::min(time_s, due_s()));
  }
}

void Driver::Cycle(int count) {
  while (count > 0 && state_.stage != Stage::kUnconfigured) {
    if (Poll()) {
      --count;
      continue;
    }
    if (!state_.link.connected) return;  // the time of reconnection is unknown
    port_.Wait(due_s());
  }
}

bool Driver::CycleBy(double time_s) {
  if (state_.stage == Stage::kUnconfigured) {
    WaitUntil(port_, time_s);
    return false;
  }
  while (!Poll()) {
    if (port_.now_s() >= time_s) return false;
    port_.Wait(std::min(time_s, due_s()));
  }
  return true;
}

bool Driver::Enable(Mode mode, bool capture, Diagnostics& out) {
  if (state_.stage == Stage::kUnconfigured) {
    out.Error("board.not_configured", {}, "boards have not been configured");
    return false;
  }
  Arm();
  Cycle(2);
  if (!Go(Mode::kHold)) {
    for (int b = 0; b < board_count(); ++b) {
      const BoardView& board = state_.boards[static_cast<std::size_t>(b)];
      const std::string who = "board " + std::to_string(b);
      if (!board.there) {
        out.Error("board.no_answer", {}, who + " does not answer");
      } else if (board.status.mode != Mode::kOff || board.status.faulty || board.status.timeout) {
        out.Error("board.not_ready", {},
                  who + " is not ready: " + ModeName(board.status.mode) +
                      (board.status.timeout ? ", timed out" : "") +
                      (board.status.faulty ? ", faults latched" : ""),
                  "list faults with `taut robot status`, clear them with --clear_faults");
      }
    }
    if (state_.stopping)
      out.Error("robot.emergency_stop", {}, "an emergency stop has not been cleared");
    if (out.ok()) out.Error("adapter.lost", {}, "the adapter is gone");
    Off();
    Cycle(1);
    return false;
  }
  const auto obeyed = [&](Mode wanted) {
    for (int i = 0; i < kObey; ++i) {
      Cycle(1);
      if (state_.stage != Stage::kActive) return false;
      if (AllAre(wanted, state_)) return true;
    }
    return false;
  };
  bool good = obeyed(Mode::kHold);
  if (good && mode != Mode::kHold) good = Go(mode, capture) && obeyed(mode);
  if (good) return true;
  for (int b = 0; b < board_count(); ++b) {
    const BoardView& board = state_.boards[static_cast<std::size_t>(b)];
    if (board.there && !board.status.faulty && board.status.mode == say_.mode) continue;
    out.Error("board.does_not_obey", {},
              "board " + std::to_string(b) + " did not follow the command: it is in mode " +
                  ModeName(board.status.mode) +
                  (board.faults != 0 ? " (" + BoardFaultNames(board.faults) + ")" : ""));
  }
  if (out.ok()) out.Error("board.does_not_obey", {}, "the boards did not follow the command");
  Off();
  Cycle(2);
  return false;
}

}  // namespace taut::link
