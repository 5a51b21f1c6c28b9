/// Friction that is more than two coefficients a pair: by speed, by direction, by a class of the
/// user's (docs/theory/friction.md). A contact is asked about once, before it is solved, in scalar
/// code that every instruction set calls.
#pragma once

#include "sim/data/view.h"

namespace taut::sim {

/// A contact that moves faster than this along its surface slides, a slower one sticks [m/s].
inline constexpr double kSlidingMPerS = 1e-6;

/// A contact whose surfaces have directions has this as its `frame`, and more: like no other, and
/// no plane's.
inline constexpr double kFirstDirectedFrame = kMaxPlanes;

/// A contact of one lane, in W. What is asked:
struct SlidingContact {
  double key;
  int world;
  double time_s;
  double point[3], normal[3];
  double slip[3];               ///< Of A against B: expected mean over the step [m/s].
  double before[3];             ///< The same at its start.
  double free[3];               ///< The same at its end, if nothing touched.
  double force[3];              ///< On A, in the step before [N].
  double turn_a[9], turn_b[9];  ///< R_WP of the bodies, by rows; B's only if it moves.
  bool b_moves;

  // What is answered. In the direction in which it is most:
  double static_friction, kinetic_friction;
  bool lost;                   ///< The user's law has no finite answer: that world is to halt.
  bool directed;               ///< Then also:
  double along[3], across[3];  ///< Directions, as long as the share of the friction there.
};

void FrictionOf(const View& m, SlidingContact& c) noexcept;

}  // namespace taut::sim
