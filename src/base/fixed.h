/// Fixed bodies: bodies that forces do not move.
#pragma once

#include "taut/model_def.h"

namespace taut::base {

/// Returns true for the world and for bodies fixed in it.
inline bool IsFixed(const ModelDef& def, int body) {
  return body == kWorld || def.bodies[static_cast<std::size_t>(body)].fixed;
}

}  // namespace taut::base
