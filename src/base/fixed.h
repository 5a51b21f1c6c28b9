/// Whether forces move a body.
#pragma once

#include "taut/model_def.h"

namespace taut::base {

/// Of the world, and of bodies that are fixed in it.
inline bool IsFixed(const ModelDef& def, int body) {
  return body == kWorld || def.bodies[static_cast<std::size_t>(body)].fixed;
}

}  // namespace taut::base
