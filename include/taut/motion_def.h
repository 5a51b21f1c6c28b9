/// Kinematic bodies, such as turntables, shakers and lifted platforms: their pose is a given
/// function of time, independent of forces (docs/theory/motion.md).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "taut/types.h"

namespace taut {

/// Time law of one coordinate: the integral of `speed` plus a sine; 0 and at rest until t = 0
/// (docs/theory/motion.md, eq. 1).
struct TimeLaw {
  /// Points (time [s], speed): linear interpolation, constant before the first and after the last.
  /// Times are >= 0 and increase. Empty: speed 0.
  std::vector<std::pair<double, double>> speed;
  /// Sine term: amplitude (sin(2 pi frequency t + phase) - sin(phase)).
  double amplitude = 0.0, frequency_hz = 0.0, phase_rad = 0.0;
};

/// Motion of a kinematic body: rotation about an axis through a point, and translation of this
/// point along a direction.
struct MotionDef {
  std::string name;
  int body = 0;                   ///< The body must be `fixed`, so that only this motion moves it.
  Vec3 direction{0.0, 0.0, 1.0};  ///< Unit vector in W.
  TimeLaw slide;                  ///< Displacement along `direction` [m]; `speed` in m/s.
  Vec3 axis{0.0, 0.0, 1.0};       ///< Unit vector in W.
  Vec3 center_m;                  ///< Point on the axis at t = 0; it moves with the body.
  TimeLaw turn;                   ///< Angle about `axis` [rad]; `speed` in rad/s.
};

}  // namespace taut
