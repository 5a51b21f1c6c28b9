/// Principal axes of inertia.
#pragma once

#include "taut/types.h"

namespace taut {

/// Eigenvectors of an inertia matrix, or of any symmetric one: on return the columns of `r` (row
/// major) are the principal axes, right handed, and `moments` their moments [kg m^2]. Same bits
/// everywhere.
void PrincipalAxes(const Inertia& inertia, double r[9], double moments[3]) noexcept;

/// Names the axes anew, in a cycle, so that the two whose moments are nearest come first: the drift
/// of a body is exact if those are equal. Moments that differ by rounding are made so.
void SymmetryAxisLast(double r[9], double moments[3]) noexcept;

}  // namespace taut
