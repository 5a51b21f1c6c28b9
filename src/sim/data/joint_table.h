/// Tables of joints, compiled for stepping (docs/theory/joints.md).
#pragma once

namespace taut::sim {

/// Coordinate g of a joint's row; its rate is the row's velocity. Rotations are in meters,
/// multiplied by the joint's `reach_m`, so that all rows have velocities in m/s.
enum class JointMeasure {
  kAlongAxis,  ///< Offset of b's point from a's along the axis,
  kAcross1,
  kAcross2,   ///< and along the two directions across it.
  kDistance,  ///< Distance of the two points.
  kSwing1,
  kSwing2,  ///< Axis of b along the two directions across the axis of a.
  kTwist,   ///< b's first direction along a's second.
  kAngle,   ///< Angle about the axis, with whole turns.
  kCone,    ///< Angle between the axis in a and the axis in b.
  kTurn1,   ///< Turn vector from a to b: component along a's axis
  kTurn2,   ///< and along the two directions across it.
  kTurn3,
};

/// Axes of bodies a and b whose product is the coordinate of a swing or twist, as indices.
struct MeasuredAxes {
  int of_a = -1, of_b = -1;  ///< -1: the measure is no such product.
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
  bool a_moves = false, b_moves = false;        ///< Impulses move it;
  bool a_is_moved = false, b_is_moved = false;  ///< it is kinematic.
  bool holds_point = false;  ///< Holds all components of the distance between its points.
  double own_a_P[3] = {}, own_b_P[3] = {};    ///< The points, each in its body's frame [m].
  double axes_a_P[9] = {}, axes_b_P[9] = {};  ///< Axis and two directions across it, one per row.
  double reach_m = 0;  ///< Radius that converts rotations to meters: see JointMeasure.
  int first_row = 0, row_count = 0;  ///< Held rows come first.
  bool has_coordinate = false, has_angle = false;
  bool has_turn_spring = false;  ///< Ball joints only.
  JointMeasure coordinate = JointMeasure::kAlongAxis;
  // Joint limits, friction and spring of its coordinate, which is in meters; forces are in N along
  // it.
  double least = 0, most = 0, restitution = 0, friction = 0;
  double stiffness = 0, damping = 0, rest = 0;  ///< `rest` of a held distance: its length.

  /// A body that impulses move.
  constexpr int moved_body() const noexcept { return b_moves ? b : a; }
};

}  // namespace taut::sim
