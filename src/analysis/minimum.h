/// The search for a placement in which everything balances (docs/theory/statics.md, section 4).
#pragma once

#include "analysis/structure.h"

namespace taut::analysis {

/// How far a search is: a placement, what holds it there, and what is left.
struct Search {
  Placement at;
  Reactions holding;
  double left_n = 0;     ///< The largest force on any motion, turns by their body's reach.
  double apart_m = 0;    ///< The largest violation of what is held or may not be entered.
  double largest_n = 0;  ///< Of all forces that take part.
  int iterations = 0;    ///< Linear systems so far.
  bool balanced = false;
  bool runs_away = false;  ///< It has left for good.
};

struct SearchLimits {
  double tolerance = 1e-9;
  int most_iterations = 500;
};

/// From `search.at` and `search.holding` on, by a trust region in the energy of members, loads and,
/// as an augmented Lagrangian, of what holds.
void Minimise(const Structure& structure, const SearchLimits& limits, Search& search);

/// The same by dynamic relaxation: from rest, with masses that suit the stiffness, all motion taken
/// out whenever its energy peaks. Crude and sure; `Minimise` has the last word.
void Relax(const Structure& structure, int steps, Search& search);

}  // namespace taut::analysis
