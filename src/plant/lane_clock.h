/// Clock of a sensor or controller. The clock has one tick counter per lane, since lanes restart
/// independently.
#pragma once

#include <cstdint>
#include <vector>

#include "taut/control/clock.h"
#include "taut/lane_state.h"
#include "taut/plant.h"

namespace taut::plant {

class LaneClock {
 public:
  LaneClock(const ClockSpec& spec, int lanes)
      : clock_{spec.period_s, spec.phase_s}, ticks_(static_cast<std::size_t>(lanes)) {}

  /// Returns the lanes of `among` in which a tick is due.
  Tick Due(const double* time_s, Lanes among) const noexcept {
    if (together_) {
      const bool due = control::IsDue(clock_, ticks_[0], time_s[0]);
      return {due ? among : 0, ticks_.data()};
    }
    Lanes due = 0;
    for (std::size_t j = 0; j < ticks_.size(); ++j) {
      if (control::IsDue(clock_, ticks_[j], time_s[j])) due |= Lanes{1} << j;
    }
    return {due & among, ticks_.data()};
  }

  /// Increments the tick counter of `lanes`.
  void Advance(Lanes lanes) noexcept {
    for (std::size_t j = 0; j < ticks_.size(); ++j) ticks_[j] += lanes >> j & 1u;
  }

  double NextS(int lane) const noexcept {
    return control::TickTime(clock_, ticks_[static_cast<std::size_t>(lane)]);
  }

  void Restart(int lane) noexcept {
    ticks_[static_cast<std::size_t>(lane)] = 0;
    together_ = ticks_.size() == 1;
  }
  /// Serializes the counter of a lane. To restore, restart the lane first.
  void Serialize(LaneState& state) { state.Row(ticks_); }

 private:
  control::Clock<double> clock_;
  std::vector<std::int64_t> ticks_;
  bool together_ = true;  ///< No lane was restarted, so all counters are equal.
};

}  // namespace taut::plant
