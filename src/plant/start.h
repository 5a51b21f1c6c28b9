/// How an experiment begins.
#pragma once

#include <functional>
#include <vector>

#include "taut/batch.h"
#include "taut/spec.h"

namespace taut::plant {

/// The only world of a run.
inline constexpr int kTheWorld = 0;

/// Multiplies parameters of a world.
void ApplyScales(const std::vector<ScaleSpec>& scales, Batch& batch, int world);

/// Brings a new batch of one world to the start that the experiment asks for: its scales, its
/// equilibrium, its noise. False and a diagnostic if there is no such state, if bodies are deep in
/// something there or where settling begins, or if `go_on` says no before it is found.
bool PrepareStart(const ExperimentSpec& experiment, Batch& batch, Diagnostics& out,
                  const std::function<bool()>& go_on = {});

/// What `CheckStart` says of overlaps, of the only world as it is. `terrain`: whether it is there;
/// `warn`: whether to speak of what is less than half through, too.
bool CheckOverlaps(const RobotSpec& robot, const Batch& batch, bool terrain, bool warn,
                   Diagnostics& out);

}  // namespace taut::plant
