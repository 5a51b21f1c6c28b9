/// Joints, laid out for stepping (docs/theory/joints.md).
#pragma once

namespace taut::sim {

/// What a row of a joint measures: g, whose rate is the row's velocity. Turns are measured in
/// metres, by the joint's `reach_m`, so that all rows' velocities are ones.
enum class JointMeasure {
  kAlongAxis,  ///< How far b's point is from a's along the axis,
  kAcross1,
  kAcross2,   ///< and along the two directions across it.
  kDistance,  ///< How far in all.
  kSwing1,
  kSwing2,  ///< The axis in b along the two directions across that in a.
  kTwist,   ///< b's first direction along a's second.
  kAngle,   ///< The angle about the axis, with turns.
  kCone,    ///< The angle between the axis in a and that in b.
  kTurn1,   ///< Of the turn from a to b as a vector, what is along a's axis
  kTurn2,   ///< and along the two directions across it.
  kTurn3,
};

enum class JointRole {
  kHold,
  kLeast,
  kMost,
  kFriction,
  kTurnFriction,  ///< Three rows, one behind the other: one law (turn_friction.h).
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
  int a = 0, b = 0;                             ///< Bodies; the world is one.
  bool a_moves = false, b_moves = false;        ///< By impulses;
  bool a_is_moved = false, b_is_moved = false;  ///< as a program says.
  bool holds_point = false;                     ///< All of the distance between its points.
  double own_a_P[3] = {}, own_b_P[3] = {};      ///< The points, each in its body's frame [m].
  double axes_a_P[9] = {}, axes_b_P[9] = {};    ///< Axis and two directions across it, one a row.
  double reach_m = 0;                           ///< Of turns: see JointMeasure.
  int first_row = 0, row_count = 0;             ///< Those that hold come first.
  bool has_coordinate = false, has_angle = false;
  bool has_turn_spring = false;  ///< Of a ball.
  JointMeasure coordinate = JointMeasure::kAlongAxis;
  // Of its coordinate, in metres of it; forces in N of that.
  double least = 0, most = 0, restitution = 0, friction = 0;
  double stiffness = 0, damping = 0, rest = 0;  ///< `rest` of a distance that is held: what it is.
};

}  // namespace taut::sim
