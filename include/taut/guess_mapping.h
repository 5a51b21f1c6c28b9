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
  std::vector<std::string> results;  ///< What was recognized, a line each.
  std::vector<std::string> doubts;   ///< What the user should check or add, a line each.
};

/// Reads the first lines of a text table and guesses its encoding, separator, decimal mark, header,
/// clock and units, and which column belongs to which channel of the robot: by the names in it and
/// by its unit. Knows the layouts of LabVIEW (.lvm), OptiTrack, Vicon and Qualisys (.tsv). Returns
/// nothing, with a diagnostic, if the file cannot be read or has no rows of numbers.
std::optional<GuessedMapping> GuessMapping(const std::string& path, const RobotNames& robot,
                                           Diagnostics& out);

}  // namespace taut
