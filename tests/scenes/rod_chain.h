/// Chain of rods on ball joints.
#pragma once

#include "tests/scenes/rod.h"

namespace taut::scenes {

/// Returns `rods` of 1 kg in a row from the origin along `step_m`, the first of them pinned there,
/// the last one with a different mass. They do not collide.
inline ModelDef RodChain(int rods, const Vec3& step_m, double last_mass_kg) {
  ModelDef def;
  Vec3 at;
  for (int i = 0; i < rods; ++i) {
    const std::string number = std::to_string(i);
    const Vec3 next{at.x + step_m.x, at.y + step_m.y, at.z + step_m.z};
    const double mass = i + 1 == rods ? last_mass_kg : 1.0;
    AddRod(def, "rod" + number, mass, 0.01, at, next, {});
    def.capsules.back().collides = false;
    JointDef joint;
    joint.name = "joint" + number, joint.body_a = i - 1, joint.body_b = i;
    joint.from_m = joint.to_m = at;
    def.joints.push_back(joint);
    at = next;
  }
  return def;
}

}  // namespace taut::scenes
