/// Tables of kinematic bodies, compiled for stepping (docs/theory/motion.md).
#pragma once

namespace taut::sim {

/// From `t` on: speed `v` and distance covered `x`; the speed grows by `a`.
struct MotionKnot {
  double t = 0, v = 0, x = 0, a = 0;
};

/// A `TimeLaw`: knots, the first at t = 0, and a sine.
struct TimeLawTable {
  int first_knot = 0, knot_count = 0;
  double amplitude = 0, turns_per_s = 0, phase_turns = 0;
  double at_zero = 0;  ///< The sine's value at t = 0.
};

struct MotionTable {
  int body = 0;
  double direction[3] = {}, axis[3] = {}, center[3] = {};  ///< In W.
  double arm[3] = {};  ///< From the center to the body's origin at t = 0.
  TimeLawTable slide, turn;
};

}  // namespace taut::sim
