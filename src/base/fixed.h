/// Test for fixed bodies, which forces do not move.
#pragma once

#include "taut/model_def.h"

namespace taut::base {

/// Returns true for the world and for bodies with `fixed`.
inline bool IsFixed(const ModelDef& def, int body) {
  return body == kWorld || def.bodies[static_cast<std::size_t>(body)].fixed;
}

}  // namespace taut::base
