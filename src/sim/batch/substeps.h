/// Substeps of models whose stiff cables have neither a straight path nor enough damping
/// (docs/theory/cables.md, section 3).
#pragma once

#include "sim/data/tables.h"

namespace taut::sim {

/// Largest number of substeps of a step.
inline constexpr int kMostSubsteps = 100;
/// h^2 K of a substep. The energy of an explicit spring oscillates by a quarter of it.
inline constexpr double kSubstepSpring = 0.05;

struct SubstepRule {
  double rate_per_s = 0;  ///< Substeps per time that make the cables soft.
  int cable = -1;         ///< The stiffest of them.

  int CountOf(double step_s) const noexcept;
  /// Returns whether the cables are soft after CountOf substeps.
  bool IsEnough(double step_s) const noexcept;
};

/// Returns the rule of a model: it depends on its masses, stiffnesses and dampings, not on
/// parameters of a world.
SubstepRule SubstepRuleOf(const Tables& tables);

}  // namespace taut::sim
