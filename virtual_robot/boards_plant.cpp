#include "virtual_robot/boards_plant.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace taut::virtual_robot {
namespace {

constexpr int kBoardsPerRead = 3;  // whose frames fit into one reply of the adapter
constexpr Time kAnswerTime = 3 * kMillisecond;
constexpr Time kPollTime = 250 * kMicrosecond;
constexpr int kTries = 3;

/// Gains of a cable under impedance control; null: none.
const ImpedanceGains* GainsOf(const ExperimentSpec& experiment, int cable) {
  for (const ControllerSpec& controller : experiment.controllers) {
    if (!controller.impedance) continue;
    for (const ImpedanceGains& gains : controller.impedance->cables) {
      if (gains.cable == cable) return &gains;
    }
  }
  return nullptr;
}

}  // namespace

BoardsPlant::BoardsPlant(const ExperimentSpec& experiment, MotorPlant& motors,
                         const BoardsOptions& options)
    : experiment_(experiment),
      motors_(motors),
      options_(options),
      simulation_(PlantOf(motors.batch())),
      robot_(motors, options.robot),
      heard_(static_cast<std::size_t>(robot_.board_count())) {}

bool BoardsPlant::Ask(std::uint8_t board, const board::Asking& asking, board::Reply* reply,
                      Diagnostics& out) {
  std::uint8_t request[board::kDoSize];
  const std::size_t size = board::Encode(asking, request);
  const auto address = static_cast<std::uint8_t>(board::BoardAddress(board) << 1);
  Bytes write{0x54, address, static_cast<std::uint8_t>(size)};
  write.insert(write.end(), request, request + size);
  for (int i = 0; i < kTries; ++i) {
    robot_.Transfer(write);
    robot_.AdvanceTo(robot_.now() + kAnswerTime);
    const auto read = robot_.Transfer(
        Bytes{0x54, static_cast<std::uint8_t>(address | 1), std::uint8_t{board::kFrameSize}});
    std::uint8_t frame[board::kFrameSize] = {};
    if (!read || read->size() != sizeof frame) continue;
    std::copy(read->begin(), read->end(), frame);
    if (!board::IsFrame(frame, sizeof frame, board) || !board::IsReply(frame)) continue;
    *reply = board::DecodeReply(frame);
    if (reply->what != asking.what || reply->index != asking.index) continue;
    if (reply->answer == board::Answer::kGood) return true;
    out.Error({},
              "board " + std::to_string(board) + " refuses request " + std::to_string(asking.what) +
                  " of " + std::to_string(asking.index) + ": answer " +
                  std::to_string(static_cast<int>(reply->answer)),
              "docs/hardware/protocol.md lists requests and answers");
    return false;
  }
  out.Error({}, "board " + std::to_string(board) + " does not answer");
  return false;
}

bool BoardsPlant::Set(int motor, board::MotorParameter parameter, double value, Diagnostics& out) {
  board::Reply reply;
  return Ask(static_cast<std::uint8_t>(motor / board::kMotors),
             {board::Request::kSet, static_cast<std::uint8_t>(parameter),
              static_cast<std::uint8_t>(motor % board::kMotors),
              std::bit_cast<std::uint32_t>(static_cast<float>(value)), 0},
             &reply, out);
}

bool BoardsPlant::ReadNonces(Diagnostics& out) {
  for (int b = 0; b < robot_.board_count(); ++b) {
    board::Reply reply;
    if (!Ask(static_cast<std::uint8_t>(b),
             {board::Request::kAsk, static_cast<std::uint8_t>(board::Asked::kInfo), board::kMotors,
              0, 0},
             &reply, out)) {
      return false;
    }
    const board::Info info = board::DecodeInfo(reply.payload);
    nonces_[static_cast<std::size_t>(b)] = info.nonce;
    if (info.protocol_min > board::kProtocolVersion ||
        info.protocol_max < board::kProtocolVersion ||
        info.parameters_version != board::kParametersVersion) {
      out.Error({}, "board " + std::to_string(b) + " has a firmware of another version");
      return false;
    }
  }
  return true;
}

