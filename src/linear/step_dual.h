/// Simulation step compiled for dual numbers (automatic differentiation).
#pragma once

#include "sim/data/group.h"

namespace taut::linear {

/// Kernel for groups of two lanes: the values of one world and their derivatives.
extern const sim::Kernel kKernelDual;

/// Least h^2 K for which the solver computes a cable's tension.
extern const double kStiffFrom;

}  // namespace taut::linear
