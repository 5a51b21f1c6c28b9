/// How an experiment begins.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "taut/batch.h"
#include "taut/spec.h"
#include "taut/start.h"

namespace taut::plant {

/// The only world of a run.
inline constexpr int kTheWorld = 0;

/// Multiplies parameters of a world.
void ApplyScales(const std::vector<ScaleSpec>& scales, Batch& batch, int world);

/// Brings a new batch of one world to the start that the experiment asks for: its scales, its
/// equilibrium, its noise. False and a diagnostic if there is no such state, if bodies are deep in
/// something there or where settling begins, or if `go_on` says no before it is found. `settled`,
/// if given, gets what settling has come to, without the noise; it stays empty where nothing
/// settles.
bool PrepareStart(const ExperimentSpec& experiment, Batch& batch, Diagnostics& out,
                  const std::function<bool()>& go_on = {},
                  std::optional<SettledStart>* settled = nullptr);

/// Of the only world, with its commanded rest lengths.
Pose PoseOf(const Batch& batch);

/// A world before it settles, for a comparison with what it settles to.
struct Unsettled {
  std::vector<double> elastic_n;           ///< Per cable.
  std::set<std::pair<int, int>> touching;  ///< Bodies, the lower index first.
};
/// Leaves the world as it is.
Unsettled NoteUnsettled(Batch& batch, double step_s);
/// The only world of `batch` has settled: its last step was one of `Settle`.
StartChange ChangeOf(const Unsettled& before, const Batch& batch);

/// What `CheckStart` says of overlaps, of the only world as it is. `terrain`: whether it is there;
/// `warn`: whether to speak of what is less than half through, too.
bool CheckOverlaps(const RobotSpec& robot, const Batch& batch, bool terrain, bool warn,
                   Diagnostics& out);

}  // namespace taut::plant
