/// Where a simulated robot is as a whole.
#pragma once

#include "math/vec.h"
#include "taut/plant.h"

namespace taut::plant {

/// Of all bodies in a lane [m], in W.
inline Vec3 CenterOfMass(const World& world, int lane, std::size_t body_count) {
  Vec3 sum;
  double mass_kg = 0;
  for (std::size_t b = 0; b < body_count; ++b) {
    const double m = world.BodyMass(lane, static_cast<int>(b));
    sum = sum + m * world.Body(lane, static_cast<int>(b)).position_m;
    mass_kg += m;
  }
  return (mass_kg > 0 ? 1 / mass_kg : 0) * sum;
}

}  // namespace taut::plant
