/// How an experiment begins.
#pragma once

#include <vector>

#include "taut/batch.h"
#include "taut/spec.h"

namespace taut::plant {

/// The only world of a run.
inline constexpr int kTheWorld = 0;

/// Multiplies parameters of a world.
void ApplyScales(const std::vector<ScaleSpec>& scales, Batch& batch, int world);

/// Brings a new batch of one world to the start that the experiment asks for: its scales, its
/// equilibrium, its noise. False and a diagnostic if there is no such state.
bool PrepareStart(const ExperimentSpec& experiment, Batch& batch, Diagnostics& out);

}  // namespace taut::plant
