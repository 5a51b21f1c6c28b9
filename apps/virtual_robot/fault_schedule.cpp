#include "apps/virtual_robot/fault_schedule.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace taut::virtual_robot {

FaultSchedule::FaultSchedule(std::vector<FaultSpec> faults, int boards, int motors)
    : board_count_(boards), motor_count_(motors), faults_(std::move(faults)) {
  for (const FaultSpec& fault : faults_) {
    changes_.push_back({FromSeconds(fault.at_s), true, &fault});
    if (std::isfinite(fault.for_s)) {
      changes_.push_back({FromSeconds(fault.at_s + fault.for_s), false, &fault});
    }
  }
  std::stable_sort(changes_.begin(), changes_.end(), [](const Change& a, const Change& b) {
    return std::pair(a.at, a.begins) < std::pair(b.at, b.begins);
  });
}

std::vector<FaultSchedule::Change> FaultSchedule::TakeUntil(Time now) {
  const std::size_t first = next_;
  while (next_ < changes_.size() && changes_[next_].at <= now) ++next_;
  const auto begin = changes_.begin();
  return {begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(next_)};
}

FaultState FaultSchedule::State() const {
  FaultState state;
  state.boards.resize(static_cast<std::size_t>(board_count_));
  state.motors.resize(static_cast<std::size_t>(motor_count_));
  std::vector<const FaultSpec*> active;
  for (std::size_t i = 0; i < next_; ++i) {
    if (changes_[i].begins) {
      active.push_back(changes_[i].fault);
    } else {
      active.erase(std::find(active.begin(), active.end(), changes_[i].fault));
    }
  }
  for (const FaultSpec* fault : active) {
    const auto board = [&]() -> FaultState::OfBoard& {
      return state.boards.at(static_cast<std::size_t>(fault->board));
    };
    const auto motor = [&]() -> FaultState::OfMotor& {
      return state.motors.at(static_cast<std::size_t>(fault->cable));
    };
    switch (fault->kind) {
      case FaultKind::kClockDrift:
        board().drift_ppm = fault->drift_ppm;
        break;
      case FaultKind::kBoardLoss:
        board().lost = true;
        break;
      case FaultKind::kBrownOut:
        board().brown_out = true;
        break;
      case FaultKind::kDriverFault:
        board().driver_fault = true;
        break;
      case FaultKind::kBusNoise:
        state.flips_per_bit = fault->flips_per_bit;
        break;
      case FaultKind::kBusStuck:
        (fault->line == BusLine::kData ? state.data_low : state.clock_low) = true;
        break;
      case FaultKind::kStuckLoadCell:
        motor().stuck_load_cell = fault;
        break;
      case FaultKind::kStuckEncoder:
        motor().stuck_encoder = true;
        break;
      case FaultKind::kMotorSupplyLoss:
        state.motor_supply_lost = true;
        break;
      case FaultKind::kUsbLoss:
        state.usb_lost = true;
        break;
      case FaultKind::kHostKilled:
        state.host_killed = true;
        break;
      case FaultKind::kFirmwareHang:  // these are events, not states
      case FaultKind::kBusError:
      case FaultKind::kCutCable:
        break;
    }
  }
  return state;
}

std::string FaultText(const FaultSpec& fault) {
  std::string text = FaultName(fault.kind);
  if (fault.board >= 0) text += " of board " + std::to_string(fault.board);
  if (fault.cable >= 0) text += " of cable " + std::to_string(fault.cable);
  return text;
}

}  // namespace taut::virtual_robot
