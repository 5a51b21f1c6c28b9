/// Pose to analyze (`taut analyze --pose`).
#pragma once

#include <optional>
#include <string>

#include "taut/spec.h"
#include "taut/start.h"

namespace taut::cli {

struct PoseArguments {
  std::string file;            ///< A recording; empty: pose as described.
  std::optional<double> at_s;  ///< Time of the row; nothing: the last row.
};

/// Returns the pose in the recording's row that is nearest to the requested time. Returns nothing,
/// with errors in `out`, if the recording has no pose.
std::optional<Pose> ReadPose(const PoseArguments& args, const RobotSpec& robot, Diagnostics& out);

}  // namespace taut::cli
