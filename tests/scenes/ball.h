/// A solid ball above level ground.
#pragma once

#include "tests/scenes/solids.h"

namespace taut::scenes {

/// Appends a solid ball as a separate body; returns the body's index.
inline int AddBall(ModelDef& def, const std::string& name, double mass_kg, double radius_m,
                   const Vec3& center_m, const Material& material) {
  const int index = static_cast<int>(def.bodies.size());
  BodyDef body;
  body.name = name;
  body.mass_kg = mass_kg;
  body.com_m = center_m;
  body.inertia_kg_m2 = SphereInertia(mass_kg, radius_m);
  def.bodies.push_back(body);
  def.spheres.push_back({name, index, center_m, radius_m, material});
  def.nodes.push_back({name, index, center_m});
  return index;
}

/// Adds the ground z = 0.
inline void AddGround(ModelDef& def, const Material& material) {
  PlaneDef plane;
  plane.name = "ground";
  plane.material = material;
  def.planes.push_back(plane);
}

struct Ball {
  double mass_kg = 0.2;
  double radius_m = 0.1;
  double drop_m = 0.0;  ///< Height of its lowest point above the ground.
  Material material{0.5, 0.5, 0.0};

  ModelDef Def() const {
    ModelDef def;
    def.name = "ball";
    AddGround(def, material);  // geometric mean and maximum of equal coefficients are unchanged
    AddBall(def, "ball", mass_kg, radius_m, {0, 0, radius_m + drop_m}, material);
    return def;
  }
};

}  // namespace taut::scenes
