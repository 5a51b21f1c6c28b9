/// Random variation of worlds (domain randomization).
#pragma once

#include "math/random.h"
#include "taut/spec.h"

namespace taut::rollout {

/// Draws factors within the given shares and adds them, and the noise of the start, to a world.
void Vary(const VariationSpec& by, math::Random random, RolloutWorld& world);

}  // namespace taut::rollout
