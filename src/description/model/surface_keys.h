/// Keys of friction and restitution of rods, spheres, boxes and terrain.
#pragma once

#include "description/yaml/keys.h"
#include "taut/model_def.h"

namespace taut::description {

template <class Io>
void Keys(Io& io, Like<StribeckDef> auto& s) {
  io.Map(
      "stribeck", "surface.stribeck",
      "Stribeck friction: a coefficient that decreases from `static_friction` to "
      "`kinetic_friction` with the sliding speed, plus a viscous part (docs/theory/friction.md).",
      R"({"speed_m_per_s": 0.05})");
  io("speed_m_per_s", s.speed_m_per_s, kNeeded, Bound::kPositive,
     "Sliding speed at which the coefficient has fallen halfway from static to kinetic.");
  io("viscous_friction_s_per_m", s.viscous_friction_s_per_m, Bound::kNonNegative,
     "Increase of the coefficient per m/s of sliding speed.");
}

template <class Io>
void Keys(Io& io, Like<FrictionDirections> auto& d) {
  io.Map("friction_directions", "surface.friction_directions",
         "Anisotropic friction (scales, skates): factors on the coefficients by the direction in "
         "which the surface slides (docs/theory/friction.md).",
         R"({"forward": 0.5, "backward": 1.5})");
  io("forward", d.forward, Bound::kNonNegative, "Factor for sliding along `axis`.");
  io("backward", d.backward, Bound::kNonNegative, "Factor for sliding against `axis`.");
  io("sideways", d.sideways, Bound::kNonNegative, "Factor for sliding at right angles to `axis`.");
  io("axis", d.axis, kDirection, kInherited,
     "Forward direction, in the part's frame; for terrain, in the world frame. Default for rods: "
     "from the first node to the second; required elsewhere.");
}

template <class Io>
void Keys(Io& io, Like<Material> auto& m) {
  io("static_friction", m.static_friction, kResolvedOnly);
  io("kinetic_friction", m.kinetic_friction, kResolvedOnly);
  io("restitution", m.restitution, Bound::kFraction, "Newton's coefficient of restitution.");
  io("stribeck", m.stribeck);
  io("friction_directions", m.directions);
}

/// Surface as given in the file: `friction`, or both `static_friction` and `kinetic_friction`.
struct SurfaceText {
  double friction = Material{}.static_friction;
  std::optional<double> static_friction, kinetic_friction;
  Material material;
};
/// Keys in the map of the shape.
template <class Io>
void SurfaceKeys(Io& io, Like<SurfaceText> auto& s) {
  io("friction", s.friction, Bound::kNonNegative,
     "Coulomb friction coefficient, both static and kinetic, instead of the next two keys.");
  io("static_friction", s.static_friction, Bound::kNonNegative,
     "Static friction coefficient, not below `kinetic_friction`.");
  io("kinetic_friction", s.kinetic_friction, Bound::kNonNegative, "Kinetic friction coefficient.");
  Keys(io, s.material);
}
/// Returns the material and reports conflicting keys. `has_axis`: whether the shape has a
/// direction, which is the default axis of anisotropic friction.
Material ToMaterial(const MapReader& map, const SurfaceText& surface, bool has_axis = false);

}  // namespace taut::description
