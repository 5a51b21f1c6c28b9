/// Rotation error of a joint in the described pose, about its constrained axes.
#pragma once

#include "taut/joint_def.h"

namespace taut::math {

/// Largest initial error of constrained rotations [rad]; the first step removes this error.
inline constexpr double kClosedTurn_rad = 1e-6;

/// Returns the rotation of `joint.turned` about the constrained axes [rad, if small]; 0 if the
/// joint constrains no rotation.
double HeldTurn(const JointDef& joint) noexcept;

}  // namespace taut::math
