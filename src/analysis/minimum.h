/// Search for an equilibrium by Newton's method in a trust region, or by dynamic relaxation
/// (docs/theory/statics.md, section 4).
#pragma once

#include "analysis/structure.h"

namespace taut::analysis {

/// State of a search: placement, reactions and residual.
struct Search {
  Placement at;
  Reactions holding;
  double left_n = 0;     ///< Largest force on any motion; torques divided by the body's reach.
  double apart_m = 0;    ///< Largest violation of a constraint or a contact.
  double largest_n = 0;  ///< Largest force that takes part.
  int iterations = 0;    ///< Linear systems so far.
  bool balanced = false;
  bool runs_away = false;  ///< The structure moves away without end.
};

struct SearchLimits {
  double tolerance = 1e-9;
  int most_iterations = 500;
};

/// Minimizes the energy of members and loads plus an augmented Lagrangian of constraints and
/// contacts, starting at `search.at` and `search.holding`, by Newton's method in a trust region.
void Minimise(const Structure& structure, const SearchLimits& limits, Search& search);

/// Approaches the equilibrium by dynamic relaxation: starts at rest, with masses that suit the
/// stiffness, and zeroes velocities at each peak of the kinetic energy. Crude but robust; finish
/// with `Minimise`.
void Relax(const Structure& structure, int steps, Search& search);

}  // namespace taut::analysis
