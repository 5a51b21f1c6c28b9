/// Initial state of an experiment: scale factors, settling to equilibrium, start noise.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "taut/spec.h"
#include "taut/start.h"
#include "taut/world_batch.h"

namespace taut::plant {

/// Index of the only world of a run.
inline constexpr int kTheWorld = 0;

/// Multiplies parameters of a world by scale factors.
void ApplyScales(const std::vector<ScaleSpec>& scales, WorldBatch& batch, int world);

/// Checks `step_s` and `duration_s` of an experiment that a program may have changed.
bool CheckTimes(const ExperimentSpec& experiment, Diagnostics& out);

/// Sets a new batch of one world to the start of the experiment: scale factors, equilibrium, noise.
/// Returns false and reports an error if there is no such state, or if bodies overlap deeply at the
/// start or before settling. Also returns false if `go_on` returns false. `settled`: receives the
/// result of settling without noise; empty if the experiment does not settle.
bool PrepareStart(const ExperimentSpec& experiment, WorldBatch& batch, Diagnostics& out,
                  const std::function<bool()>& go_on = {},
                  std::optional<SettledStart>* settled = nullptr);

/// Returns the pose of the only world, including its commanded rest lengths.
Pose PoseOf(const WorldBatch& batch);

/// State of a world before it settles, to compare with the settled state.
struct Unsettled {
  std::vector<double> elastic_n;           ///< Elastic tension of each cable.
  std::set<std::pair<int, int>> touching;  ///< Pairs of bodies in contact, the lower index first.
};
/// Records the current state. Does not change the world.
Unsettled NoteUnsettled(WorldBatch& batch, double step_s);
/// Compares the state before settling with the settled state. The last step of `batch` must be a
/// step of `Settle`.
StartChange ChangeOf(const Unsettled& before, const WorldBatch& batch);

/// Reports overlaps in the current state of the only world, like `CheckStart`. `terrain`: whether
/// to check overlaps with terrain. `warn`: whether to warn of overlaps of less than half the
/// thickness.
bool CheckOverlaps(const RobotSpec& robot, const WorldBatch& batch, bool terrain, bool warn,
                   Diagnostics& out);

}  // namespace taut::plant
