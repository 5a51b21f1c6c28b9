/// The scenes that contact solvers are measured with.
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
  bool for_peers = true;  ///< Engines without implicit cables do not survive all of them.
  bool held_out = false;  ///< Of a kind that no solver of taut was tuned with.
};

std::vector<ContactScene> ContactScenes();

/// All angles, coefficients and ways of Painleve's rod: one step each.
std::vector<ModelDef> PainleveGrid();

}  // namespace taut::bench
