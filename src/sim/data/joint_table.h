/// Tables of joints, compiled for the step (docs/theory/joints.md).
#pragma once

namespace taut::sim {

/// Coordinate g of a joint row; its rate is the velocity of the row. Rotations are multiplied by
/// `reach_m` of the joint, so that all coordinates are in meters.
enum class JointMeasure {
  kAlongAxis,  ///< Offset of b's point from a's point along the axis.
  kAcross1,
  kAcross2,   ///< This offset along the two directions normal to the axis.
  kDistance,  ///< Distance of the two points.
  kSwing1,
  kSwing2,  ///< Axis of b along the two directions normal to the axis of a.
  kTwist,   ///< First normal direction of b along the second of a.
  kAngle,   ///< Angle about the axis, including whole turns.
  kCone,    ///< Angle between the axis in a and the axis in b.
  kTurn1,   ///< Rotation vector from a to b: component along the axis of a.
  kTurn2,   ///< Rotation vector: components along the two directions normal to it.
  kTurn3,
};

/// Indices of the axes of a and b whose product is the coordinate of a swing or twist.
struct MeasuredAxes {
  int of_a = -1, of_b = -1;  ///< -1: the coordinate is no such product.
};
constexpr MeasuredAxes AxesOf(JointMeasure measure) noexcept {
  switch (measure) {
    case JointMeasure::kSwing1:
      return {1, 0};
    case JointMeasure::kSwing2:
      return {2, 0};
    case JointMeasure::kTwist:
      return {2, 1};
    default:
      return {};
  }
}

enum class JointRole {
  kHold,
  kLeast,
  kMost,
  kFriction,
  kTurnFriction,  ///< Three successive rows under one law (turn_friction.h).
  kSpring,
};

constexpr bool IsStop(JointRole role) noexcept {
  return role == JointRole::kLeast || role == JointRole::kMost;
}

struct JointRowTable {
  JointMeasure measure = JointMeasure::kAlongAxis;
  JointRole role = JointRole::kHold;
};

struct JointTable {
  int a = 0, b = 0;                             ///< Bodies; one may be the world.
  bool a_moves = false, b_moves = false;        ///< Impulses move the body.
  bool a_is_moved = false, b_is_moved = false;  ///< The body is kinematic.
  bool holds_point = false;  ///< Constrains all components of the vector between its points.
  double own_a_P[3] = {}, own_b_P[3] = {};    ///< Joint points in the frames of both bodies [m].
  double axes_a_P[9] = {}, axes_b_P[9] = {};  ///< Axis and two normal directions, one per row.
  double reach_m = 0;  ///< Radius that converts rotations to lengths: see JointMeasure.
  int first_row = 0, row_count = 0;  ///< Constrained rows are first.
  bool has_coordinate = false, has_angle = false;
  bool has_turn_spring = false;  ///< Ball joints only.
  JointMeasure coordinate = JointMeasure::kAlongAxis;
  // Joint limits, friction and spring of the coordinate, which is in meters; its forces are in N.
  double least = 0, most = 0, restitution = 0, friction = 0;
  double stiffness = 0, damping = 0, rest = 0;  ///< `rest` of a constrained distance: its length.

  /// Returns a body that impulses move.
  constexpr int moved_body() const noexcept { return b_moves ? b : a; }
};

}  // namespace taut::sim
