/// Joints: what of one body's motion relative to another's is held, and what acts on the rest
/// (docs/theory/joints.md). A support is a joint with the world.
#pragma once

#include <optional>
#include <string>

#include "taut/member_def.h"
#include "taut/types.h"

namespace taut {

/// What a joint leaves free of the motion of its body b relative to its body a. `axis`, and two
/// directions across it, are fixed in a.
enum class JointKind {
  kBall,         ///< All turns.
  kHinge,        ///< Turns about the axis.
  kWeld,         ///< Nothing.
  kPrismatic,    ///< Sliding along the axis.
  kCylindrical,  ///< Sliding along the axis, and turns about it.
  kPlanar,       ///< Sliding across the axis, and turns about it.
  kLine,         ///< All turns; b's point slides along the axis through a's.
  kPlane,        ///< All turns; b's point slides in the plane through a's that is across the axis.
  kDistance,     ///< All but the distance of the two points.
};

/// A joint's coordinate, if it has one that is free: the angle of a hinge [rad], how far a
/// prismatic joint, a cylindrical one or a line has slid [m], the length of a distance [m]; of a
/// ball the angle between its axis in a and that in b [rad]. A slide is that from a's point to b's;
/// angles are 0 in the pose that is described, but for `turned`, and of a hinge count turns. Forces
/// are torques [N m] where it is an angle.
struct JointDef {
  /// Points that a joint holds together may be this far apart at first; the first step closes it.
  static constexpr double kClosed_m = 1e-6;

  std::string name;
  JointKind kind = JointKind::kBall;
  int body_a = kWorld, body_b = 0;  ///< b is a body; not both are fixed.
  Vec3 from_m, to_m;                ///< A point of a and one of b, in W.
  Vec3 axis{0.0, 0.0, 1.0};         ///< Unit vector in W.
  /// How b's axes are turned against a's, in W: not at all, but where a robot is described in
  /// another pose than that in which the axes are one.
  Quat turned;
  bool collides = false;  ///< Whether its bodies touch each other.

  // Of the coordinate:
  std::optional<double> least, most;  ///< Stops; of a ball `most` alone.
  double restitution = 0.0;           ///< Of the stops, 0..1.
  // Of the coordinate, too, but of a ball of all its turns, about every axis alike: of b's turn
  // against a, as a vector of up to half a turn, and of its rate.
  double friction = 0.0;                  ///< Largest dry friction, >= 0.
  double stiffness = 0.0, damping = 0.0;  ///< Of a spring and a damper, >= 0.
  double rest = 0.0;                      ///< Where the spring is at rest; of a ball 0.
  MemberDef member = {};                  ///< Of a bar.
  bool operator==(const JointDef&) const = default;
};

/// Whether it is an elastic bar: a distance with a spring, which pulls and pushes.
inline bool IsBar(const JointDef& j) noexcept {
  return j.kind == JointKind::kDistance && j.stiffness > 0.0;
}

/// Whether a distance joint holds its length: if nothing else says what that may be.
inline bool HoldsLength(const JointDef& j) noexcept {
  return !j.least && !j.most && j.stiffness == 0.0;
}

/// What a kind holds of b's motion against a. Of a distance nothing that has an axis.
struct HeldMotions {
  bool along = false;   ///< Sliding along the axis,
  bool across = false;  ///< and across it, in all directions.
  bool swing = false;   ///< Turns of the axis,
  bool twist = false;   ///< and about it.
};
constexpr HeldMotions HeldBy(JointKind kind) noexcept {
  switch (kind) {
    case JointKind::kBall:
      return {true, true, false, false};
    case JointKind::kHinge:
      return {true, true, true, false};
    case JointKind::kWeld:
      return {true, true, true, true};
    case JointKind::kPrismatic:
      return {false, true, true, true};
    case JointKind::kCylindrical:
      return {false, true, true, false};
    case JointKind::kPlanar:
      return {true, false, true, false};
    case JointKind::kLine:
      return {false, true, false, false};
    case JointKind::kPlane:
      return {true, false, false, false};
    case JointKind::kDistance:
      break;
  }
  return {};
}

/// How far the two points are apart in directions that the joint holds [m].
double HeldGap(const JointDef& joint) noexcept;

/// Two bodies that do not touch each other.
struct ApartDef {
  int body_a = 0, body_b = 0;
};

/// Whether one number says how far it has moved, or several have to.
inline bool HasCoordinate(JointKind kind) noexcept {
  return kind != JointKind::kWeld && kind != JointKind::kPlanar && kind != JointKind::kPlane;
}

/// Whether a joint's coordinate is an angle.
inline bool IsAngle(JointKind kind) noexcept {
  return kind == JointKind::kHinge || kind == JointKind::kBall;
}

}  // namespace taut
