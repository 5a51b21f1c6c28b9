/// A robot of which nothing more is said than how it is built: what holds it, what loads it.
///
/// Threads: all functions are pure; any number may run at once.
#pragma once

#include "taut/model_def.h"
#include "taut/spec.h"

namespace taut {

/// Whether something keeps the robot in the world: ground, or a joint or a cable to what stands
/// still.
bool IsHeld(const ModelDef& def);

/// The load of a structure of which nobody says any: its own weight, or, where nothing holds it,
/// none.
LoadCaseSpec OwnWeight(const ModelDef& def);

/// An experiment that has the robot and nothing else, and begins settled.
ExperimentSpec ExperimentWith(RobotSpec robot);

}  // namespace taut
