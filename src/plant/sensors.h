/// What controllers get to see: the robot through load cells and encoders (docs/theory/sensors.md),
/// for all lanes side by side.
#pragma once

#include <cstdint>
#include <vector>

#include "taut/plant.h"

namespace taut::plant {

class Sensors final : public SensorModel {
 public:
  /// One seed a lane: noise is a function of seed, sample and cable alone.
  Sensors(const SensorSpec& spec, std::size_t cable_count, std::vector<std::uint64_t> seeds);

  ClockSpec clock() const override { return {spec_.period_s, 0.0}; }
  void Sample(const Tick& tick, const Observation& exact) override;
  /// The last sample, as late as the sensors are.
  const Observation& seen() const override { return shown_; }
  void Restart(int lane, const RolloutWorld& world) override;

 private:
  /// What was sampled d ticks ago; before that, the first sample. Of each lane at its own tick.
  class Delay {
   public:
    Delay(double delay_s, double period_s, std::size_t cables, std::size_t lanes);
    double& Newest(std::size_t i, std::int64_t tick) noexcept { return Slot(i, tick); }
    double Oldest(std::size_t i, std::int64_t tick) noexcept {
      return Slot(i, tick < delay_ ? 0 : tick - delay_);
    }

   private:
    double& Slot(std::size_t i, std::int64_t tick) noexcept {
      return ring_[size_ * static_cast<std::size_t>(tick % (delay_ + 1)) + i];
    }
    std::int64_t delay_;
    std::size_t size_;
    std::vector<double> ring_;
  };

  void DrawBias(std::size_t lane);
  /// Of cable i / lanes in lane i % lanes, at the lane's tick.
  double Tension(std::size_t i, std::int64_t tick, double exact);
  double RestLength(std::size_t i, std::int64_t tick, double exact);
  void EstimateLength(std::size_t i, std::int64_t tick, double stiffness);

  SensorSpec spec_;
  std::size_t cable_count_;
  std::vector<std::uint64_t> seeds_;
  Delay tension_delay_, rest_delay_;
  std::vector<double> bias_n_;
  CableReadings<std::vector<double>> seen_;
  Observation shown_;
};

}  // namespace taut::plant
