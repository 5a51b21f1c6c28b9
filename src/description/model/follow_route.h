/// Routed cables: eyelets, pulleys and drums along a pair's `route`.
#pragma once

#include "description/model/assembly.h"
#include "description/yaml/once.h"
#include "taut/model_def.h"

namespace taut::description {

/// Sets the attachments of `cable`: one per node of the pair, with friction and wheels, plus one on
/// the rim of each drum. Reports wheels around which the cable cannot run.
void FollowRoute(const PlacedPair& pair, const Assembly& assembly, CableDef& cable,
                 OncePerPlace& complain);

}  // namespace taut::description
