/// What is observed of the lanes of a group: channels by their names, gathered over lanes.
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

/// An experiment whose traces have the observed channels, and no others.
ExperimentSpec Observed(const ExperimentSpec& experiment);

class Observer {
 public:
  /// `channels`: of a recorder of `observed`. Both outlive it, and so do the loop and `bodies`,
  /// which have been read before `Take`.
  Observer(const Plan& plan, const ExperimentSpec& observed,
           const std::vector<ChannelInfo>& channels, plant::Loop& loop, const LaneBodies& bodies);

  void Next();  ///< A period is over: all lanes are to be seen anew.
  /// Whether `Take` looks at cables as they are, which are then best read while the step's memory
  /// is still near.
  bool senses() const noexcept { return senses_; }
  /// Sees some of the first `count` lanes. What is not finite, as a place of a contact that is not
  /// there, is seen as 0.
  void Take(Lanes lanes, int count);
  /// An episode begins with what `Take` has seen of it; observations come `delay` periods later.
  void Begin(int lane, int delay);

  /// What was seen in the last periods, as a controller's `Carry`. Into a lane that has begun.
  void Carry(plant::LaneState& state);

  template <class T>
  void Emit(int lane, T* row) const;

 private:
  double& At(std::size_t slot, std::size_t i, std::size_t lane) noexcept {
    return ring_[(slot * count_ + i) * lanes_ + lane];
  }

  const Plan& plan_;
  plant::Loop& loop_;
  std::size_t count_, lanes_, slots_, now_ = 0;
  const plant::LaneKernel& kernel_;
  /// Per column, where its row stands: of the plant, of the bodies, or of `others_`.
  std::vector<const double*> rows_;
  std::vector<std::size_t> other_columns_;     ///< Of what `recorder_` has.
  std::vector<double> others_;                 ///< Its rows.
  std::unique_ptr<plant::Recorder> recorder_;  ///< Null: nothing else is observed.
  bool senses_ =
      false;  ///< Something is observed of which nobody else makes sure that it is of now.
  std::vector<double> ring_, fresh_;
  std::vector<std::uint8_t> in_float_;  ///< A slot: all its numbers are within those of a float.
  std::vector<std::size_t> delay_;      ///< Per lane.
};

}  // namespace taut::env
