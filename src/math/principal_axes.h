/// Principal axes of inertia.
#pragma once

#include "taut/types.h"

namespace taut {

/// Eigenvectors of an inertia matrix, or of any symmetric one: on return the columns of `r` (row
/// major) are the principal axes, right handed, and `moments` their moments [kg m^2]. Same bits
/// everywhere.
void PrincipalAxes(const Inertia& inertia, double r[9], double moments[3]) noexcept;

}  // namespace taut
