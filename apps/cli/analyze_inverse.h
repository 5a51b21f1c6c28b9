/// Inverse statics (`taut analyze --inverse`).
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "taut/inverse_statics.h"
#include "taut/spec.h"

namespace taut::cli {

inline constexpr double kTouch_m =
    1e-3;  ///< Distance from the ground within which a point can carry load.

struct InverseArguments {
  HoldingCost minimise = HoldingCost::kForceDensity;
  CableBounds bounds;  ///< Limits for every cable.
  bool json = false, tables = false;
  std::vector<std::string> again;  ///< Words of this command, for the suggested next command.
  std::vector<double> calibration_rest_m;  ///< Rest length per cable [m]; empty: as in the file.
};

inline const char* HoldingCostName(HoldingCost cost) {
  switch (cost) {
    case HoldingCost::kTension:
      return "tension";
    case HoldingCost::kEnergy:
      return "energy";
    case HoldingCost::kForceDensity:
      return "force_density";
  }
  return "";
}

/// Prints the cable forces that hold the robot in its described pose under each load case. Returns
/// the exit status.
int Inverse(const std::string& file, const RobotSpec& robot, const std::vector<LoadCaseSpec>& cases,
            const std::vector<std::string>& notes, const InverseArguments& args);

}  // namespace taut::cli
