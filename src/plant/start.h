/// How an experiment begins.
#pragma once

#include "taut/batch.h"
#include "taut/spec.h"

namespace taut::plant {

/// The only world of a run.
inline constexpr int kTheWorld = 0;

/// Brings a new batch to the start that the experiment asks for. False and a diagnostic if there is
/// no such state.
bool PrepareStart(const ExperimentSpec& experiment, Batch& batch, Diagnostics& out);

}  // namespace taut::plant
