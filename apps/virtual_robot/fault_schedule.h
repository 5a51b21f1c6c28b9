/// Schedule of a fault script: active faults at a time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/virtual_robot/emulated_time.h"
#include "taut/faults.h"

namespace taut::virtual_robot {

/// Combined effect of the active faults. If several set the same quantity, the last to begin wins.
struct FaultState {
  struct OfBoard {
    std::optional<double> drift_ppm;
    bool lost = false, brown_out = false, driver_fault = false;
  };
  struct OfMotor {
    const FaultSpec* stuck_load_cell = nullptr;
    bool stuck_encoder = false;
  };
  std::vector<OfBoard> boards;
  std::vector<OfMotor> motors;
  double flips_per_bit = 0;
  bool data_low = false, clock_low = false;
  bool motor_supply_lost = false, usb_lost = false, host_killed = false;
};

class FaultSchedule {
 public:
  FaultSchedule(std::vector<FaultSpec> faults, int boards, int motors);
  FaultSchedule(const FaultSchedule&) = delete;  // states point into the schedule
  FaultSchedule& operator=(const FaultSchedule&) = delete;

  /// Returns the time of the next begin or end; `kNever` after the last.
  Time NextAt() const { return next_ < changes_.size() ? changes_[next_].at : kNever; }

  struct Change {
    Time at = 0;
    bool begins = false;
    const FaultSpec* fault = nullptr;
  };
  /// Returns all begins and ends up to `now`, in order; ends precede begins at the same time.
  std::vector<Change> TakeUntil(Time now);
  /// Returns the state after all changes taken so far.
  FaultState State() const;

 private:
  int board_count_, motor_count_;
  std::vector<FaultSpec> faults_;
  std::vector<Change> changes_;
  std::size_t next_ = 0;
};

/// Returns the text for logs, such as "board_loss of board 2".
std::string FaultText(const FaultSpec& fault);

}  // namespace taut::virtual_robot
