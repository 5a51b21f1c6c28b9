/// The robot of a model file or of an experiment file.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include "analyze_pose.h"
#include "taut/spec.h"

namespace taut::cli {

/// Nothing and complaints of a file that has none, as a gait.
std::optional<RobotSpec> LoadAnyRobot(const std::string& path, const Overrides& overrides,
                                      Diagnostics& out);

/// A robot and where it is: what exports have in common.
struct PlacedRobotArguments {
  std::string path;
  std::vector<std::string> set;
  PoseArguments pose;
  bool strict = false;
};
void AddPlacedRobot(CLI::App& command, PlacedRobotArguments& args);

/// The robot where it starts, settled if its experiment says so, or in the pose that was asked for.
/// Nothing after complaints on stderr; then `exit` is the status. Warnings are printed.
std::optional<RobotSpec> LoadPlacedRobot(const PlacedRobotArguments& args, int& exit);

}  // namespace taut::cli
