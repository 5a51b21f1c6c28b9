/// Path of a cable in the described pose.
#pragma once

#include "description/model/build.h"
#include "description/yaml/once.h"

namespace taut::description {

inline constexpr double kShortestLeg_m = 1e-9;  ///< Shortest leg that defines a direction [m].

/// Inputs of a cable's path. If `body_of_node` is null (not known yet), all ends are in the world.
struct CableSurroundings {
  const ModelText& model;
  const Assembly& assembly;
  const Assignment& assignment;
  const BodyOfNode* body_of_node;
};

/// Sets the attachments of `cable`: at its nodes or on their surfaces, and along its route. Reports
/// ends without a surface, and invalid routes.
void ShapeCable(const CableSurroundings& in, const PlacedPair& pair, const CableText& builder,
                CableDef& cable, OncePerPlace& complain);

}  // namespace taut::description
