/// Routed cables: eyelets, pulleys and drums along a pair's `route`.
#pragma once

#include "description/model/assembly.h"
#include "description/yaml/once.h"
#include "taut/model_def.h"

namespace taut::description {

/// Sets the attachments of `cable`, one per node of the pair, with friction and wheels; a drum adds
/// one attachment on its rim. Reports wheels that the cable cannot run around.
void FollowRoute(const PlacedPair& pair, const Assembly& assembly, CableDef& cable,
                 OncePerPlace& complain);

}  // namespace taut::description
