/// How high terrain is, seen from above.
#pragma once

#include "taut/batch.h"

namespace taut::sim {

/// z of the highest point of all terrain at a place [m], in W; minus infinity where there is none,
/// infinity where a half space hangs over it. Any thread.
double GroundHeight(const Model& model, double x_m, double y_m);

}  // namespace taut::sim
