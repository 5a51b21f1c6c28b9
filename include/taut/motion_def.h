/// Kinematic bodies: their pose is a given function of time, independent of forces, as for
/// turntables, shakers and lifted platforms (docs/theory/motion.md).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "taut/types.h"

namespace taut {

/// Time law of one coordinate of a motion: 0 and at rest until t = 0, then the integral of `speed`
/// plus a sine (docs/theory/motion.md, eq. 1).
struct TimeLaw {
  /// Points (time [s], speed), linear between them, constant before the first and after the last.
  /// Times increase and are >= 0. Empty: 0.
  std::vector<std::pair<double, double>> speed;
  /// Adds amplitude (sin(2 pi frequency t + phase) - sin(phase)).
  double amplitude = 0.0, frequency_hz = 0.0, phase_rad = 0.0;
};

/// Motion of a kinematic body: rotation about an axis through a point that slides along a
/// direction.
struct MotionDef {
  std::string name;
  int body = 0;                   ///< Must be `fixed`: only this motion moves it.
  Vec3 direction{0.0, 0.0, 1.0};  ///< Unit vector in W.
  TimeLaw slide;                  ///< [m], [m/s]
  Vec3 axis{0.0, 0.0, 1.0};       ///< Unit vector in W.
  Vec3 center_m;                  ///< Point of the axis at t = 0; slides with the body.
  TimeLaw turn;                   ///< [rad], [rad/s]
};

}  // namespace taut
