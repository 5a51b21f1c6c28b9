/// Time integration schemes of cables (docs/theory/cables.md, section 3).
#pragma once

#include <vector>

#include "taut/batch.h"

namespace taut {

enum class CableScheme {
  kExplicit,  ///< Soft: an explicit force.
  /// Stiff, with wheels, edges, friction, a direct-current motor, joints or a motion in its group:
  /// implicit tension, fixed directions (those of the middle of the step). Undamped cables may gain
  /// energy from transverse motion, and (12) limits the tension (`kStatusStepTooLong`).
  kAlong,
  kImplicit,  ///< Implicit in tension and direction: any stiffness and tension; conserves energy.
  /// kImplicit with a second stage: damped vibrations that the step does not resolve decay.
  kImplicitDamped
};

/// Returns the scheme of each cable for the model's masses, stiffnesses and dampings at steps of
/// `step_s` > 0. It depends on these alone, never on the state.
std::vector<CableScheme> CableSchemes(const Model& model, double step_s);

}  // namespace taut
