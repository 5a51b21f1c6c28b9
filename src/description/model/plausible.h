/// Numbers that are allowed one by one and make no sense together (docs/formats/checks.md).
#pragma once

#include "taut/spec.h"

namespace taut::description {

/// Complains about what is so far from the origin that positions there are too coarse for the
/// robot. `place`: of an experiment's, which then is to blame.
void CheckPositions(const RobotSpec& robot, Diagnostics& out, const SourceRef* place = nullptr);

/// Whether positions so far from the origin are too coarse for the robot.
bool IsTooFar(const RobotSpec& robot, double far_m);

/// Warns of a robot that nobody can have meant: units mixed up, a zero too many.
void WarnOfOddNumbers(const RobotSpec& robot, Diagnostics& out);

}  // namespace taut::description
