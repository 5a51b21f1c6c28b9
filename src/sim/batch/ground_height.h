/// Height of the terrain at a point, seen from above.
#pragma once

#include "taut/world_batch.h"

namespace taut::sim {

/// Returns z of the highest terrain point above or below (x, y) [m], in W. Minus infinity without
/// terrain; infinity under an overhanging half space. Thread safe.
double GroundHeight(const Model& model, double x_m, double y_m);

}  // namespace taut::sim
