/// Principal axes of inertia.
#pragma once

#include "taut/types.h"

namespace taut {

/// Computes principal axes and moments of an inertia matrix, or eigenvectors and eigenvalues of any
/// symmetric matrix. Results: the axes in the columns of `r` (row-major), right-handed, and their
/// moments [kg m^2]. The results have the same bits on all machines.
void PrincipalAxes(const Inertia& inertia, double r[9], double moments[3]) noexcept;

/// Permutes the axes cyclically so that the two most similar moments come first; moments that
/// differ only by rounding become equal. For equal moments, the drift of a body is exact.
void SymmetryAxisLast(double r[9], double moments[3]) noexcept;

}  // namespace taut
