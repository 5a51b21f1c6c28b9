/// `taut analyze --inverse`.
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "taut/inverse_statics.h"
#include "taut/spec.h"

namespace taut::cli {

inline constexpr double kTouch_m = 1e-3;  ///< So near the ground bears.

struct InverseArguments {
  HoldingCost minimise = HoldingCost::kForceDensity;
  CableBounds bounds;  ///< Of every cable.
  bool json = false;
  std::vector<double> calibration_rest_m;  ///< Per cable, or empty: as described.
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

/// Prints what holds the robot as described under each of the cases. Returns the exit status.
int Inverse(const std::string& file, const RobotSpec& robot, const std::vector<LoadCaseSpec>& cases,
            const std::vector<std::string>& notes, const InverseArguments& args);

}  // namespace taut::cli
