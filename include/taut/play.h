/// Gait playback without a robot: commands of a gait at each tick.
#pragma once

#include <optional>

#include "taut/gait.h"
#include "taut/spec.h"

namespace taut {

/// Returns the velocities [m/s] that a gait commands to the cables of a robot at times 0, 1 / rate,
/// ... up to `duration_s`. Without measurements, feedback is omitted. If the gait does not match
/// the robot, returns nothing and adds diagnostics.
std::optional<TableGait> PlayGait(const GaitSpec& gait, const RobotSpec& robot, double rate_hz,
                                  double duration_s, Diagnostics& out);

}  // namespace taut
