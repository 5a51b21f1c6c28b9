/// Joints and supports: constraints on the motion of one body relative to another, with joint
/// limits, springs, dampers and friction (docs/theory/joints.md). A support is a joint with the
/// world.
#pragma once

#include <iterator>
#include <optional>
#include <string>

#include "taut/member_def.h"
#include "taut/types.h"

namespace taut {

/// Degrees of freedom that a joint leaves to its body b relative to its body a. `axis` and two
/// directions normal to it are fixed in a.
enum class JointKind {
  kBall,         ///< All rotations.
  kHinge,        ///< Rotation about the axis.
  kWeld,         ///< None.
  kPrismatic,    ///< Sliding along the axis.
  kCylindrical,  ///< Sliding along the axis and rotation about it.
  kPlanar,       ///< Sliding normal to the axis and rotation about it.
  kLine,         ///< All rotations; b's point slides on the line along the axis through a's point.
  kPlane,  ///< All rotations; b's point slides in the plane normal to the axis through a's point.
  kDistance,  ///< All but the distance between the two points.
};

/// Definition of a joint between two bodies, or between a body and the world.
///
/// Coordinate of a joint (none for kinds without `HasCoordinate`):
///  - hinge: angle [rad], counting full turns;
///  - prismatic, cylindrical, line: displacement along the axis from a's point to b's point [m];
///  - distance: distance between the points [m];
///  - ball: angle between the axis in a and the axis in b [rad].
/// Angles are 0 in the described pose if `turned` is the identity. Forces of a coordinate that is
/// an angle are torques [N m], other forces are in N.
struct JointDef {
  /// Largest initial distance between points that a joint holds together [m]; the first step closes
  /// it.
  static constexpr double kClosed_m = 1e-6;

  std::string name;
  JointKind kind = JointKind::kBall;
  int body_a = kWorld, body_b = 0;  ///< b is a body; at most one of the two is fixed.
  Vec3 from_m, to_m;                ///< Point of a and point of b, in W.
  Vec3 axis{0.0, 0.0, 1.0};         ///< Unit vector in W.
  /// Rotation of b's axes relative to a's axes in the described pose, in W. Identity, unless the
  /// robot is described in a pose in which these axes do not coincide.
  Quat turned;
  bool collides = false;  ///< Whether its two bodies can touch each other.

  // Properties of the coordinate:
  std::optional<double> least, most;  ///< Joint limits; a ball has only `most`.
  double restitution = 0.0;           ///< Coefficient of restitution at the limits, 0..1.
  // Also of the coordinate, except for a ball: there they act on all rotations, about every axis
  // alike, that is on the rotation vector of b relative to a (up to half a turn) and on its rate.
  double friction = 0.0;                  ///< Largest dry friction [N or N m], >= 0.
  double stiffness = 0.0, damping = 0.0;  ///< Of a spring and a damper, >= 0.
  double rest = 0.0;      ///< Coordinate at which the spring is unloaded; 0 for a ball.
  MemberDef member = {};  ///< Section and limits of a bar.
  bool operator==(const JointDef&) const = default;
};

/// Returns whether a joint is an elastic bar: a distance joint with a spring, which pulls and
/// pushes.
inline bool IsBar(const JointDef& j) noexcept {
  return j.kind == JointKind::kDistance && j.stiffness > 0.0;
}

/// Returns whether a distance joint keeps its length: it has neither limits nor a spring.
inline bool HoldsLength(const JointDef& j) noexcept {
  return !j.least && !j.most && j.stiffness == 0.0;
}

/// Motions of b relative to a that a kind of joint constrains. A distance joint, which has no axis,
/// constrains none of these four.
struct HeldMotions {
  bool along = false;   ///< Sliding along the axis.
  bool across = false;  ///< Sliding in all directions normal to the axis.
  bool swing = false;   ///< Rotation of the axis.
  bool twist = false;   ///< Rotation about the axis.
};

/// Type of the scalar coordinate of a joint.
enum class JointCoordinate { kNone, kLength, kAngle };

/// Properties of a kind of joint.
struct JointKindRow {
  const char* name;  ///< In files.
  HeldMotions constrained;
  JointCoordinate coordinate;
};
/// Kinds of joints, in the order of `JointKind`. A new kind needs a row here, a value of
/// `JointKind`, a symbol in the viewer, and a case in src/sim/compile/model_joints.cpp.
inline constexpr JointKindRow kJointKindRows[] = {
    // Constrained: along, across, swing, twist.
    {"ball", {true, true, false, false}, JointCoordinate::kAngle},
    {"hinge", {true, true, true, false}, JointCoordinate::kAngle},
    {"weld", {true, true, true, true}, JointCoordinate::kNone},
    {"prismatic", {false, true, true, true}, JointCoordinate::kLength},
    {"cylindrical", {false, true, true, false}, JointCoordinate::kLength},
    {"planar", {true, false, true, false}, JointCoordinate::kNone},
    {"line", {false, true, false, false}, JointCoordinate::kLength},
    {"plane", {true, false, false, false}, JointCoordinate::kNone},
    {"distance", {false, false, false, false}, JointCoordinate::kLength},
};
static_assert(std::size(kJointKindRows) == static_cast<int>(JointKind::kDistance) + 1);
/// Returns the properties of a kind of joint.
constexpr const JointKindRow& RowOf(JointKind kind) noexcept {
  return kJointKindRows[static_cast<int>(kind)];
}

/// Returns the name of a kind of joint in files.
constexpr const char* JointKindName(JointKind kind) noexcept { return RowOf(kind).name; }

/// Returns the motions that a kind of joint constrains.
constexpr HeldMotions ConstrainedMotions(JointKind kind) noexcept {
  return RowOf(kind).constrained;
}

/// Returns the distance between a joint's two points along the directions that it constrains [m].
double JointError(const JointDef& joint) noexcept;

[[deprecated("ConstrainedMotions")]] constexpr HeldMotions HeldBy(JointKind kind) noexcept {
  return ConstrainedMotions(kind);
}
[[deprecated("JointError")]] inline double HeldGap(const JointDef& joint) noexcept {
  return JointError(joint);
}

/// Pair of bodies without contacts between them.
struct ApartDef {
  int body_a = 0, body_b = 0;
};

/// Returns whether one coordinate describes the position of a joint.
constexpr bool HasCoordinate(JointKind kind) noexcept {
  return RowOf(kind).coordinate != JointCoordinate::kNone;
}

/// Returns whether a joint's coordinate is an angle.
constexpr bool IsAngle(JointKind kind) noexcept {
  return RowOf(kind).coordinate == JointCoordinate::kAngle;
}

}  // namespace taut
