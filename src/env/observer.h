/// What is observed of the lanes of a group: channels by their names, gathered over lanes.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "env/plan.h"
#include "plant/loop.h"
#include "plant/recorder.h"

namespace taut::env {

/// An experiment whose traces have the observed channels, and no others.
ExperimentSpec Observed(const ExperimentSpec& experiment);

class Observer {
 public:
  /// `channels`: of a recorder of `observed`. Both outlive it, and so does the loop.
  Observer(const Plan& plan, const ExperimentSpec& observed,
           const std::vector<ChannelInfo>& channels, plant::Loop& loop);

  void Next();  ///< A period is over: all lanes are to be seen anew.
  /// Sees some of the first `count` lanes. What is not finite, as a place of a contact that is not
  /// there, is seen as 0. `bodies`: [lane][body].
  void Take(Lanes lanes, int count, std::span<const BodyState> bodies);
  /// An episode begins with what `Take` has seen of it; observations come `delay` periods later.
  void Begin(int lane, int delay);

  template <class T>
  void Emit(int lane, T* row) const;

 private:
  double& At(std::size_t slot, std::size_t i, std::size_t lane) noexcept {
    return ring_[(slot * count_ + i) * lanes_ + lane];
  }

  struct Row {  ///< A number that stands in a row of the plant.
    std::size_t column;
    const double* lanes;
  };
  struct OfBody {
    std::size_t column, body, component;
  };

  const Plan& plan_;
  plant::Loop& loop_;
  std::size_t count_, lanes_, slots_, now_ = 0;
  std::vector<Row> rows_;
  std::vector<OfBody> of_bodies_;
  std::vector<std::size_t> others_;            ///< Columns of what `recorder_` has.
  std::unique_ptr<plant::Recorder> recorder_;  ///< Null: nothing else is observed.
  std::vector<double> ring_;
  std::vector<std::size_t> delay_;  ///< Per lane.
};

}  // namespace taut::env
