/// Statics of a described model, computed from the `ModelDef` only: lengths and tensions of cables,
/// loads on bodies and joints, principal moments of inertia, colliding shapes.
///
/// SI units, world frame W.
#pragma once

#include <cstddef>
#include <vector>

#include "taut/model_def.h"
#include "taut/shape_kinds.h"

namespace taut {

/// Returns the wrap angle [rad] of a cable at the wheel of attachment `i` in the described pose:
/// from the point before the wheel to the point after it, including full turns, counterclockwise
/// about the wheel's axis.
double WheelStartAngle(const CableDef& cable, std::size_t i);

/// Returns the path length [m] between the ends of a cable, along all attachments and around
/// wheels.
double CableLength(const CableDef& cable);

/// Returns the elastic tension k (l - L) [N]; 0 if slack.
double CableTension(const CableDef& cable);

/// Loads on a body in the described pose.
struct BodyLoad {
  Vec3 cable_force_n;     ///< Sum over all cables, in W.
  Vec3 cable_torque_n_m;  ///< Torque of all cables about the center of mass of the body, in W.
  Vec3 weight_n;          ///< Weight of the body, in W.
};

/// Returns the loads of each body of `def`, including fixed bodies, whose supports carry them.
std::vector<BodyLoad> StartLoads(const ModelDef& def);

/// Force and torque of a joint on its body b at `to_m`, in W; the opposite acts on its body a. For
/// a support, this is the reaction on the robot.
struct JointLoad {
  Vec3 force_n;
  Vec3 torque_n_m;  ///< Torque about `to_m`.
};

/// Maximum number of constrained directions for `StartJointLoads`, whose time grows with the cube
/// of this number.
inline constexpr std::size_t kMostHeldDirections = 2000;

/// Returns the loads of each joint of `def`, from its constraints and its spring, under cable
/// forces and weight (docs/theory/joints.md, eq. 12). The robot is at rest without contacts. In
/// equilibrium, these are the static loads; otherwise, the loads at the moment of its release. If
/// the loads are statically indeterminate, returns one possible distribution. Friction and joint
/// limits are ignored. Empty if joints constrain more than kMostHeldDirections directions.
std::vector<JointLoad> StartJointLoads(const ModelDef& def);

/// Resultant of cables, weight and joint loads. The resultant accelerates a moving body; the
/// support of a fixed body carries it.
struct LeftLoad {
  Vec3 force_n;     ///< Resultant force, in W.
  Vec3 torque_n_m;  ///< About the center of mass of the body, in W.
};
/// Returns the resultant of each body of `def`. `joints`: one per joint.
std::vector<LeftLoad> LeftAtStart(const ModelDef& def, const std::vector<JointLoad>& joints);

/// Returns the principal moments of inertia, ascending [kg m^2].
Vec3 PrincipalMoments(const Inertia& inertia_kg_m2);

/// Returns the total mass of the moving bodies [kg].
double TotalMass(const ModelDef& def);

/// Number of colliding shapes of one kind.
struct ShapeCount {
  ShapeName name;
  int count = 0;
};
/// Returns the number of colliding shapes of each kind, per body of `def`.
std::vector<std::vector<ShapeCount>> CollidingShapes(const ModelDef& def);

}  // namespace taut
