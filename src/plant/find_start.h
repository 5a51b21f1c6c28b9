/// Start of an experiment: scales, settling to equilibrium, start noise.
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

/// The only world of a run.
inline constexpr int kTheWorld = 0;

/// Multiplies parameters of a world.
void ApplyScales(const std::vector<ScaleSpec>& scales, WorldBatch& batch, int world);

/// Sets a new batch of one world to the start of the experiment: scales, equilibrium, noise.
/// Returns false and reports a diagnostic if there is no such state, if bodies overlap deeply there
/// or where settling begins, or if `go_on` returns false before it is found. `settled`, if given,
/// receives the result of settling without the noise; it stays empty if the experiment does not
/// settle.
bool PrepareStart(const ExperimentSpec& experiment, WorldBatch& batch, Diagnostics& out,
                  const std::function<bool()>& go_on = {},
                  std::optional<SettledStart>* settled = nullptr);

/// Returns the pose of the only world, with its commanded rest lengths.
Pose PoseOf(const WorldBatch& batch);

/// State of a world before it settles, for the comparison with the settled state.
struct Unsettled {
  std::vector<double> elastic_n;           ///< Per cable.
  std::set<std::pair<int, int>> touching;  ///< Bodies, the lower index first.
};
/// Does not change the world.
Unsettled NoteUnsettled(WorldBatch& batch, double step_s);
/// Requires that the only world of `batch` has settled: its last step was a step of `Settle`.
StartChange ChangeOf(const Unsettled& before, const WorldBatch& batch);

/// Reports overlaps in the current state of the only world, as `CheckStart`. `terrain`: whether
/// terrain is included; `warn`: whether overlaps of less than half the thickness give warnings.
bool CheckOverlaps(const RobotSpec& robot, const WorldBatch& batch, bool terrain, bool warn,
                   Diagnostics& out);

}  // namespace taut::plant
