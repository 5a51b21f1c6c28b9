/// Rotations as matrices (row major) and as unit quaternions: for the code around the step.
#pragma once

#include "taut/types.h"

namespace taut {

/// Shepperd's method: the largest component first.
Quat QuatOf(const double r[9]) noexcept;
/// Of a quaternion of any length but 0.
void MatrixOf(const Quat& q, double r[9]) noexcept;

}  // namespace taut
