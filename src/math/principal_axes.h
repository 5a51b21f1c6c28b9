/// Principal axes of inertia.
#pragma once

#include "taut/types.h"

namespace taut {

/// Computes the eigenvectors of an inertia matrix, or any symmetric matrix: on return the columns
/// of `r` (row major) are the principal axes, right-handed, and `moments` their moments [kg m^2].
/// Same bits on all machines.
void PrincipalAxes(const Inertia& inertia, double r[9], double moments[3]) noexcept;

/// Permutes the axes cyclically so that the two nearest moments come first: the drift of a body is
/// exact if they are equal. Moments that differ by rounding are set equal.
void SymmetryAxisLast(double r[9], double moments[3]) noexcept;

}  // namespace taut
