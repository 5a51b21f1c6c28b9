/// Tables of cables, wheels, slip points and obstacle rods, compiled for the step
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
  int first_attachment = 0, attachment_count = 0;  ///< Path points of the cable.
  int first_wheel = 0, wheel_count = 0;
  int first_span = 0, span_count = 0;  ///< Only for cables with friction.
  int first_slip = 0;                  ///< First slip point, between the spans.
  int first_link = 0, link_room = 0;   ///< Links of the spans to bodies.
  bool clamped_damping = false;
  /// Whether the cable has two attachments, on two different bodies other than the world.
  bool joins_two = false;
  int motor = -1;  ///< Index of the DC motor; -1: none.
  int touch = -1;  ///< Index in View::touches; -1: no wrapping around rods or terrain.
  LimitTable actuator;
  double inv_max_speed = 0;  ///< 1 / actuator.max_speed_m_per_s [s/m].
};

/// Cylinder around which a cable wraps. The path of the cable contains two successive attachments
/// to the body of the cylinder: the points where the cable reaches and leaves the cylinder.
struct WheelTable {
  int at = 0;                          ///< Path index of the first of these attachments.
  int center_spot = 0, axis_spot = 0;  ///< Two points on the axis, 1 m apart.
  int mark_spot = -1;  ///< Point 1 m from the center, normal to the axis; only with friction.
  double radius_m = 0;
  double start_angle = 0;  ///< See math/cable_wheel.h [rad].
};

/// Point at which a cable with capstan friction may slip: an eyelet, a wheel or a bend.
struct SlipTable {
  int at = 0;      ///< Path point; for wheels, where the cable reaches the wheel; unused for bends.
  int wheel = -1;  ///< Index among all wheels; -1: an eyelet or a bend.
  double friction = 0;
  /// Middle of the arc in the described pose (`MiddleOf`) [rad]; kNotHeld: no wheel.
  double start_place = kNotHeld;
};

/// Cable with wrapping around terrain edges or rods (cable_wrapping.inl). Such a cable has two
/// attachments.
struct TouchTable {
  int cable = 0;
  int first_bend = 0;  ///< Index of the first of its kMostBends bends.
  double radius_m = 0;
  bool terrain = false;              ///< Whether the cable wraps around terrain edges.
  double friction = 0;               ///< If positive, the cable has up to kMostBends + 1 spans.
  int first_rod = 0, rod_count = 0;  ///< Rods around which the cable may wrap.
};

/// Rod around which such a cable may wrap.
struct TouchRodTable {
  int shape = 0, body = 0;  ///< Impulses move the body.
  double center_P[3] = {}, axis_P[3] = {};
  /// Half the length of the rod; distance from its axis to the center line of a cable on the rod.
  double half_m = 0, radius_m = 0;
};

inline constexpr int kMostBends = CableDef::kMostBends;

}  // namespace taut::sim
