/// Time integration schemes of cables: explicit and implicit (docs/theory/cables.md, section 3).
#pragma once

#include <vector>

#include "taut/world_batch.h"

namespace taut {

enum class CableScheme {
  kExplicit,  ///< Soft cable: explicit force.
  /// Stiff cable: implicit tension along fixed directions, taken at the middle of the step. Used
  /// for cables with wheels, edges, friction or a DC motor. Also used in groups with a kinematic
  /// body, or with a joint that slides or has limits, friction or springs. Eq. 12 limits the
  /// tension (`kStatusStepTooLong`).
  kAlong,
  /// Stiff cable, implicit in tension and direction. Valid for any stiffness and tension; conserves
  /// energy.
  kImplicit,
  /// kImplicit with a second stage that damps vibrations too fast for the step. Not used in groups
  /// with joints.
  kImplicitDamped
};

/// Returns the name of a scheme as printed by `taut check`.
constexpr const char* CableSchemeName(CableScheme scheme) noexcept {
  switch (scheme) {
    case CableScheme::kExplicit:
      return "explicit";
    case CableScheme::kAlong:
      return "fixed directions";
    case CableScheme::kImplicit:
      return "implicit";
    case CableScheme::kImplicitDamped:
      return "two stages";
  }
  return "";
}

/// Returns the number of equal substeps of each step of `step_s` > 0, from 1 to 100. The number
/// depends only on the step and the model. The number exceeds 1 only for stiff cables that can
/// touch edges or rods, or that have less than 5 % of critical damping in a group with scheme
/// `kAlong`. If 100 substeps are too few, the world has the status `kStatusStepTooLong`.
int SubstepCount(const Model& model, double step_s);

/// Returns the scheme of each cable at steps of `step_s` > 0. The schemes depend on the step and on
/// the masses, stiffnesses and dampings of the model, never on the state.
std::vector<CableScheme> CableSchemes(const Model& model, double step_s);

}  // namespace taut
