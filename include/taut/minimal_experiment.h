/// Default load case and experiment for a model file without an experiment.
///
/// Threads: all functions are pure; any number may run concurrently.
#pragma once

#include <utility>

#include "taut/model_def.h"
#include "taut/spec.h"

namespace taut {

/// Returns whether the world can support the robot: the model has a ground plane, or a joint or a
/// cable that ends at the world or at a fixed body.
bool IsHeld(const ModelDef& def);

/// Returns the default load case of a structure: its own weight ("own_weight") if `IsHeld`, else no
/// load ("unloaded").
LoadCaseSpec OwnWeight(const ModelDef& def);

/// Returns an experiment with this robot, its name and its files, and nothing else.
ExperimentSpec MinimalExperiment(RobotSpec robot, StartKind start = StartKind::kSettled);

[[deprecated("MinimalExperiment")]] inline ExperimentSpec ExperimentWith(RobotSpec robot) {
  return MinimalExperiment(std::move(robot));
}

}  // namespace taut
