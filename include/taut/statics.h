/// What a model is like before it moves: lengths and tensions of its cables, the forces on its
/// bodies and in its joints, its principal inertias, what may touch what. Made from the plain
/// description alone.
#pragma once

#include <cstddef>
#include <vector>

#include "taut/model_def.h"

namespace taut {

/// The angle about the wheel of attachment `i` as described, from the point before it to that
/// behind it, with all turns, counter-clockwise about its axis [rad].
double WheelStartAngle(const CableDef& cable, std::size_t i);

/// Between the ends, along all attachments and round wheels [m].
double CableLength(const CableDef& cable);

/// k (l - L), 0 when slack [N].
double CableTension(const CableDef& cable);

/// What acts on a body at the start.
struct BodyLoad {
  Vec3 cable_force_n;     ///< Sum over all cables, in W.
  Vec3 cable_torque_n_m;  ///< The same about the body's centre of mass, in W.
  Vec3 weight_n;          ///< In W.
};

/// Per body of `def`. Fixed bodies carry loads, too: what holds them has to.
std::vector<BodyLoad> StartLoads(const ModelDef& def);

/// What a joint does to its body b, at `to_m`, in W; to its body a the opposite. Of a support: what
/// holds the robot there.
struct JointLoad {
  Vec3 force_n;
  Vec3 torque_n_m;  ///< About `to_m`.
};

/// A joint's directions that `StartJointLoads` works out at most: time grows with their cube.
inline constexpr std::size_t kMostHeldDirections = 2000;

/// Per joint of `def`: by what it holds and by its spring, against cables and weight, at rest and
/// touching nothing (docs/theory/joints.md, eq. 12). In equilibrium that is statics; else what acts
/// in the moment when the robot is let go. Loads that may be shared in many ways are shared in one.
/// Neither friction nor stops take part. Empty if joints hold more than kMostHeldDirections.
std::vector<JointLoad> StartJointLoads(const ModelDef& def);

/// Of cables, weight and `joints` together: what accelerates a body, or has to hold a fixed one.
struct LeftLoad {
  Vec3 force_n;     ///< In W.
  Vec3 torque_n_m;  ///< About the body's centre of mass, in W.
};
/// Per body of `def`. `joints`: per joint.
std::vector<LeftLoad> LeftAtStart(const ModelDef& def, const std::vector<JointLoad>& joints);

/// Moments about the principal axes, ascending [kg m^2].
Vec3 PrincipalMoments(const Inertia& inertia_kg_m2);

/// Sum over the bodies that move [kg].
double TotalMass(const ModelDef& def);

/// How many shapes of a body may touch something.
struct ShapeCount {
  int capsules = 0, spheres = 0, boxes = 0, hulls = 0;
  int total() const noexcept { return capsules + spheres + boxes + hulls; }
};
std::vector<ShapeCount> CollidingShapes(const ModelDef& def);  ///< Per body of `def`.

}  // namespace taut
