/// Conversion of actions to commands for all lanes of a group.
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

  /// Begins an episode of a lane. `commands`: initial commands. Actions take effect `delay` periods
  /// later; until then, they are 0.
  void Begin(int lane, const Commands& commands, int delay);

  /// Stores the next action of a lane; null: zeros. Replaces values that are not finite by 0.
  /// Returns false if it replaced any value.
  template <class T>
  bool Read(int lane, const T* action);
  /// Applies the actions of all lanes to commands and controllers. Call after `Read` for all lanes.
  void Apply(plant::Loop& loop);

  /// Serializes a lane's actions, like a controller's `Serialize`. To restore, call `Begin` first;
  /// this also restores the tuned numbers of the loop's controllers.
  void Serialize(plant::LaneState& state, plant::Loop& loop);

 private:
  double& At(std::size_t slot, std::size_t i, std::size_t lane) noexcept {
    return ring_[(slot * count_ + i) * lanes_ + lane];
  }

  /// Returns the actions in effect, one row per action.
  const double* Acting() const noexcept { return slots_ > 1 ? now_.data() : ring_.data(); }

  const Plan& plan_;
  std::size_t count_, lanes_, slots_;
  std::size_t next_ = 0;            ///< Slot in `ring_` for the next actions.
  std::vector<double> ring_;        ///< Clamped actions of the last periods, one row per action.
  std::vector<std::size_t> delay_;  ///< Delay per lane, in periods.
  std::vector<double> command_m_;   ///< One row per action: rest length for action 0, or rest
                                    ///< length accumulated by a rate.
  std::vector<double> now_;         ///< Actions in effect if actions may be delayed.
  Tuning tuning_;
};

}  // namespace taut::env
