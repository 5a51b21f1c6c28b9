/// Substeps for stiff cables that touch edges or rods, or that have hardly any damping in a group
/// with fixed directions (docs/theory/cables.md, section 3).
#pragma once

#include "sim/data/tables.h"

namespace taut::sim {

/// Largest number of substeps of a step.
inline constexpr int kMostSubsteps = 100;
/// Largest h^2 K of a substep. The energy of an explicit spring then oscillates by up to a quarter
/// of this value, relative to its mean (docs/theory/cables.md, eq. 11a).
inline constexpr double kSubstepSpring = 0.05;

struct SubstepRule {
  double rate_per_s = 0;  ///< Substeps per second that these cables need; 0: none.
  int cable = -1;         ///< Index of the stiffest such cable; -1: none.

  int CountOf(double step_s) const noexcept;
  /// Returns whether CountOf(step_s) substeps suffice.
  bool IsEnough(double step_s) const noexcept;
};

/// Returns the rule of a model. It depends on the model's masses, stiffnesses and dampings, not on
/// parameters of a world.
SubstepRule SubstepRuleOf(const Tables& tables);

}  // namespace taut::sim