bool BoardsPlant::SetUp(Diagnostics& out) {
  const auto& cables = experiment_.robot.def.cables;
  for (int motor = 0; motor < motors_.motor_count(); ++motor) {
    const int c = motors_.cable(motor);
    const CableDef& cable = cables[static_cast<std::size_t>(c)];
    const DcMotorDef& figures = *cable.actuator.dc_motor;
    const ImpedanceGains* const gains = GainsOf(experiment_, c);
    if (gains == nullptr) {
      out.Error({}, "cable " + cable.name + " has no impedance control in this experiment",
                "the boards control all motors by it");
      return false;
    }
    const double per_rotor_m = figures.spool_radius_m / figures.gear_ratio;
    const double counts_per_rad = 2 * options_.robot.encoder.lines / (2 * std::numbers::pi);
    const double free_m_per_s =
        per_rotor_m * figures.supply_voltage_v / figures.torque_constant_n_m_per_a;
    const bool good =
        Set(motor, board::kTensionOffset, gains->tension_offset_n, out) &&
        Set(motor, board::kLengthOffset, gains->length_offset_m, out) &&
        Set(motor, board::kPositionGain, gains->position_gain_n_per_m, out) &&
        Set(motor, board::kVelocityGain, gains->velocity_gain_n_s_per_m, out) &&
        Set(motor, board::kLengthPerCount, per_rotor_m / counts_per_rad, out) &&
        Set(motor, board::kReferenceLength, cable.rest_length_m, out) &&
        Set(motor, board::kStiffness, cable.stiffness_n_per_m, out) &&
        Set(motor, board::kSpeedLimit, 1.3 * free_m_per_s, out) &&
        Set(motor, board::kNewtonsPerCount, options_.robot.load_cell.n_per_count, out) &&
        Set(motor, board::kCountsAtZero, options_.robot.load_cell.zero_counts, out);
    if (!good) return false;
    for (const BoardSetting& setting : options_.settings) {
      if (!Set(motor, static_cast<board::MotorParameter>(setting.parameter), double{setting.value},
               out)) {
        return false;
      }
    }
    board::Reply reply;
    const auto b = static_cast<std::uint8_t>(motor / board::kMotors);
    if (!Ask(b,
             {board::Request::kDo, static_cast<std::uint8_t>(board::Action::kSetReference),
              static_cast<std::uint8_t>(motor % board::kMotors), 0, nonces_[b]},
             &reply, out)) {
      return false;
    }
  }
  return true;
}

bool BoardsPlant::Prepare(Diagnostics& out) {
  motors_.SetHeld(true);
  robot_.AdvanceTo(100 * kMillisecond);      // the boards begin
  const Bytes mode{0x5a, 0x02, 0x70, 0x04};  // 400 kHz
  if (robot_.Transfer(mode) != Bytes{0xff, 0x00}) {
    out.Error({}, "the USB adapter does not answer");
    return false;
  }
  if (!ReadNonces(out) || !SetUp(out)) return false;
  say_.clear_faults = true;
  say_.mode = board::Mode::kOff;
  say_.arm = board::Arm::kReady;
  Exchange();
  say_.clear_faults = false;
  Exchange();
  say_.arm = board::Arm::kGo;
  say_.mode = board::Mode::kHold;
  for (int i = 0; i < 5; ++i) Exchange();
  for (std::size_t b = 0; b < heard_.size(); ++b) {
    if (heard_[b].at < 0 || heard_[b].status.mode != board::Mode::kHold ||
        heard_[b].status.faulty) {
      out.Error({}, "board " + std::to_string(b) + " does not hold its motors");
      return false;
    }
  }
  say_.mode = board::Mode::kImpedance;
  late_before_ = CountLateTicks();
  motors_.SetHeld(false);
  started_ = next_cycle_ = robot_.now();
  bad_frames_ = 0;
  return true;
}

int BoardsPlant::CountLateTicks() {
  int late = 0;
  for (int b = 0; b < robot_.board_count(); ++b) {
    board::Reply reply;
    Diagnostics silent;
    const board::Asking asking{board::Request::kAsk,
                               static_cast<std::uint8_t>(board::Asked::kCounters), board::kMotors,
                               0, 0};
    if (Ask(static_cast<std::uint8_t>(b), asking, &reply, silent)) {
      late += board::internal::Get16(reply.payload + 2);
    }
  }
  return late;
}

int BoardsPlant::LateTicks() { return CountLateTicks() - late_before_; }

