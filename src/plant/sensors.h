/// What controllers get to see: the robot through load cells and encoders (docs/theory/sensors.md),
/// for the worlds of a group side by side.
#pragma once

#include <cstdint>
#include <vector>

#include "taut/cable_readings.h"
#include "taut/control/clock.h"
#include "taut/spec.h"

namespace taut::plant {

class Sensors {
 public:
  /// One seed a lane: noise is a function of seed, sample and cable alone.
  Sensors(const SensorSpec& spec, std::size_t cable_count, std::vector<std::uint64_t> seeds);

  double next_tick_s() const noexcept { return control::TickTime(clock_, tick_); }

  /// Takes a sample if one is due.
  void Sample(double time_s, const ReadingRows& exact);

  /// The last sample, as late as the sensors are. Valid until the next call of `Sample`.
  ReadingRows rows() const noexcept;

 private:
  /// What was sampled d ticks ago; before that, the first sample.
  class Delay {
   public:
    Delay(double delay_s, double period_s, std::size_t size);
    double* Newest(std::int64_t tick) noexcept { return Slot(tick); }
    const double* Oldest(std::int64_t tick) noexcept {
      return Slot(tick < delay_ ? 0 : tick - delay_);
    }

   private:
    double* Slot(std::int64_t tick) noexcept;
    std::int64_t delay_;
    std::size_t size_;
    std::vector<double> ring_;
  };

  void SampleTension(const double* exact);
  void SampleRestLength(const double* exact);
  void EstimateLength(const double* stiffness);

  SensorSpec spec_;
  control::Clock<double> clock_;
  std::int64_t tick_ = 0;
  std::size_t cable_count_;
  std::vector<std::uint64_t> seeds_;
  Delay tension_delay_, rest_delay_;
  std::vector<double> bias_n_;
  CableReadings<std::vector<double>> seen_;
};

}  // namespace taut::plant
