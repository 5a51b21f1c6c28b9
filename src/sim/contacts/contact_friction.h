/// Friction laws beyond two coefficients per pair: dependent on speed, on direction, or computed by
/// a class of the user (docs/theory/friction.md). Evaluated once per contact, before the solver, in
/// scalar code that every instruction set calls.
#pragma once

#include "sim/data/view.h"

namespace taut::sim {

/// Speed along the surface above which a contact slides; slower ones stick [m/s].
inline constexpr double kSlidingMPerS = 1e-6;

/// Least `frame` of contacts whose surfaces have directions: different from all other contacts' and
/// planes' frames.
inline constexpr double kFirstDirectedFrame = kMaxPlanes;

/// A contact of one lane, in W. Inputs:
struct SlidingContact {
  double key;
  int world;
  double time_s;
  double point[3], normal[3];
  double slip[3];    ///< Velocity of A relative to B along the surface: expected mean over the step
                     ///< [m/s].
  double before[3];  ///< The same at the start of the step.
  double free[3];    ///< The same at the end of the step, without contacts.
  double force[3];   ///< On A, in the previous step [N].
  double turn_a[9], turn_b[9];  ///< R_WP of the bodies, by rows; B's only if it moves.
  bool b_moves;

  // Outputs, in the direction of most friction:
  double static_friction, kinetic_friction;
  bool lost;                   ///< The user's law returned no finite number: the world must halt.
  bool directed;               ///< If so, also:
  double along[3], across[3];  ///< Directions; their lengths are the shares of the friction.
};

void FrictionOf(const View& m, SlidingContact& c) noexcept;

}  // namespace taut::sim