std::vector<Bytes> BoardsPlant::CycleFrames() {
  ++say_.sequence;
  const Commands& commands = simulation_->commands();
  for (int motor = 0; motor < motors_.motor_count(); ++motor) {
    const double v_m_per_s = commands.velocity_input_m_per_s[motors_.cable(motor)];
    const double units = std::round(v_m_per_s / double{board::kSpeedUnit_m_per_s});
    say_.values[motor] = static_cast<std::int16_t>(std::clamp(units, -32767.0, 32767.0));
  }
  std::uint8_t message[board::kCyclicSize];
  board::Encode(say_, message);
  std::vector<Bytes> frames{
      {0x54, board::kBroadcastAddress << 1, std::uint8_t{board::kCyclicSize}}};
  frames[0].insert(frames[0].end(), std::begin(message), std::end(message));
  for (int first = 0; first < robot_.board_count(); first += kBoardsPerRead) {
    Bytes request{0x57};
    for (int b = first; b < std::min(first + kBoardsPerRead, robot_.board_count()); ++b) {
      const int address = board::BoardAddress(static_cast<std::uint8_t>(b)) << 1 | 1;
      request.insert(request.end(), {0x01, 0x30, static_cast<std::uint8_t>(address),
                                     0x20 + board::kFrameSize - 2, 0x04, 0x20, 0x03});
    }
    frames.push_back(request);
  }
  return frames;
}

void BoardsPlant::TakeReply(const Bytes& reply) {
  const std::size_t which = answered_++;
  if (which == 0) return;  // of the broadcast: that somebody was there
  const std::size_t first = (which - 1) * kBoardsPerRead;
  const std::size_t count = std::min<std::size_t>(kBoardsPerRead, heard_.size() - first);
  const bool whole = reply.size() == 2 + count * board::kFrameSize && reply[0] == 0xff;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint8_t frame[board::kFrameSize] = {};
    if (whole) {
      std::copy_n(reply.begin() + 2 + static_cast<std::ptrdiff_t>(i * sizeof frame), sizeof frame,
                  frame);
    }
    const auto b = static_cast<std::uint8_t>(first + i);
    if (!whole || !board::IsFrame(frame, sizeof frame, b) || board::IsReply(frame)) {
      ++bad_frames_;
      continue;
    }
    Heard& heard = heard_[b];
    heard.status = board::DecodeStatus(frame);
    heard.at = robot_.now();
    heard.more[heard.status.sequence % board::kMores] = heard.status.more;
  }
}

void BoardsPlant::Exchange() {
  answered_ = 0;
  const Time begun = robot_.now();
  for (const Bytes& frame : CycleFrames()) {
    if (const auto reply = robot_.Transfer(frame)) TakeReply(*reply);
  }
  robot_.AdvanceTo(std::max(robot_.now(), begun + options_.period));
}

void BoardsPlant::Poll() {
  const auto reply = robot_.HostReads();
  if (reply && answered_ < sent_) TakeReply(*reply);
  const bool idle = answered_ == frames_.size();
  if (idle && !frames_.empty()) {
    const double took_s = ToSeconds(robot_.now() - cycle_begun_);
    cycle_sum_s_ += took_s;
    longest_cycle_s_ = std::max(longest_cycle_s_, took_s);
    ++cycles_;
    frames_.clear();
    sent_ = answered_ = 0;
    if (on_cycle) on_cycle(ToSeconds(robot_.now() - started_));
  }
  if (robot_.now() >= next_cycle_) {
    if (!frames_.empty()) ++late_cycles_;
    frames_ = CycleFrames();
    sent_ = answered_ = 0;
    cycle_begun_ = robot_.now();
    next_cycle_ += options_.period;
  }
  if (sent_ == answered_ && sent_ < frames_.size()) robot_.HostWrites(frames_[sent_++]);
}

void BoardsPlant::Advance(const double* /*step_s*/, const double* to_s) {
  const Time end = started_ + FromSeconds(to_s[0]);
  while (robot_.now() < end) {
    Poll();
    robot_.AdvanceTo(std::min(end, robot_.now() + kPollTime));
  }
  time_s_ = to_s[0];
}

const Observation& BoardsPlant::Observe() {
  seen_ = simulation_->Observe();
  seen_.time_s = &time_s_;
  return seen_;
}

}  // namespace taut::virtual_robot
