// Checks of surface keys: friction and restitution.
#include "description/model/surface_keys.h"

namespace taut::description {

namespace {

void CheckLaws(const MapReader& map, const Material& material, bool has_axis) {
  if (material.stribeck && material.static_friction == material.kinetic_friction &&
      material.stribeck->viscous_friction_s_per_m == 0.0) {
    map.Error("friction.stribeck_without_effect", "stribeck",
              map.Path("stribeck") + " has no effect",
              "give static_friction above kinetic_friction, or viscous_friction_s_per_m");
  }
  if (!material.directions || has_axis) return;
  const Vec3& axis = material.directions->axis;
  if (axis.x == 0.0 && axis.y == 0.0 && axis.z == 0.0) {
    map.Error("friction.axis_missing", "friction_directions",
              map.Path("friction_directions") + " needs an axis",
              "add one, such as `axis: [1, 0, 0]`: only rods have a default");
  }
}

}  // namespace

Material ToMaterial(const MapReader& map, const SurfaceText& surface, bool has_axis) {
  Material material = surface.material;
  if (map.Has("friction")) {
    material.static_friction = material.kinetic_friction = surface.friction;
    for (const char* other : {"static_friction", "kinetic_friction"}) {
      if (map.Has(other)) {
        map.Error("friction.given_twice", other, map.Path("friction") + " already sets " + other,
                  "give friction alone, or static_friction and kinetic_friction");
      }
    }
  } else if (surface.static_friction || surface.kinetic_friction) {
    if (!map.Require("static_friction") || !map.Require("kinetic_friction")) return material;
    material.static_friction = *surface.static_friction;
    material.kinetic_friction = *surface.kinetic_friction;
    if (material.static_friction < material.kinetic_friction) {
      map.Error("friction.static_below_kinetic", "static_friction",
                map.Path("static_friction") + " is below kinetic_friction",
                "static friction must be at least the kinetic friction");
    }
  }
  CheckLaws(map, material, has_axis);
  return material;
}

}  // namespace taut::description
