/// A pose of a robot from a recording.
///
/// Threads: any number may call this at once.
#pragma once

#include <cstddef>
#include <optional>

#include "taut/diagnostics.h"
#include "taut/spec.h"
#include "taut/start.h"
#include "taut/trace.h"

namespace taut {

/// The pose that a row of a recording shows, in W: places of centres of mass [m] and turns of
/// bodies from where `robot` has them (`body/NAME/position_x_m`, ..., `orientation_w`, ...), rest
/// lengths [m] where the recording has them, else as described. Nothing, and complaints at `at`
/// about all that is missing or no number; a warning where recorded lengths of cables are others
/// than those in this pose.
std::optional<Pose> PoseOfTrace(const RobotSpec& robot, const Trace& trace, std::size_t row,
                                const SourceRef& at, Diagnostics& out);

}  // namespace taut
