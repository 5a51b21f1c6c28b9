/// Sensor models between plant and controllers: load cells and encoders of all lanes
/// (docs/theory/sensors.md).
#pragma once

#include <cstdint>
#include <vector>

#include "taut/lane_state.h"
#include "taut/plant.h"

namespace taut::plant {

class Sensors final : public SensorModel {
 public:
  /// `seeds`: one per lane. Noise depends only on seed, sample and cable.
  Sensors(const SensorSpec& spec, std::size_t cable_count, std::vector<std::uint64_t> seeds);

  ClockSpec clock() const override { return {spec_.period_s, 0.0}; }
  void Sample(const Tick& tick, const Observation& exact) override;
  /// Returns the last sample, with the sensors' delay.
  const Observation& seen() const override { return shown_; }
  void Restart(int lane, const RolloutWorld& world) override;
  void Serialize(LaneState& state) override;

 private:
  /// Delay line. Returns the sample of `delay` ticks ago, or the first sample. Ticks are counted
  /// per lane.
  class Delay {
   public:
    Delay(double delay_s, double period_s, std::size_t cables, std::size_t lanes);
    double& Newest(std::size_t i, std::int64_t tick) noexcept { return Slot(i, tick); }
    double Oldest(std::size_t i, std::int64_t tick) noexcept {
      return Slot(i, tick < delay_ ? 0 : tick - delay_);
    }
    void Serialize(LaneState& state) { state.Row(ring_); }

   private:
    double& Slot(std::size_t i, std::int64_t tick) noexcept {
      return ring_[size_ * static_cast<std::size_t>(tick % (delay_ + 1)) + i];
    }
    std::int64_t delay_;
    std::size_t size_;
    std::vector<double> ring_;
  };

  /// Errors of a cable's load cell and encoder, constant during a run.
  struct Errors {
    double bias_n = 0, gain = 1, drift_n_per_s = 0;
    double zero_m = 0, encoder_gain = 1;
    double start_m = 0;  ///< Rest length at the first sample.
    /// Whether an index mark was passed, so that `zero_m` is a multiple of `index_m`.
    bool index_passed = false;
  };

  void DrawErrors(std::size_t lane);
  // Argument `i`: cable i / lanes of lane i % lanes. `tick`: tick of the lane.
  double Tension(std::size_t i, std::int64_t tick, double exact);
  double Counted(const LoadCellCounts& counts, std::size_t i, std::int64_t tick, double x) const;
  double Normal(std::size_t i, std::int64_t tick, std::uint32_t stream) const;
  double RestLength(std::size_t i, std::int64_t tick, double exact);
  void EstimateLength(std::size_t i, std::int64_t tick, double stiffness);

  SensorSpec spec_;
  std::size_t cable_count_;
  std::vector<std::uint64_t> seeds_;
  Delay tension_delay_, rest_delay_;
  std::vector<Errors> errors_;
  CableReadings<std::vector<double>> seen_;
  Observation shown_;
};

}  // namespace taut::plant
