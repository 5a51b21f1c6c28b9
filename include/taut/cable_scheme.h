/// Time integration schemes of cables: explicit and implicit (docs/theory/cables.md, section 3).
#pragma once

#include <vector>

#include "taut/world_batch.h"

namespace taut {

enum class CableScheme {
  kExplicit,  ///< Soft cable: explicit force.
  /// Stiff cable with wheels, edges, friction, a direct-current motor, a kinematic body, or a joint
  /// that slides or has stops, friction or springs in its group: implicit tension along fixed
  /// directions, taken at the middle of the step. (12) limits the tension (`kStatusStepTooLong`).
  kAlong,
  kImplicit,  ///< Implicit in tension and direction: any stiffness and tension; conserves energy.
  /// kImplicit with a second stage, which damps vibrations that the step does not resolve; without
  /// joints.
  kImplicitDamped
};

/// Returns the name of a scheme in the output of `taut check`.
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

/// Returns the number of equal parts into which each step of `step_s` > 0 is divided. It is 1
/// unless stiff cables of the model can touch edges or rods, or have less than 5 % of the critical
/// damping in a group that would be `kAlong`. It depends only on the step and on the model, and is
/// at most 100; if that is not enough, the world has the status `kStatusStepTooLong`.
int SubstepCount(const Model& model, double step_s);

/// Returns the scheme of each cable at steps of `step_s` > 0. It depends only on the step and on
/// the model's masses, stiffnesses and dampings, never on the state.
std::vector<CableScheme> CableSchemes(const Model& model, double step_s);

}  // namespace taut
