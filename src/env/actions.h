/// Conversion of actions to commands, for the lanes of a group.
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

  /// Begins an episode of a lane from the commands of the start. Actions take effect `delay`
  /// periods later; until then they are 0.
  void Begin(int lane, const Commands& commands, int delay);

  /// Stores the next action of a lane; null: zeros. Returns false if a number is not finite; it is
  /// replaced by 0.
  template <class T>
  bool Read(int lane, const T* action);
  /// Applies the actions of all lanes to commands and controllers, once all have been read.
  void Apply(plant::Loop& loop);

  /// Serializes a lane's actions, like a controller's `Serialize`. On reading, which requires
  /// `Begin`, it also restores the numbers of the loop's controllers.
  void Serialize(plant::LaneState& state, plant::Loop& loop);

 private:
  double& At(std::size_t slot, std::size_t i, std::size_t lane) noexcept {
    return ring_[(slot * count_ + i) * lanes_ + lane];
  }

  /// Returns the actions in effect, one row per action.
  const double* Acting() const noexcept { return slots_ > 1 ? now_.data() : ring_.data(); }

  const Plan& plan_;
  std::size_t count_, lanes_, slots_;
  std::size_t next_ = 0;            ///< Slot of the next actions.
  std::vector<double> ring_;        ///< Clamped actions of the last periods, one row per action.
  std::vector<std::size_t> delay_;  ///< Per lane.
  std::vector<double> command_m_;   ///< One row per action: rest length without the action, or
                                    ///< accumulated by a rate.
  std::vector<double> now_;         ///< Actions in effect, if actions may be delayed.
  Tuning tuning_;
};

}  // namespace taut::env
