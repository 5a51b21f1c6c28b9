/// Cables, laid out for stepping (docs/theory/cables.md).
#pragma once

#include "math/cable_wheel.h"
#include "taut/model_def.h"

namespace taut::sim {

/// What an actuator obeys in a step, but a motor.
struct LimitTable {
  ActuatorDef::Kind kind = ActuatorDef::Kind::kNone;
  double max_speed_m_per_s = 0, max_acceleration_m_per_s2 = 0, max_force_n = 0;
  double min_rest_length_m = 0, min_length_m = 0;
};

struct CableTable {
  int first_attachment = 0, attachment_count = 0;  ///< The points of its path.
  int first_wheel = 0, wheel_count = 0;
  int first_span = 0, span_count = 0;  ///< Of one with friction; without, it has none.
  int first_slip = 0;                  ///< Places between the spans.
  int first_link = 0, link_room = 0;   ///< For what its spans do to bodies.
  bool clamped_damping = false;
  bool joins_two = false;  ///< Two bodies that are not the world, and no more.
  int motor = -1;          ///< Which one winds it; -1: none.
  int touch = -1;          ///< Of those that touch what they come to, which; -1: it does not.
  LimitTable actuator;
  double inv_max_speed = 0;  ///< 1 / actuator.max_speed_m_per_s [s/m].
};

/// A cylinder that a cable goes round. Its two points among the attachments have its body.
struct WheelTable {
  int at = 0;                          ///< Of the two in its cable's path, the first.
  int center_spot = 0, axis_spot = 0;  ///< The axis goes from the one to the other, 1 m.
  int mark_spot = -1;                  ///< 1 m off the middle, across the axis; with friction only.
  double radius_m = 0;
  double start_angle = 0;  ///< (math/cable_wheel.h) [rad]
};

/// Where a cable with friction may slip.
struct SlipTable {
  int at = 0;      ///< Point of its path; of a wheel, where the cable arrives; of a bend none.
  int wheel = -1;  ///< Among all wheels; -1: an eyelet.
  double friction = 0;
  double start_place = kNotHeld;  ///< (cable_chains.inl) [rad]; of a bend none.
};

/// A cable that comes to lie against edges of the terrain or rods (cable_bends.inl). It has two
/// attachments.
struct TouchTable {
  int cable = 0;
  int first_bend = 0;  ///< Of kMostBends.
  double radius_m = 0;
  bool terrain = false;              ///< Edges of it.
  double friction = 0;               ///< With some it has spans, kMostBends + 1 at most.
  int first_rod = 0, rod_count = 0;  ///< Those that it may come to.
};

/// A rod as such a cable meets it.
struct TouchRodTable {
  int shape = 0, body = 0;  ///< The body moves.
  double center_P[3] = {}, axis_P[3] = {};
  double half_m = 0, radius_m = 0;  ///< To the middle of a cable on it.
};

inline constexpr int kMostBends = CableDef::kMostBends;

}  // namespace taut::sim
