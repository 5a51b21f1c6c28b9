/// Pose of a robot from a trace.
///
/// Threads: any number may call this function concurrently.
#pragma once

#include <cstddef>
#include <optional>

#include "taut/diagnostics.h"
#include "taut/spec.h"
#include "taut/start.h"
#include "taut/trace.h"

namespace taut {

/// Returns the pose of a robot in a row of a trace, in W: positions of centers of mass [m] and
/// rotations of bodies relative to their pose in `robot` (`body/NAME/position_x_m`, ...,
/// `orientation_w`, ...). Rest lengths [m] are as recorded, otherwise as described. If values are
/// missing or not numbers, returns nothing and adds errors at `at`. Adds a warning if recorded
/// cable lengths differ from the lengths in this pose.
std::optional<Pose> PoseOfTrace(const RobotSpec& robot, const Trace& trace, std::size_t row,
                                const SourceRef& at, Diagnostics& out);

}  // namespace taut
