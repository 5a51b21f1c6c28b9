#include "description/surface_keys.h"

namespace taut::description {

Material ToMaterial(const MapReader& map, const SurfaceText& surface) {
  Material material = surface.material;
  if (map.Has("friction")) {
    material.static_friction = material.kinetic_friction = surface.friction;
    for (const char* other : {"static_friction", "kinetic_friction"}) {
      if (map.Has(other)) {
        map.Error(other, map.Path("friction") + " already says what " + other + " is",
                  "friction alone, or static_friction and kinetic_friction");
      }
    }
  } else if (surface.static_friction || surface.kinetic_friction) {
    if (!map.Require("static_friction") || !map.Require("kinetic_friction")) return material;
    material.static_friction = *surface.static_friction;
    material.kinetic_friction = *surface.kinetic_friction;
    if (material.static_friction < material.kinetic_friction) {
      map.Error("static_friction", map.Path("static_friction") + " is below kinetic_friction",
                "a contact that sticks holds at least as much as one that slides");
    }
  }
  return material;
}

}  // namespace taut::description
