#include "pace.h"

#include <algorithm>
#include <limits>

namespace taut::viewer {
namespace {

/// Largest lag behind the wall clock that a run catches up [s].
constexpr double kMaxBehindS = 0.1;
constexpr std::chrono::milliseconds kMeasuredFor{500};
/// Effectively infinite, yet within the range of the clock's type.
constexpr double kLongestWaitS = 1e6;

double Seconds(Pace::Clock::duration span) { return std::chrono::duration<double>(span).count(); }

}  // namespace

void Pace::Set(double speed, bool paused, double time_s) {
  speed_ = speed;
  paused_ = paused;
  anchor_wall_ = measured_wall_ = Clock::now();
  anchor_s_ = measured_s_ = time_s;
  factor_ = 0;
}

double Pace::WantedAt(Clock::time_point now) const {
  if (speed_ == 0) return std::numeric_limits<double>::infinity();
  return anchor_s_ + speed_ * Seconds(now - anchor_wall_);
}

Pace::Clock::time_point Pace::DueAt(double time_s) const {
  if (speed_ == 0) return anchor_wall_;
  const double wait_s = std::clamp((time_s - anchor_s_) / speed_, 0.0, kLongestWaitS);
  return anchor_wall_ +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wait_s));
}

void Pace::At(double time_s, Clock::time_point now) {
  if (speed_ != 0 && !paused_ && WantedAt(now) - time_s > kMaxBehindS * std::max(speed_, 1.0)) {
    anchor_wall_ = now;
    anchor_s_ = time_s;
  }
  if (now - measured_wall_ > kMeasuredFor) {
    factor_ = (time_s - measured_s_) / Seconds(now - measured_wall_);
    measured_wall_ = now;
    measured_s_ = time_s;
  }
}

}  // namespace taut::viewer
