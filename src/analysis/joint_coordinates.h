/// Constraint rows and spring energies of joints, with derivatives.
#pragma once

#include "analysis/coordinate.h"
#include "mechanics/held_rows.h"
#include "taut/joint_def.h"

namespace taut::analysis {

/// Joint with its attachment points on both bodies.
struct PlacedJoint {
  JointDef def;
  Anchor a, b;  ///< `body` of each: index among the moving bodies, or -1.
};

/// Returns the violation of a constraint row [m or rad].
Coordinate HeldAt(const PlacedJoint& joint, HeldRow row, const Placement& at);

/// Returns the length of a distance joint [m].
Coordinate DistanceAt(const PlacedJoint& joint, const Placement& at);

/// Returns the energy of a joint's spring, or of a bar [J].
Coordinate SpringEnergyAt(const PlacedJoint& joint, const Placement& at);

/// Returns the load on body b of the joint, acting at point b. `force`: generalized force along
/// coordinate `c`. For supports and for joints whose body b moves, this is the whole load.
Wrench LoadOf(const PlacedJoint& joint, const Coordinate& c, double force, const Placement& at);

}  // namespace taut::analysis
