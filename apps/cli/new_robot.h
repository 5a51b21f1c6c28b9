/// Folder of a new robot, from the templates in share/robots.
#pragma once

#include <string>
#include <vector>

namespace taut::cli {

/// Returns the names of the templates, for `--like`; the first one is the default.
const std::vector<std::string>& RobotTemplates();

/// Writes the template `like` into the new folder `name`, with `name` as the model's name. Returns
/// the exit status. Lists existing files on stderr and overwrites none of them.
int NewRobot(const std::string& name, const std::string& like);

}  // namespace taut::cli
