/// Observations of the lanes of a group: channels selected by name, gathered over lanes.
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

/// Returns an experiment whose traces contain exactly the observed channels.
ExperimentSpec Observed(const ExperimentSpec& experiment);

class Observer {
 public:
  /// `channels`: from a recorder of `observed`. Both must outlive this object, as must the loop and
  /// `bodies`. Call `bodies.Read` before `Take`.
  Observer(const Plan& plan, const ExperimentSpec& observed,
           const std::vector<ChannelInfo>& channels, plant::Loop& loop, const LaneBodies& bodies);

  void Next();  ///< Advances to the next period; call `Take` for all lanes after it.
  /// Returns whether `Take` reads present cable values, which are best computed while the step's
  /// memory is still in the cache.
  bool senses() const noexcept { return senses_; }
  /// Observes some of the first `count` lanes. Values that are not finite, such as the position of
  /// a missing contact, become 0.
  void Take(Lanes lanes, int count);
  /// Begins an episode with the values of the last `Take`; observations are delayed by `delay`
  /// periods.
  void Begin(int lane, int delay);

  /// Serializes the observations of the last periods, like a controller's `Serialize`. Reading
  /// requires `Begin`.
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
  /// Per column: its row in the plant, the bodies or `others_`.
  std::vector<const double*> rows_;
  std::vector<std::size_t> other_columns_;     ///< Columns from `recorder_`.
  std::vector<double> others_;                 ///< Their rows.
  std::unique_ptr<plant::Recorder> recorder_;  ///< Null if there are no other channels.
  bool senses_ = false;  ///< Whether an observed quantity needs an explicit update to the present.
  std::vector<double> ring_, fresh_;
  std::vector<std::uint8_t> in_float_;  ///< Per slot: all numbers fit into a float.
  std::vector<std::size_t> delay_;      ///< Per lane.
};

}  // namespace taut::env
