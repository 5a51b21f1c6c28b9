/// Height of the terrain, seen from above.
#pragma once

#include "taut/world_batch.h"

namespace taut::sim {

/// Returns z of the highest point of all terrain at a place [m], in W; minus infinity where there
/// is none, infinity where a half space overhangs it. Thread-safe.
double GroundHeight(const Model& model, double x_m, double y_m);

}  // namespace taut::sim
