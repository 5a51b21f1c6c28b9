/// Tables of kinematic bodies, compiled for the step (docs/theory/motion.md).
#pragma once

namespace taut::sim {

/// Interval of constant acceleration `a` from time `t`, with initial speed `v` and position `x`.
struct MotionKnot {
  double t = 0, v = 0, x = 0, a = 0;
};

/// Compiled `TimeLaw`: intervals, the first at t = 0, and a sine.
struct TimeLawTable {
  int first_knot = 0, knot_count = 0;
  double amplitude = 0, turns_per_s = 0, phase_turns = 0;
  double at_zero = 0;  ///< Value of the sine at t = 0.
};

struct MotionTable {
  int body = 0;
  double direction[3] = {}, axis[3] = {}, center[3] = {};  ///< Vectors in W.
  double arm[3] = {};  ///< Vector from the center to the body's origin at t = 0.
  TimeLawTable slide, turn;
};

}  // namespace taut::sim
