/// Path of a cable in the described pose.
#pragma once

#include "description/model/build.h"
#include "description/yaml/once.h"

namespace taut::description {

inline constexpr double kShortestLeg_m = 1e-9;  ///< Least length of a leg that has a direction.

/// Inputs of the path. `body_of_node`: null while it is unknown; ends are then in the world.
struct CableSurroundings {
  const ModelText& model;
  const Assembly& assembly;
  const Assignment& assignment;
  const BodyOfNode* body_of_node;
};

/// Sets the attachments of `cable`: at its nodes or on the surfaces there, and along its route.
/// Reports ends without a solid, and invalid routes.
void ShapeCable(const CableSurroundings& in, const PlacedPair& pair, const CableText& builder,
                CableDef& cable, OncePerPlace& complain);

}  // namespace taut::description
