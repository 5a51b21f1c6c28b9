/// Rotations as row-major matrices and as unit quaternions, for code outside of the step.
#pragma once

#include "taut/types.h"

namespace taut {

/// Converts a matrix to a quaternion by Shepperd's method, which computes the largest component
/// first.
Quat QuatOf(const double r[9]) noexcept;
/// Converts a quaternion of any nonzero length to a matrix.
void MatrixOf(const Quat& q, double r[9]) noexcept;

}  // namespace taut
