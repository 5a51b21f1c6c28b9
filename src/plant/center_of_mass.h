/// Center of mass of a simulated robot.
#pragma once

#include "math/vec.h"
#include "taut/plant.h"

namespace taut::plant {

/// Returns the center of mass of bodies with masses mass(b) [kg] at place(b) [m].
template <class Mass, class Place>
Vec3 CenterOfMass(std::size_t body_count, const Mass& mass, const Place& place) {
  Vec3 sum;
  double mass_kg = 0;
  for (std::size_t b = 0; b < body_count; ++b) {
    const double m = mass(b);
    sum = sum + m * place(b);
    mass_kg += m;
  }
  return (mass_kg > 0 ? 1 / mass_kg : 0) * sum;
}

/// Returns the center of mass of all bodies of a lane [m], in W.
inline Vec3 CenterOfMass(const World& world, int lane, std::size_t body_count) {
  return CenterOfMass(
      body_count, [&](std::size_t b) { return world.BodyMass(lane, static_cast<int>(b)); },
      [&](std::size_t b) { return world.Body(lane, static_cast<int>(b)).position_m; });
}

}  // namespace taut::plant
