/// How steps integrate cables (docs/theory/cables.md, section 3).
#pragma once

#include <vector>

#include "taut/batch.h"

namespace taut {

enum class CableScheme {
  kExplicit,  ///< Soft: an explicit force.
  /// Stiff, with wheels, edges, friction, a direct-current motor, joints or a motion in its group:
  /// implicit along itself, with the directions of the middle of the step. Undamped cables across
  /// which a body moves may gain energy, and (12) limits the tension (`kStatusStepTooLong`).
  kAlong,
  kImplicit,  ///< Implicit with its directions: any stiffness and tension, energy is conserved.
  /// The same with a second stage, that lets damped vibrations die which the step does not resolve.
  kImplicitDamped
};

/// The scheme of each cable of a world with the model's masses, stiffnesses and dampings, at steps
/// of `step_s` > 0. It follows from these alone, never from the state.
std::vector<CableScheme> CableSchemes(const Model& model, double step_s);

}  // namespace taut
