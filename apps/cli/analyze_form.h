/// `taut analyze --form`.
#pragma once

#include <optional>
#include <string>

#include "commands.h"
#include "taut/spec.h"

namespace taut::cli {

/// Of every cable; nothing: the tensions described.
struct FormArguments {
  std::optional<double> tension_n, force_density_n_per_m;
  std::string out;  ///< Model file to write; empty: none.
};

/// Prints the form that cables under these forces give the robot. Returns the exit status.
int FindFormOf(const std::string& file, const RobotSpec& robot, bool weight,
               const FormArguments& args);

}  // namespace taut::cli
