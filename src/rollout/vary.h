/// How worlds are drawn that differ.
#pragma once

#include "math/random.h"
#include "taut/spec.h"

namespace taut::rollout {

/// Draws factors within the shares, and adds them and the starts' noise to a world.
void Vary(const VariationSpec& by, math::Random random, RolloutWorld& world);

}  // namespace taut::rollout
