/// A cable's route with what it runs over, as a model's pair says it.
#pragma once

#include "description/model/assembly.h"
#include "description/yaml/once.h"
#include "taut/model_def.h"

namespace taut::description {

/// Gives the attachments of `cable`, one a node of the pair, their friction and wheels; a drum gets
/// an attachment more, on its rim. Complains about wheels that a cable cannot go round.
void FollowRoute(const PlacedPair& pair, const Assembly& assembly, CableDef& cable,
                 OncePerPlace& complain);

}  // namespace taut::description
