/// Load-displacement paths (`taut analyze --path`).
#pragma once

#include <string>
#include <vector>

#include "taut/load_path.h"
#include "taut/spec.h"

namespace taut::cli {

struct PathArguments {
  double to_factor = 2;
  bool json = false, tables = false;
};

/// Prints the load-displacement path of each load case. Returns the exit status.
int FollowPaths(const std::string& file, const RobotSpec& robot,
                const std::vector<LoadCaseSpec>& cases, const std::vector<std::string>& notes,
                const PathArguments& args);

}  // namespace taut::cli
