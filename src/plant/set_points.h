/// Which cables have set points of their tension.
#pragma once

#include <algorithm>
#include <vector>

#include "taut/spec.h"

namespace taut::plant {

/// Those that the impedance law drives, ascending.
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
