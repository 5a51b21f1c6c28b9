/// How a joint's bodies are turned against each other where it holds that.
#pragma once

#include "taut/joint_def.h"

namespace taut::math {

/// Rotations that a joint holds may be off by this much at first [rad]; the first step closes it.
inline constexpr double kClosedTurn_rad = 1e-6;

/// By how much `joint.turned` turns b against a in directions that the joint holds [rad, if small];
/// 0 where it leaves all turns free.
double HeldTurn(const JointDef& joint) noexcept;

}  // namespace taut::math
