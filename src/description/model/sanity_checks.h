/// Plausibility checks: combinations of numbers that are valid individually
/// (docs/formats/checks.md).
#pragma once

#include "taut/spec.h"

namespace taut::description {

/// Reports objects so far from the origin that the rounding of positions is too coarse for the
/// robot. `place`: line and column of the start pose in an experiment file; errors about nodes then
/// refer to this line, not to the model file.
void CheckPositions(const RobotSpec& robot, Diagnostics& out, const SourceRef* place = nullptr);

/// Returns whether positions at this distance from the origin are rounded too coarsely for the
/// robot.
bool IsTooFar(const RobotSpec& robot, double far_m);

/// Warns of implausible numbers, such as mixed units or an additional zero digit.
void WarnImplausible(const RobotSpec& robot, Diagnostics& out);

}  // namespace taut::description
