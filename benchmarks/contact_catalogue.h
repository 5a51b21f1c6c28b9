/// Scenes for benchmarks of contact solvers.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "taut/model_def.h"

namespace taut::bench {

struct ContactScene {
  std::string name;
  std::function<ModelDef(std::uint64_t seed)> def;
  int steps = 3000;
  bool moves = false;     ///< Its cables change their rest lengths (`Motion`).
  bool for_peers = true;  ///< False if engines without implicit cables fail on it.
  bool held_out = false;  ///< Kind of scene that was not used to tune taut's solvers.
};

std::vector<ContactScene> ContactScenes();

/// Returns Painlevé's rod for all angles, coefficients and directions, for one step each.
std::vector<ModelDef> PainleveGrid();

}  // namespace taut::bench
