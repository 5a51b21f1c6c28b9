/// Bodies that move as a program says, whatever pushes them: turntables, shakers, lifted platforms
/// (docs/theory/motion.md).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "taut/types.h"

namespace taut {

/// How one coordinate of a motion goes with time t: it is 0 and at rest until t = 0, and from then
/// on the integral of `speed` and a sine (motion.md, eq. 1).
struct TimeLaw {
  /// Points (time [s], speed) with straight lines between them; constant before the first and after
  /// the last. Times rise and are >= 0. Empty: 0.
  std::vector<std::pair<double, double>> speed;
  /// amplitude (sin(2 pi frequency t + phase) - sin(phase)).
  double amplitude = 0.0, frequency_hz = 0.0, phase_rad = 0.0;
};

/// A body that is moved: turned about an axis through a point that slides along a direction.
struct MotionDef {
  std::string name;
  int body = 0;                   ///< Must be `fixed`: nothing else moves it.
  Vec3 direction{0.0, 0.0, 1.0};  ///< Unit vector in W.
  TimeLaw slide;                  ///< [m], [m/s]
  Vec3 axis{0.0, 0.0, 1.0};       ///< Unit vector in W.
  Vec3 center_m;                  ///< A point of the axis at t = 0; slides along.
  TimeLaw turn;                   ///< [rad], [rad/s]
};

}  // namespace taut
