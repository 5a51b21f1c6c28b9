/// The step compiled for numbers with a derivative.
#pragma once

#include "sim/data/group.h"

namespace taut::linear {

/// Of groups of two lanes, which are one world and the derivative of all that it has.
extern const sim::Kernel kKernelDual;

/// From which h^2 K on the solver finds a cable's tension.
extern const double kStiffFrom;

}  // namespace taut::linear
