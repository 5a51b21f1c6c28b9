/// `taut new mapping`: a mapping file from a log.
#pragma once

#include <string>

namespace taut::cli {

struct NewMappingArguments {
  std::string log;    ///< File of a measurement program.
  std::string model;  ///< Model or experiment of the robot.
  std::string out;    ///< File to write; empty: the log's path, ending in .map.json.
};

/// Writes the mapping and prints what was recognized. Returns the exit status.
int NewMapping(const NewMappingArguments& args);

}  // namespace taut::cli
