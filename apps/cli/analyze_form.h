/// Form finding from cable tensions or force densities (`taut analyze --form`).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "taut/spec.h"

namespace taut::cli {

/// Tension or force density of every cable; if neither is set, the tensions in the file.
struct FormArguments {
  std::optional<double> tension_n, force_density_n_per_m;
  std::string out;  ///< Model file to write; empty: none.
  bool tables = false;
  std::vector<std::string> again;  ///< Words of this command, for the suggested next command.
};

/// Prints the equilibrium shape under the given cable forces. Returns the exit status.
int FindFormOf(const std::string& file, const RobotSpec& robot, bool weight,
               const FormArguments& args);

}  // namespace taut::cli
