/// From actions to commands, for the lanes of a group.
#pragma once

#include <cstddef>
#include <vector>

#include "env/plan.h"
#include "env/tuning.h"
#include "plant/loop.h"

namespace taut::env {

class Actions {
 public:
  explicit Actions(const Plan& plan);

  /// A lane begins an episode; its commands are those of the start. Actions count `delay` periods
  /// later, before that as 0.
  void Begin(int lane, const Commands& commands, int delay);

  /// The next action of a lane; null: zeros. False if a number of it is not finite: that is 0.
  template <class T>
  bool Read(int lane, const T* action);
  /// Once all lanes have theirs: what they command, and how controllers go on.
  void Apply(plant::Loop& loop);

  /// A lane's actions, as a controller's `Carry`; the loop's controllers get the numbers that they
  /// had. Into a lane that has begun its episode.
  void Carry(plant::LaneState& state, plant::Loop& loop);

 private:
  double& At(std::size_t slot, std::size_t i, std::size_t lane) noexcept {
    return ring_[(slot * count_ + i) * lanes_ + lane];
  }

  /// A row an action: what acts now.
  const double* Acting() const noexcept { return slots_ > 1 ? now_.data() : ring_.data(); }

  const Plan& plan_;
  std::size_t count_, lanes_, slots_;
  std::size_t next_ = 0;            ///< The slot of the actions that are read.
  std::vector<double> ring_;        ///< Clamped actions of the last periods: a row each.
  std::vector<std::size_t> delay_;  ///< Per lane.
  std::vector<double> command_m_;   ///< A row an action: rest length without it, or at a rate.
  std::vector<double> now_;         ///< What acts now, where actions may be late.
  Tuning tuning_;
};

}  // namespace taut::env
