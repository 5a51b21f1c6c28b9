/// Observations of all lanes of a group, selected by channel names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "env/lane_bodies.h"
#include "env/plan.h"
#include "plant/loop.h"
#include "plant/recorder.h"

namespace taut::env {

/// Returns an experiment whose trace contains exactly the observed channels.
ExperimentSpec Observed(const ExperimentSpec& experiment);

class Observer {
 public:
  /// `channels`: channels of a recorder for `observed`. `loop` and `bodies` must outlive this
  /// object. Call `bodies.Read` before `Take`.
  Observer(const Plan& plan, const ExperimentSpec& observed,
           const std::vector<ChannelInfo>& channels, plant::Loop& loop, const LaneBodies& bodies);

  void Next();  ///< Advances to the next period. Then call `Take` for all lanes.
  /// Returns whether `Take` needs current cable readings. These are fastest to compute while the
  /// step's memory is in the cache.
  bool senses() const noexcept { return senses_; }
  /// Stores the observations of the selected lanes among the first `count`. Values that are not
  /// finite, such as the position of a missing contact, become 0.
  void Take(Lanes lanes, int count);
  /// Begins an episode with the values of the last `Take`. Observations are delayed by `delay`
  /// periods.
  void Begin(int lane, int delay);

  /// Serializes the observations of the last periods, like a controller's `Serialize`. To restore,
  /// call `Begin` first.
  void Serialize(plant::LaneState& state);

  template <class T>
  void Emit(int lane, T* row) const;

 private:
  double& At(std::size_t slot, std::size_t i, std::size_t lane) noexcept {
    return ring_[(slot * count_ + i) * lanes_ + lane];
  }

  plant::Loop& loop_;
  std::size_t count_, lanes_, slots_, now_ = 0;
  const plant::LaneKernel& kernel_;
  /// Per observation: row in the plant, the bodies or `others_`.
  std::vector<const double*> rows_;
  std::vector<std::size_t> other_columns_;     ///< Observations computed by `recorder_`.
  std::vector<double> others_;                 ///< Rows of these observations.
  std::unique_ptr<plant::Recorder> recorder_;  ///< Null if all observations have rows in the plant
                                               ///< or the bodies.
  bool senses_ = false;  ///< Whether an observation needs updated cable readings.
  std::vector<double> ring_, fresh_;
  std::vector<std::uint8_t> in_float_;  ///< Per slot of `ring_`: whether all numbers fit into a
                                        ///< float.
  std::vector<std::size_t> delay_;      ///< Delay per lane, in periods.
};

}  // namespace taut::env
