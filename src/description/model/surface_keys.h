/// Friction and restitution, as rods, spheres, boxes and terrain spell them.
#pragma once

#include "description/yaml/keys.h"
#include "taut/model_def.h"

namespace taut::description {

template <class Io>
void Keys(Io& io, Like<StribeckDef> auto& s) {
  io.Map("stribeck", "surface.stribeck",
         "Friction that falls from `static_friction` to `kinetic_friction` while the speed of "
         "sliding rises, and rises again with it (docs/theory/friction.md).",
         R"({"speed_m_per_s": 0.05})");
  io("speed_m_per_s", s.speed_m_per_s, kNeeded, Bound::kPositive,
     "Speed at which half of what friction at rest has more is gone.");
  io("viscous_friction_s_per_m", s.viscous_friction_s_per_m, Bound::kNonNegative,
     "What the coefficient gains per speed.");
}

template <class Io>
void Keys(Io& io, Like<FrictionDirections> auto& d) {
  io.Map("friction_directions", "surface.friction_directions",
         "Factors on the coefficients of friction, by the direction in which the surface slides "
         "over what it touches: scales, skates (docs/theory/friction.md).",
         R"({"forward": 0.5, "backward": 1.5})");
  io("forward", d.forward, Bound::kNonNegative, "Factor where it slides along `axis`.");
  io("backward", d.backward, Bound::kNonNegative, "Factor where it slides against `axis`.");
  io("sideways", d.sideways, Bound::kNonNegative,
     "Factor where it slides at right angles to `axis`.");
  io("axis", d.axis, kDirection, kInherited,
     "Where forward is: in the part's frame, of terrain in the world frame. Only rods may leave it "
     "out: from their first node to their second.");
}

template <class Io>
void Keys(Io& io, Like<Material> auto& m) {
  io("static_friction", m.static_friction, kResolvedOnly);
  io("kinetic_friction", m.kinetic_friction, kResolvedOnly);
  io("restitution", m.restitution, Bound::kFraction, "Newton's coefficient of restitution.");
  io("stribeck", m.stribeck);
  io("friction_directions", m.directions);
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
/// The material, with complaints about keys that do not go together. `has_axis`: what has the
/// surface has a direction of its own.
Material ToMaterial(const MapReader& map, const SurfaceText& surface, bool has_axis = false);

}  // namespace taut::description
