/// Robot from a model file or an experiment file.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include "analyze_pose.h"
#include "taut/spec.h"

namespace taut::cli {

/// Loads the robot of a model or an experiment. Nothing, with errors in `out`, for other files,
/// such as gaits.
std::optional<RobotSpec> LoadAnyRobot(const std::string& path, const Overrides& overrides,
                                      Diagnostics& out);

/// Robot and pose: arguments common to all exports.
struct PlacedRobotArguments {
  std::string path;
  std::vector<std::string> set;
  PoseArguments pose;
  bool strict = false;
};
void AddPlacedRobot(CLI::App& command, PlacedRobotArguments& args);

/// Loads the robot in its start pose, settled if its experiment has that option, or in the
/// requested pose. Returns nothing after errors on stderr; then `exit` is the status. Prints
/// warnings.
std::optional<RobotSpec> LoadPlacedRobot(const PlacedRobotArguments& args, int& exit);

}  // namespace taut::cli
