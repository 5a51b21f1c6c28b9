/// Schedule of the steps of an experiment. Steps are not longer than requested and end at every
/// boundary: tick of a controller or sensor, corner of the timeline, end of the experiment. The
/// schedule depends on nothing that differs between worlds, so one world and a batch use the same
/// schedule.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "taut/lane_state.h"

namespace taut::plant {

/// Tolerance for equal times, since times are sums of steps.
inline constexpr double kTimeToleranceS = 1e-9;

class Schedule {
 public:
  Schedule(double step_s, double duration_s) : wanted_s_(step_s), duration_s_(duration_s) {}

  double time_s() const noexcept { return time_s_; }
  double step_s() const noexcept { return step_s_; }  ///< Step length up to the boundary.
  bool AtBoundary() const noexcept { return done_ >= steps_; }
  std::int64_t left() const noexcept { return steps_ - done_; }  ///< Steps up to the boundary.

  /// Plans the steps to the next boundary. Call it at a boundary. `next_s`: time of the next tick
  /// or corner; infinity if there is none.
  void Aim(double next_s) {
    from_s_ = time_s_;
    const bool over = time_s_ >= duration_s_;
    const double end_s = over ? time_s_ + kSpanAfterEndS : duration_s_;
    const double next = std::min(end_s, next_s);
    until_s_ = next > time_s_ ? next : std::min(end_s, time_s_ + wanted_s_);
    const double span = until_s_ - from_s_;
    steps_ =
        std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(span / wanted_s_ - 1e-6)));
    done_ = 0;
    step_s_ = span / static_cast<double>(steps_);
    // Remove a rounding difference from the requested step.
    if (std::fabs(step_s_ - wanted_s_) < 1e-9 * wanted_s_) step_s_ = wanted_s_;
  }

  void Serialize(LaneState& state) {
    state.Values(time_s_, step_s_, from_s_, until_s_, steps_, done_);
  }

  /// Counts one step.
  void Advance() {
    ++done_;
    time_s_ = done_ == steps_ ? until_s_ : from_s_ + static_cast<double>(done_) * step_s_;
  }

 private:
  /// Length of a span after the end of the experiment, if there is no other boundary.
  static constexpr double kSpanAfterEndS = 1.0;

  double wanted_s_, duration_s_;
  double time_s_ = 0, step_s_ = 0;
  // Span between two boundaries: `steps_` steps, of which `done_` are done.
  double from_s_ = 0, until_s_ = 0;
  std::int64_t steps_ = 0, done_ = 0;
};

}  // namespace taut::plant
