/// Rotation error of a joint's bodies in the described pose, about the axes that it holds.
#pragma once

#include "taut/joint_def.h"

namespace taut::math {

/// Largest initial error of held rotations [rad]; the first step closes it.
inline constexpr double kClosedTurn_rad = 1e-6;

/// Returns the rotation of b against a by `joint.turned`, about axes that the joint holds [rad, if
/// small]; 0 if it holds no rotation.
double HeldTurn(const JointDef& joint) noexcept;

}  // namespace taut::math
