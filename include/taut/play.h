/// A gait played without a robot moving: what it commands, tick by tick.
#pragma once

#include <optional>

#include "taut/gait.h"
#include "taut/spec.h"

namespace taut {

/// The velocities that a gait commands a robot's cables, at 0, 1 / rate, ... up to `duration_s`.
/// Feedback is left out: nothing is felt. Nothing if the gait does not fit the robot.
std::optional<TableGait> PlayGait(const GaitSpec& gait, const RobotSpec& robot, double rate_hz,
                                  double duration_s, Diagnostics& out);

}  // namespace taut
