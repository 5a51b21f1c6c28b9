/// Default load case and default experiment for a model file without an experiment.
///
/// Threads: all functions are pure and thread safe.
#pragma once

#include <utility>

#include "taut/model_def.h"
#include "taut/spec.h"

namespace taut {

/// Returns whether the world can support the robot: the model has a ground plane, or a joint or
/// cable ends at the world or at a fixed body.
bool IsHeld(const ModelDef& def);

/// Returns the default load case of a structure: its weight ("own_weight") if `IsHeld`, otherwise
/// no load ("unloaded").
LoadCaseSpec OwnWeight(const ModelDef& def);

/// Returns an experiment that contains only this robot, its name and its files.
ExperimentSpec MinimalExperiment(RobotSpec robot, StartKind start = StartKind::kSettled);

[[deprecated("MinimalExperiment")]] inline ExperimentSpec ExperimentWith(RobotSpec robot) {
  return MinimalExperiment(std::move(robot));
}

}  // namespace taut
