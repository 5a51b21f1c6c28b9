/// Where a cable goes.
#pragma once

#include <vector>

#include "taut/model_def.h"

namespace taut::exporting {

/// Its places in W, arcs on wheels in steps of ten degrees.
std::vector<Vec3> CablePoints(const CableDef& cable);

}  // namespace taut::exporting
