/// Search for an equilibrium by Newton's method in a trust region, or by dynamic relaxation
/// (docs/theory/statics.md, section 4).
#pragma once

#include "analysis/structure.h"

namespace taut::analysis {

/// State of a search: placement, reactions and residual.
struct Search {
  Placement at;
  Reactions holding;
  double left_n = 0;     ///< Largest component of the unbalanced force; torques are divided by the
                         ///< body's reach.
  double apart_m = 0;    ///< Largest violation of a constraint or contact.
  double largest_n = 0;  ///< Largest member force, load or reaction.
  int iterations = 0;    ///< Number of linear systems solved.
  bool balanced = false;
  bool runs_away = false;  ///< Whether a body has moved by more than 1000 times the structure's
                           ///< size.
};

struct SearchLimits {
  double tolerance = 1e-9;
  int most_iterations = 500;
};

/// Minimizes the augmented Lagrangian of energy, constraints and contacts by Newton's method in a
/// trust region. Starts at `search.at` and `search.holding`.
void Minimise(const Structure& structure, const SearchLimits& limits, Search& search);

/// Approaches the equilibrium by dynamic relaxation: starts at rest and zeroes velocities at each
/// peak of the kinetic energy. All masses are scaled to the stiffness. Converges from poor starts,
/// but with low accuracy; call `Minimise` afterwards.
void Relax(const Structure& structure, int steps, Search& search);

}  // namespace taut::analysis
