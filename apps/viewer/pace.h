/// Synchronization of simulated time with the wall clock.
#pragma once

#include <chrono>

namespace taut::viewer {

/// Schedule of simulated times on the wall clock. Not thread-safe.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  /// `speed`: simulated seconds per second; 0: as fast as possible.
  Pace(double speed, bool paused) : speed_(speed), paused_(paused) {}

  double speed() const { return speed_; }
  bool paused() const { return paused_; }
  /// Returns the recent ratio of simulated to wall-clock time; 0 while paused.
  double real_time_factor() const { return paused_ ? 0 : factor_; }

  /// Each of these functions continues from `time_s` at the present wall-clock time.
  void Pause(double time_s) { Set(speed_, true, time_s); }
  void Resume(double time_s) { Set(speed_, false, time_s); }
  void SetSpeed(double speed, double time_s) { Set(speed, paused_, time_s); }
  void Anchor(double time_s) { Set(speed_, paused_, time_s); }

  /// Returns the simulated time due at `now`; infinity at full speed.
  double WantedAt(Clock::time_point now) const;
  /// Returns the wall-clock time at which a simulated time is due.
  Clock::time_point DueAt(double time_s) const;

  /// Reports that the run has reached `time_s`. A run that lags far behind continues from there,
  /// without catching up later.
  void At(double time_s, Clock::time_point now);

 private:
  void Set(double speed, bool paused, double time_s);

  double speed_;
  bool paused_;
  // Pair of times to which the pace is anchored.
  Clock::time_point anchor_wall_ = Clock::now();
  double anchor_s_ = 0;
  // Start of the interval for measuring the real-time factor.
  Clock::time_point measured_wall_ = anchor_wall_;
  double measured_s_ = 0, factor_ = 0;
};

}  // namespace taut::viewer
