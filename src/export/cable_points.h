/// Path of a cable as a polyline.
#pragma once

#include <vector>

#include "taut/model_def.h"

namespace taut::exporting {

/// Returns the points of a cable's path in W. Arcs on wheels have steps of ten degrees.
std::vector<Vec3> CablePoints(const CableDef& cable);

}  // namespace taut::exporting
