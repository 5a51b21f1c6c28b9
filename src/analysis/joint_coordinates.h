/// What joints hold, and what their springs measure, with derivatives.
#pragma once

#include "analysis/coordinate.h"
#include "mechanics/held_rows.h"
#include "taut/joint_def.h"

namespace taut::analysis {

/// A joint with its two points.
struct PlacedJoint {
  JointDef def;
  Anchor a, b;  ///< `body` of each: among those that move, or -1.
};

/// How far a row is from what it holds [m] or [rad].
Coordinate HeldAt(const PlacedJoint& joint, HeldRow row, const Placement& at);

/// The length of a distance [m].
Coordinate DistanceAt(const PlacedJoint& joint, const Placement& at);

/// The energy of a joint's spring [J]; also of a bar.
Coordinate SpringEnergyAt(const PlacedJoint& joint, const Placement& at);

/// What a change of `c`, by `force` a unit, does to the joint's body b, with the force at its point
/// b. A support has all in b; so has a joint whose body b moves.
Wrench LoadOf(const PlacedJoint& joint, const Coordinate& c, double force, const Placement& at);

}  // namespace taut::analysis
