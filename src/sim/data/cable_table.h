/// Tables of cables, wheels, slip places and touchable rods, compiled for stepping
/// (docs/theory/cables.md).
#pragma once

#include "math/cable_wheel.h"
#include "taut/model_def.h"

namespace taut::sim {

/// Limits of an ideal or limited actuator; motors: MotorTable.
struct LimitTable {
  ActuatorDef::Kind kind = ActuatorDef::Kind::kNone;
  double max_speed_m_per_s = 0, max_acceleration_m_per_s2 = 0, max_force_n = 0;
  double min_rest_length_m = 0, min_length_m = 0;
};

struct CableTable {
  int first_attachment = 0, attachment_count = 0;  ///< Points of its path.
  int first_wheel = 0, wheel_count = 0;
  int first_span = 0, span_count = 0;  ///< Cables with friction only.
  int first_slip = 0;                  ///< First slip place, between the spans.
  int first_link = 0, link_room = 0;   ///< Links of its spans to bodies.
  bool clamped_damping = false;
  bool joins_two = false;  ///< Two attachments, on two different bodies, neither of them the world.
  int motor = -1;          ///< Index of its direct-current motor; -1: none.
  int touch = -1;          ///< Index in View::touches; -1: touches nothing.
  LimitTable actuator;
  double inv_max_speed = 0;  ///< 1 / actuator.max_speed_m_per_s [s/m].
};

/// A cylinder that a cable wraps around. Two successive attachments of its body represent it in the
/// cable's path: where the cable arrives and where it leaves.
struct WheelTable {
  int at = 0;                          ///< Index of the first of the two in the cable's path.
  int center_spot = 0, axis_spot = 0;  ///< Two points on the axis, 1 m apart.
  int mark_spot = -1;  ///< 1 m from the center, across the axis; with friction only.
  double radius_m = 0;
  double start_angle = 0;  ///< See math/cable_wheel.h [rad].
};

/// A place where a cable with capstan friction may slip: an eyelet, a wheel or a bend.
struct SlipTable {
  int at = 0;      ///< Point of its path; wheels: where the cable arrives; unused for bends.
  int wheel = -1;  ///< Index among all wheels; -1: an eyelet or a bend.
  double friction = 0;
  double start_place = kNotHeld;  ///< See cable_chains.inl [rad]; bends: kNotHeld.
};

/// A cable with cable wrapping around edges of the terrain or rods that it meets (cable_bends.inl).
/// It has two attachments.
struct TouchTable {
  int cable = 0;
  int first_bend = 0;  ///< First of its kMostBends bends.
  double radius_m = 0;
  bool terrain = false;              ///< Whether it touches edges of the terrain.
  double friction = 0;               ///< If positive, the cable has up to kMostBends + 1 spans.
  int first_rod = 0, rod_count = 0;  ///< Rods that it may touch.
};

/// A rod that such a cable may touch.
struct TouchRodTable {
  int shape = 0, body = 0;  ///< Impulses move the body.
  double center_P[3] = {}, axis_P[3] = {};
  double half_m = 0, radius_m = 0;  ///< Half length; distance of the axis from a cable's middle.
};

inline constexpr int kMostBends = CableDef::kMostBends;

}  // namespace taut::sim
