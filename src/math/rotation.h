/// Rotations as matrices (row major) and as unit quaternions, for code outside of the step.
#pragma once

#include "taut/types.h"

namespace taut {

/// Converts a matrix by Shepperd's method: the largest component first.
Quat QuatOf(const double r[9]) noexcept;
/// Converts a quaternion of any length except 0.
void MatrixOf(const Quat& q, double r[9]) noexcept;

}  // namespace taut
