/// Readings of bodies and cables that `taut.Batch` and `taut.Simulation` share.
#pragma once

#include "text.h"

namespace taut::python {

/// Reading of all bodies, of shape (worlds, bodies, width).
struct BodyReading {
  const char* name;
  py::ssize_t width;
  void (*put)(const BodyState& state, double* to);
  const char* words;
};

inline constexpr BodyReading kBodyReadings[] = {
    {"body_position_m", 3, [](const BodyState& s, double* to) { Put(s.position_m, to); },
     "positions of the centers of mass, in W [m]"},
    {"body_orientation", 4,
     [](const BodyState& s, double* to) {
       const Quat& q = s.orientation;
       to[0] = q.w, to[1] = q.x, to[2] = q.y, to[3] = q.z;
     },
     "rotations from the initial orientations, as unit quaternions w, x, y, z, in W"},
    {"body_velocity_m_per_s", 3,
     [](const BodyState& s, double* to) { Put(s.velocity_m_per_s, to); },
     "velocities of the centers of mass, in W [m/s]"},
    {"body_angular_velocity_rad_per_s", 3,
     [](const BodyState& s, double* to) { Put(s.angular_velocity_rad_per_s, to); },
     "angular velocities, in W [rad/s]"}};

/// Reading of all cables, of shape (worlds, cables).
struct CableReading {
  const char* name;
  double CableState::*field;
  const char* words;
};

inline constexpr CableReading kCableReadings[] = {
    {"cable_length_m", &CableState::length_m,
     "path lengths between the ends of each cable, along all attachments [m]"},
    {"cable_rate_m_per_s", &CableState::rate_m_per_s, "rates of the cable lengths [m/s]"},
    {"rest_length_m", &CableState::rest_length_m, "rest lengths [m]"},
    {"tension_n", &CableState::tension_n,
     "tensions, spring and damper, as a load cell measures them [N]"},
    {"elastic_n", &CableState::elastic_n, "spring part of the tensions, max(0, k (l - L)) [N]"}};

}  // namespace taut::python
