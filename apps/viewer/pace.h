/// How simulated time goes on beside the wall clock's.
#pragma once

#include <chrono>

namespace taut::viewer {

/// Not safe from two threads at once.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  /// `speed`: simulated seconds a second; 0: as fast as it can.
  Pace(double speed, bool paused) : speed_(speed), paused_(paused) {}

  double speed() const { return speed_; }
  bool paused() const { return paused_; }
  /// Simulated over wall-clock time, of late; 0 while paused.
  double real_time_factor() const { return paused_ ? 0 : factor_; }

  /// Each goes on from `time_s`, now.
  void Pause(double time_s) { Set(speed_, true, time_s); }
  void Resume(double time_s) { Set(speed_, false, time_s); }
  void SetSpeed(double speed, double time_s) { Set(speed, paused_, time_s); }
  void Anchor(double time_s) { Set(speed_, paused_, time_s); }

  /// How far the run should have come; infinity at full speed.
  double WantedAt(Clock::time_point now) const;
  /// When it should have come to a time.
  Clock::time_point DueAt(double time_s) const;

  /// The run has come to `time_s`. One that is far behind is slower than asked for: it goes on from
  /// where it is, and does not race once it can.
  void At(double time_s, Clock::time_point now);

 private:
  void Set(double speed, bool paused, double time_s);

  double speed_;
  bool paused_;
  // Simulated time keeps up with wall-clock time since this pair.
  Clock::time_point anchor_wall_ = Clock::now();
  double anchor_s_ = 0;
  // What the factor is measured from.
  Clock::time_point measured_wall_ = anchor_wall_;
  double measured_s_ = 0, factor_ = 0;
};

}  // namespace taut::viewer
