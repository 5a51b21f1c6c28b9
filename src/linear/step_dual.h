/// Simulation step compiled for dual numbers (automatic differentiation).
#pragma once

#include "sim/data/group.h"

namespace taut::linear {

/// Kernel for groups of two lanes: the first holds the values of one world, the second their
/// derivatives.
extern const sim::Kernel kKernelDual;

/// Smallest h^2 K (h: time step; K: stiffness over mass, row `stiff_k`) for which the solver
/// computes a cable's tension.
extern const double kStiffFrom;

}  // namespace taut::linear
