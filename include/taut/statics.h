/// Statics of a described model: lengths and tensions of cables, loads on bodies and joints,
/// principal moments of inertia, colliding shapes. Computed from the `ModelDef` only.
///
/// SI units, W frame.
#pragma once

#include <cstddef>
#include <vector>

#include "taut/model_def.h"
#include "taut/shape_kinds.h"

namespace taut {

/// Returns the wrap angle at the wheel of attachment `i` in the described pose [rad]: from the
/// point before it to the point after it, including full turns, counterclockwise about the wheel's
/// axis.
double WheelStartAngle(const CableDef& cable, std::size_t i);

/// Returns the path length between a cable's ends, along all attachments and around wheels [m].
double CableLength(const CableDef& cable);

/// Returns the elastic tension k (l - L), 0 when slack [N].
double CableTension(const CableDef& cable);

/// Loads on a body in the described pose.
struct BodyLoad {
  Vec3 cable_force_n;     ///< Sum over all cables, in W.
  Vec3 cable_torque_n_m;  ///< The same about the body's center of mass, in W.
  Vec3 weight_n;          ///< In W.
};

/// Returns the loads of each body of `def`. Fixed bodies have loads too, for their supports to
/// carry.
std::vector<BodyLoad> StartLoads(const ModelDef& def);

/// Force and torque of a joint on its body b at `to_m`, in W; on its body a the opposite. Of a
/// support: the reaction on the robot.
struct JointLoad {
  Vec3 force_n;
  Vec3 torque_n_m;  ///< About `to_m`.
};

/// Largest number of constrained directions for `StartJointLoads`: its time grows with the third
/// power.
inline constexpr std::size_t kMostHeldDirections = 2000;

/// Returns the loads of each joint of `def`, by its constraints and its spring, under cable forces
/// and weight, at rest and without contacts (docs/theory/joints.md, eq. 12). In equilibrium these
/// are the static loads; else the loads at the moment when the robot is released. If the
/// distribution of loads is statically indeterminate, one of the possible distributions. Friction
/// and joint limits are ignored. Empty if joints constrain more than kMostHeldDirections
/// directions.
std::vector<JointLoad> StartJointLoads(const ModelDef& def);

/// Resultant of cables, weight and joint loads: accelerates a body, or must be carried by the
/// support of a fixed body.
struct LeftLoad {
  Vec3 force_n;     ///< In W.
  Vec3 torque_n_m;  ///< About the body's center of mass, in W.
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
