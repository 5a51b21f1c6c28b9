/// Where a cable runs, as described.
#pragma once

#include "description/model/build.h"
#include "description/yaml/once.h"

namespace taut::description {

inline constexpr double kShortestLeg_m = 1e-9;  ///< A shorter leg has no direction.

/// `body_of_node`: null as long as it is not known; ends are then in the world.
struct CableSurroundings {
  const ModelText& model;
  const Assembly& assembly;
  const Assignment& assignment;
  const BodyOfNode* body_of_node;
};

/// Gives `cable` its attachments: at its nodes or on the surfaces there, and along its route.
/// Complains about ends that have nothing to be on, and about routes.
void ShapeCable(const CableSurroundings& in, const PlacedPair& pair, const CableText& builder,
                CableDef& cable, OncePerPlace& complain);

}  // namespace taut::description
