/// Friction and restitution, as rods, spheres, boxes and terrain spell them.
#pragma once

#include "description/keys.h"
#include "taut/model_def.h"

namespace taut::description {

template <class Io>
void Keys(Io& io, Like<Material> auto& m) {
  io("static_friction", m.static_friction, kResolvedOnly);
  io("kinetic_friction", m.kinetic_friction, kResolvedOnly);
  io("restitution", m.restitution, Bound::kFraction, "Newton's coefficient of restitution.");
}

/// `friction` alone, or the two others.
struct SurfaceText {
  double friction = Material{}.static_friction;
  std::optional<double> static_friction, kinetic_friction;
  Material material;
};
/// In the map of what has the surface.
template <class Io>
void SurfaceKeys(Io& io, Like<SurfaceText> auto& s) {
  io("friction", s.friction, Bound::kNonNegative,
     "Coulomb coefficient while sticking and while sliding. Instead of the two below.");
  io("static_friction", s.static_friction, Bound::kNonNegative,
     "Coulomb coefficient while sticking, not below `kinetic_friction`.");
  io("kinetic_friction", s.kinetic_friction, Bound::kNonNegative,
     "Coulomb coefficient while sliding.");
  Keys(io, s.material);
}
/// The material, with complaints about keys that do not go together.
Material ToMaterial(const MapReader& map, const SurfaceText& surface);

}  // namespace taut::description
