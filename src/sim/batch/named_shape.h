/// Names of shapes and terrain for messages.
#pragma once

#include <string>

#include "taut/world_batch.h"

namespace taut::sim {

bool IsTerrain(const ShapeRef& ref) noexcept;

/// Returns, for example, `the rod "a"` or `the terrain "ground"`.
std::string ShapeText(const ModelDef& def, const ShapeRef& ref);

}  // namespace taut::sim
