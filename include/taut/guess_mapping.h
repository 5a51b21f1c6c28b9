/// Guess of a mapping file from a log and a robot's names (`taut new mapping`).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut {

/// Names of a robot to which the columns of a log may belong.
struct RobotNames {
  std::vector<std::string> cables, bodies, nodes, joints;
};

struct GuessedMapping {
  std::string text;                  ///< Mapping file (JSON) with comments.
  std::vector<std::string> results;  ///< Recognized items, one per line.
  std::vector<std::string> doubts;   ///< Items for the user to check or add, one per line.
};

/// Reads the first lines of a text table and guesses its encoding, separator, decimal mark, header,
/// clock and units. Assigns columns to channels of the robot by the names and the unit in each
/// column name. Recognizes the layouts of LabVIEW (.lvm), OptiTrack, Vicon and Qualisys (.tsv).
/// Returns nothing and adds a diagnostic if the file cannot be read or has no rows of numbers.
std::optional<GuessedMapping> GuessMapping(const std::string& path, const RobotNames& robot,
                                           Diagnostics& out);

}  // namespace taut
