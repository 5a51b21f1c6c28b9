/// `taut analyze --pose`: where the robot is looked at.
#pragma once

#include <optional>
#include <string>

#include "taut/spec.h"
#include "taut/start.h"

namespace taut::cli {

struct PoseArguments {
  std::string file;            ///< A recording; empty: as described.
  std::optional<double> at_s;  ///< Which of its rows; nothing: the last.
};

/// The pose in a recording's row that is nearest to the time asked for. Nothing and complaints if
/// it has none.
std::optional<Pose> ReadPose(const PoseArguments& args, const RobotSpec& robot, Diagnostics& out);

}  // namespace taut::cli
