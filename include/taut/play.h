/// Gait playback without a robot: commands of a gait at each tick.
#pragma once

#include <optional>

#include "taut/gait.h"
#include "taut/spec.h"

namespace taut {

/// Returns the velocities [m/s] that a gait commands to a robot's cables at times 0, 1 / rate, ...
/// up to `duration_s`. Feedback is omitted, since nothing is measured. Returns nothing, with
/// diagnostics, if the gait does not fit the robot.
std::optional<TableGait> PlayGait(const GaitSpec& gait, const RobotSpec& robot, double rate_hz,
                                  double duration_s, Diagnostics& out);

}  // namespace taut
