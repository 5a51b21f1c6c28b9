/// Friction laws with more than two coefficients per pair: dependent on speed or direction, or a
/// custom class (docs/theory/friction.md). These laws are evaluated once per contact before the
/// solver, in scalar code shared by all instruction sets.
#pragma once

#include "sim/data/view.h"

namespace taut::sim {

/// Speed along the surface above which a contact slides; below, it sticks [m/s].
inline constexpr double kSlidingMPerS = 1e-6;

/// Smallest `frame` of contacts whose surfaces have directions. Frames of other contacts and of
/// planes differ from it.
inline constexpr double kFirstDirectedFrame = kMaxPlanes;

/// Contact of one lane, in W. Inputs:
struct SlidingContact {
  double key;
  int world;
  double time_s;
  double point[3], normal[3];
  double slip[3];    ///< Expected mean tangential velocity of A relative to B over the step [m/s].
  double before[3];  ///< Tangential velocity at the start of the step.
  double free[3];    ///< Tangential velocity at the end of the step without contacts.
  double force[3];   ///< Contact force on A in the previous step [N].
  double turn_a[9], turn_b[9];  ///< Rotations R_WP of the bodies, row by row; of B only if B moves.
  bool b_moves;

  // Outputs, in the direction of largest friction:
  double static_friction, kinetic_friction;
  bool lost;      ///< The custom law returned a number that is not finite; the world must halt.
  bool directed;  ///< Whether `along` and `across` are valid.
  double along[3], across[3];  ///< Directions; their lengths are fractions of the friction.
};

void FrictionOf(const View& m, SlidingContact& c) noexcept;

}  // namespace taut::sim
