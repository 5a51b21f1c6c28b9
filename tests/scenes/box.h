/// A solid box as a separate body.
#pragma once

#include "tests/scenes/solids.h"

namespace taut::scenes {

/// Appends a box with a node at its center; returns the body's index.
inline int AddBox(ModelDef& def, const std::string& name, double mass_kg, const Vec3& half_m,
                  const Vec3& center_m, const Quat& orientation, const Material& material) {
  const int index = static_cast<int>(def.bodies.size());
  BodyDef body;
  body.name = name;
  body.mass_kg = mass_kg;
  body.com_m = center_m;
  body.inertia_kg_m2 = TurnedInertia(BoxInertia(mass_kg, half_m), orientation);
  def.bodies.push_back(body);
  def.boxes.push_back({name, index, center_m, orientation, half_m, material});
  def.nodes.push_back({name, index, center_m});
  return index;
}

}  // namespace taut::scenes
