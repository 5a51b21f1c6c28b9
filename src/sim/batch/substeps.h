/// Substeps for stiff cables that touch edges or rods, and for stiff cables with little damping in
/// a group with fixed directions (docs/theory/cables.md, section 3).
#pragma once

#include "sim/data/tables.h"

namespace taut::sim {

/// Maximum number of substeps of a step.
inline constexpr int kMostSubsteps = 100;
/// Largest h^2 K of a substep. At this value, the energy of an explicit spring oscillates by up to
/// a quarter of this value, relative to its mean (docs/theory/cables.md, eq. 11a).
inline constexpr double kSubstepSpring = 0.05;

struct SubstepRule {
  double rate_per_s = 0;  ///< Required substeps per second; 0: none.
  int cable = -1;         ///< Index of the stiffest cable that needs substeps; -1: none.

  int CountOf(double step_s) const noexcept;
  /// Returns whether CountOf(step_s) substeps suffice.
  bool IsEnough(double step_s) const noexcept;
};

/// Returns the substep rule of a model. The rule depends on masses, stiffnesses and dampings of the
/// model, not on parameters of a world.
SubstepRule SubstepRuleOf(const Tables& tables);

}  // namespace taut::sim
