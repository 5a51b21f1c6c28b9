/// A rod: a slender cylinder, in collisions a capsule.
#pragma once

#include "tests/scenes/solids.h"

namespace taut::scenes {

/// Appends a rod as a separate body, with nodes `name`.from and `name`.to; returns the body's
/// index.
inline int AddRod(ModelDef& def, const std::string& name, double mass_kg, double radius_m,
                  const Vec3& from_m, const Vec3& to_m, const Material& material) {
  const int index = static_cast<int>(def.bodies.size());
  Parts parts;
  parts.AddCylinder(mass_kg, from_m, to_m, radius_m);
  def.bodies.push_back(parts.Body(name));
  def.capsules.push_back({name, index, from_m, to_m, radius_m, material});
  def.nodes.push_back({name + ".from", index, from_m});
  def.nodes.push_back({name + ".to", index, to_m});
  return index;
}

/// A rod in empty space without gravity.
struct FreeRod {
  double mass_kg = 0.02;
  double radius_m = 0.003;
  Vec3 from_m{-0.19, 0, 0}, to_m{0.19, 0, 0};
  Vec3 angular_velocity_rad_per_s;

  ModelDef Def() const {
    ModelDef def;
    def.name = "rod";
    def.gravity_m_per_s2 = {0, 0, 0};
    AddRod(def, "rod", mass_kg, radius_m, from_m, to_m, {});
    def.bodies[0].angular_velocity_rad_per_s = angular_velocity_rad_per_s;
    return def;
  }
};

}  // namespace taut::scenes
