/// Joints and supports: constraints on the relative motion of two bodies, with joint limits,
/// springs, dampers and friction (docs/theory/joints.md). A support is a joint with the world.
#pragma once

#include <iterator>
#include <optional>
#include <string>

#include "taut/member_def.h"
#include "taut/types.h"

namespace taut {

/// Kinds of joints, with the motions that they allow to body b relative to body a. `axis` and the
/// directions normal to it are fixed in a.
enum class JointKind {
  kBall,         ///< All rotations.
  kHinge,        ///< Rotation about the axis.
  kWeld,         ///< No motion.
  kPrismatic,    ///< Sliding along the axis.
  kCylindrical,  ///< Sliding along the axis and rotation about it.
  kPlanar,       ///< Sliding normal to the axis and rotation about it.
  kLine,         ///< All rotations; b's point slides along the axis through a's point.
  kPlane,  ///< All rotations; b's point slides in the plane through a's point normal to the axis.
  kDistance,  ///< All motions that keep the distance of the two points.
};

/// Definition of a joint between two bodies, or between a body and the world.
///
/// Coordinate of a joint (see `HasCoordinate`):
///  - hinge: angle [rad], counting full turns;
///  - prismatic, cylindrical, line: displacement along the axis from a's point to b's point [m];
///  - distance: distance between the points [m];
///  - ball: angle between the axis in a and the axis in b [rad].
/// In the described pose, angles are 0 if `turned` is the identity. If the coordinate is an angle,
/// its forces are torques [N m]; otherwise they are in N.
struct JointDef {
  /// Largest initial gap of a joint [m]; the first step closes the gap.
  static constexpr double kClosed_m = 1e-6;

  std::string name;
  JointKind kind = JointKind::kBall;
  int body_a = kWorld, body_b = 0;  ///< a: body or world; b: body. At most one of the two is fixed.
  Vec3 from_m, to_m;                ///< Points of a and b, in W.
  Vec3 axis{0.0, 0.0, 1.0};         ///< Unit vector in W.
  /// Rotation of b's axes relative to a's axes in the described pose, in W. The rotation differs
  /// from the identity only if the axes do not coincide there.
  Quat turned;
  bool collides = false;  ///< Whether the two bodies can collide.

  // Properties along the coordinate.
  std::optional<double> least, most;  ///< Joint limits; a ball joint has only `most`.
  double restitution = 0.0;           ///< Coefficient of restitution of the joint limits, 0..1.
  // For a ball joint, friction, stiffness and damping act on its rotation vector (angle up to half
  // a turn) and its angular velocity, in the same way about every axis.
  double friction = 0.0;                  ///< Largest Coulomb friction [N or N m], >= 0.
  double stiffness = 0.0, damping = 0.0;  ///< Spring stiffness and damping coefficient, >= 0.
  double rest = 0.0;      ///< Coordinate of the unloaded spring; 0 for a ball joint.
  MemberDef member = {};  ///< Cross section and limits of a bar.
  bool operator==(const JointDef&) const = default;
};

/// Returns whether a joint is an elastic bar: a distance joint with a spring.
inline bool IsBar(const JointDef& j) noexcept {
  return j.kind == JointKind::kDistance && j.stiffness > 0.0;
}

/// Returns whether a distance joint has a fixed length: no limits and no spring.
inline bool HoldsLength(const JointDef& j) noexcept {
  return !j.least && !j.most && j.stiffness == 0.0;
}

/// Relative motions that a kind of joint constrains. No such constraint applies to a distance
/// joint, which has no axis.
struct HeldMotions {
  bool along = false;   ///< Sliding along the axis.
  bool across = false;  ///< Sliding in every direction normal to the axis.
  bool swing = false;   ///< Rotation of the axis.
  bool twist = false;   ///< Rotation about the axis.
};

/// Type of the scalar coordinate of a joint.
enum class JointCoordinate { kNone, kLength, kAngle };

/// Properties of a kind of joint.
struct JointKindRow {
  const char* name;  ///< Name in files.
  HeldMotions constrained;
  JointCoordinate coordinate;
};
/// Kinds of joints, in the order of `JointKind`. A new kind needs a row here, a value in
/// `JointKind`, a symbol in the viewer, and a case in src/sim/compile/model_joints.cpp.
inline constexpr JointKindRow kJointKindRows[] = {
    // constrained motions: along, across, swing, twist
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

/// Returns the gap of a joint: distance between its two points along the constrained directions
/// [m].
double JointError(const JointDef& joint) noexcept;

[[deprecated("ConstrainedMotions")]] constexpr HeldMotions HeldBy(JointKind kind) noexcept {
  return ConstrainedMotions(kind);
}
[[deprecated("JointError")]] inline double HeldGap(const JointDef& joint) noexcept {
  return JointError(joint);
}

/// Pair of bodies that cannot collide.
struct ApartDef {
  int body_a = 0, body_b = 0;
};

/// Returns whether a kind of joint has a scalar coordinate.
constexpr bool HasCoordinate(JointKind kind) noexcept {
  return RowOf(kind).coordinate != JointCoordinate::kNone;
}

/// Returns whether the coordinate of a kind of joint is an angle.
constexpr bool IsAngle(JointKind kind) noexcept {
  return RowOf(kind).coordinate == JointCoordinate::kAngle;
}

}  // namespace taut
