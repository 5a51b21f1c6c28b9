/// Random variation of worlds (domain randomization).
#pragma once

#include "math/random.h"
#include "taut/spec.h"

namespace taut::rollout {

/// Draws random factors of parameters and random start noise, and adds them to a world.
void Vary(const VariationSpec& by, math::Random random, RolloutWorld& world);

}  // namespace taut::rollout
