/// Routed cables: eyelets, pulleys and drums along a pair's `route`.
#pragma once

#include "description/model/assembly.h"
#include "description/yaml/once.h"
#include "taut/model_def.h"

namespace taut::description {

/// Completes the attachments of a routed cable, which has one per node: sets their friction and
/// wheels as in the `route`, and adds an end on the rim of each drum. Reports wheels around which
/// the cable cannot run.
void FollowRoute(const PlacedPair& pair, const Assembly& assembly, CableDef& cable,
                 OncePerPlace& complain);

}  // namespace taut::description
