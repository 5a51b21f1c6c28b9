#include "apps/virtual_robot/emulated_robot.h"

#include <algorithm>
#include <utility>

#include "base/assert.h"
#include "math/random.h"

namespace taut::virtual_robot {
namespace {

constexpr std::uint32_t kLoadCellStream =
    0x4C43'0000;  // random stream of a motor, plus the motor's number

std::string Who(int board) { return "board " + std::to_string(board); }

}  // namespace

Robot::Robot(Plant& plant, const RobotOptions& options)
    : plant_(plant),
      options_(options),
      next_plant_step_(options.plant_period),
      bus_(options.seed),
      usb_(bus_, options.usb),
      faults_(options.faults, (plant.motor_count() + 1) / 2, plant.motor_count()),
      state_(faults_.State()) {
  TAUT_ASSERT(options.program && options.plant_period > 0);
  const int motors = plant_.motor_count();
  drives_.resize(static_cast<std::size_t>(motors));
  conversions_.resize(static_cast<std::size_t>(motors));
  stuck_at_.resize(static_cast<std::size_t>(motors));
  for (int i = 0; i < (motors + 1) / 2; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const double drift = index < options_.drift_ppm.size() ? options_.drift_ppm[index] : 0.0;
    boards_.push_back(
        std::make_unique<Board>(options_.program, BoardOptions{i, options_.eeprom, drift}));
    Board& board = *boards_.back();
    bus_.Attach(board.bus_side());
    board.adc_code = [this, i](int channel, Time) {
      return channel < 2 ? AdcCode(2 * i + channel) : 0;
    };
    board.on_reset = [this, i](Time at, ResetCause cause) {
      if (options_.log) options_.log(at, Who(i), std::string("reset: ") + Name(cause));
    };
    board.on_trouble = [this, i](Time at, const std::string& what) {
      if (options_.log) options_.log(at, Who(i), what);
    };
  }
  for (int motor = 0; motor < motors; ++motor) {
    encoders_.emplace_back(options_.encoder, plant_.RotorAngle(motor));
    boards_[static_cast<std::size_t>(motor / 2)]->SetEncoderEdges(motor % 2,
                                                                  {encoders_.back().Now(0)});
  }
  ApplyFaults();
}

Robot::~Robot() = default;

void Robot::Log(std::string_view who, std::string_view what) const {
  if (options_.log) options_.log(now_, who, what);
}

void Robot::LogFrame(const char* arrow, std::span<const std::uint8_t> bytes) const {
  if (options_.log_frames) Log("usb", arrow + Hex(bytes.data(), bytes.size()));
}

void Robot::AdvanceTo(Time time) {
  while (now_ < time) Advance(time);
}

void Robot::Advance(Time limit) {
  Time next = std::min({limit, next_plant_step_, faults_.NextAt(), bus_.SafeUntil(now_)});
  if (usb_.NextAt() > now_) next = std::min(next, usb_.NextAt());
  TAUT_ASSERT(next > now_);
  for (const auto& board : boards_) board->RunUntil(next);
  now_ = next;
  bus_.Step(now_);
  usb_.Step(now_);
  if (now_ == next_plant_step_) StepPlant();
  if (now_ >= faults_.NextAt()) ApplyFaults();
}

MotorDrive Robot::Drive(int motor) const {
  const auto board = static_cast<std::size_t>(motor / 2);
  if (state_.motor_supply_lost || state_.boards[board].driver_fault) return {};
  return boards_[board]->Drive(motor % 2);
}

void Robot::StepPlant() {
  next_plant_step_ += options_.plant_period;
  const auto motors = static_cast<int>(drives_.size());
  for (int motor = 0; motor < motors; ++motor)
    drives_[static_cast<std::size_t>(motor)] = Drive(motor);
  plant_.Advance(ToSeconds(options_.plant_period), drives_);
  for (int motor = 0; motor < motors; ++motor) {
    const auto index = static_cast<std::size_t>(motor);
    // Boards see the rotation of a period one period later.
    const auto edges = encoders_[index].Turn(plant_.RotorAngle(motor), options_.plant_period, now_);
    if (edges.empty() || state_.motors[index].stuck_encoder) continue;
    boards_[index / 2]->SetEncoderEdges(motor % 2, edges);
  }
  if (after_plant_step) after_plant_step(now_);
}

int Robot::AdcCode(int motor) {
  const auto index = static_cast<std::size_t>(motor);
  if (index >= drives_.size()) return 0;
  if (const FaultSpec* stuck = state_.motors[index].stuck_load_cell) {
    return LoadCellCode(options_.load_cell, stuck->force_n.value_or(stuck_at_[index]), 0.0);
  }
  const std::uint32_t stream = kLoadCellStream + static_cast<std::uint32_t>(motor);
  const double noise = math::Random(options_.seed, stream, conversions_[index]++).Normal();
  return LoadCellCode(options_.load_cell, plant_.LoadCellForce(motor), noise);
}

void Robot::ApplyFaults() {
  const std::vector<FaultSchedule::Change> changes = faults_.TakeUntil(now_);
  for (const FaultSchedule::Change& change : changes) {
    const FaultSpec& fault = *change.fault;
    Log("fault", FaultText(fault) + (change.begins ? " begins" : " ends"));
    if (!change.begins) continue;
    if (fault.kind == FaultKind::kFirmwareHang) board(fault.board).Hang();
    if (fault.kind == FaultKind::kBusError) bus_.DisturbNextByte();
    if (fault.kind == FaultKind::kCutCable) plant_.CutCable(fault.cable);
    if (fault.kind == FaultKind::kStuckLoadCell) {
      stuck_at_[static_cast<std::size_t>(fault.cable)] = plant_.LoadCellForce(fault.cable);
    }
  }
  const FaultState old = std::exchange(state_, faults_.State());
  for (std::size_t i = 0; i < boards_.size(); ++i) {
    const FaultState::OfBoard &was = old.boards[i], &is = state_.boards[i];
    Board& board = *boards_[i];
    if (is.drift_ppm != was.drift_ppm) {
      const double usual = i < options_.drift_ppm.size() ? options_.drift_ppm[i] : 0.0;
      board.SetDrift(now_, is.drift_ppm.value_or(usual));
    }
    board.SetPower(now_, !is.lost);
    board.SetBrownOut(now_, is.brown_out);
    board.SetDriverFault(is.driver_fault || state_.motor_supply_lost);
  }
  for (std::size_t i = 0; i < encoders_.size(); ++i) {
    if (old.motors[i].stuck_encoder && !state_.motors[i].stuck_encoder) {
      boards_[i / 2]->SetEncoderEdges(static_cast<int>(i % 2), {encoders_[i].Now(now_)});
    }
  }
  bus_.SetNoise(state_.flips_per_bit);
  bus_.HoldDataLow(state_.data_low);
  bus_.HoldClockLow(state_.clock_low);
  if (state_.usb_lost != old.usb_lost) {
    usb_.PowerCycle();
    bus_.Abandon(now_);
  }
}

void Robot::HostWrites(std::span<const std::uint8_t> burst) {
  if (state_.usb_lost || state_.host_killed) return;
  LogFrame("> ", burst);
  usb_.Receive(now_, burst);
}

std::optional<Bytes> Robot::HostReads() {
  std::optional<Bytes> reply = usb_.TakeReply(now_);
  if (!reply || state_.usb_lost || state_.host_killed) return std::nullopt;
  LogFrame("< ", *reply);
  return reply;
}

std::optional<Bytes> Robot::Transfer(std::span<const std::uint8_t> frame, Time timeout) {
  const Time deadline = now_ + timeout;
  HostWrites(frame);
  while (now_ < deadline) {
    Advance(deadline);
    if (auto reply = HostReads()) return reply;
  }
  return std::nullopt;
}

}  // namespace taut::virtual_robot
