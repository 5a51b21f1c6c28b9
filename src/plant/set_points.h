/// Cables with tension set points.
#pragma once

#include <algorithm>
#include <vector>

#include "taut/spec.h"

namespace taut::plant {

/// Returns the cables that impedance control drives, in ascending order.
inline std::vector<int> CablesWithSetPoints(const std::vector<ControllerSpec>& controllers) {
  std::vector<int> cables;
  for (const ControllerSpec& controller : controllers) {
    if (!controller.impedance) continue;
    for (const ImpedanceGains& gains : controller.impedance->cables) cables.push_back(gains.cable);
  }
  std::sort(cables.begin(), cables.end());
  return cables;
}

}  // namespace taut::plant
