/// What `taut check` prints about a robot.
#pragma once

#include <string>

#include "taut/spec.h"
#include "taut/start.h"

namespace taut::cli {

/// Aligned tables: bodies, cables, loads at the start, what may collide.
std::string RobotTables(const RobotSpec& robot);

/// One line on what an experiment does, and its controllers, events and phases.
std::string ExperimentTables(const ExperimentSpec& experiment);

/// The same facts for programs, and the warnings. `experiment` may be null, and `settled`: what
/// settling did.
std::string CheckJson(const RobotSpec& robot, const ExperimentSpec* experiment,
                      const Diagnostics& found, const StartChange* settled);

/// The errors and warnings of a file for programs.
std::string ErrorsJson(const std::string& path, const Diagnostics& found);

}  // namespace taut::cli
