/// Plausibility checks: numbers that are valid separately but not together
/// (docs/formats/checks.md).
#pragma once

#include "taut/spec.h"

namespace taut::description {

/// Reports objects so far from the origin that the rounding of positions is too coarse for the
/// robot. `place`: place of an experiment's start pose, reported instead of the model's nodes.
void CheckPositions(const RobotSpec& robot, Diagnostics& out, const SourceRef* place = nullptr);

/// Returns whether the rounding of positions at this distance is too coarse for the robot.
bool IsTooFar(const RobotSpec& robot, double far_m);

/// Warns of implausible numbers, such as mixed units or an additional zero.
void WarnImplausible(const RobotSpec& robot, Diagnostics& out);

}  // namespace taut::description
