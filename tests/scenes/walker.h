/// A robot with joints: a spine rod on four legs, with cables, on a plane.
#pragma once

#include <cmath>
#include <string>

#include "tests/scenes/rod.h"

namespace taut::scenes {

struct Walker {
  double friction = 0.5;  ///< Coulomb coefficient of the feet on the ground.
  double stiffness_n_per_m = 3000;

  /// Returns the robot at rest, feet just above the ground. Two hips are hinges with limits and
  /// friction, two are ball joints with friction and springs.
  ModelDef Def() const {
    ModelDef def;
    def.name = "walker";
    def.planes.push_back({"ground", {0, 0, 1}, {}, {friction, friction, 0}});
    const Vec3 back{-0.2, 0, 0.25}, front{0.2, 0, 0.25};
    AddRod(def, "spine", 0.5, 0.015, back, front, {friction, friction, 0});
    for (int i = 0; i < 4; ++i) {
      const std::string number = std::to_string(i);
      const double side = i % 2 == 0 ? 1.0 : -1.0;
      const Vec3 at = i < 2 ? front : back;
      const Vec3 hip{at.x, 0.06 * side, at.z};  // legs and spine do not touch
      const Vec3 foot{hip.x + 0.03, 0.12 * side, 0.021};
      const int leg = AddRod(def, "leg" + number, 0.1, 0.02, hip, foot, {friction, friction, 0});
      JointDef joint;
      joint.name = "hip" + number, joint.body_a = 0, joint.body_b = leg;
      joint.from_m = joint.to_m = hip;
      if (i < 2) {
        joint.kind = JointKind::kHinge;
        joint.axis = {0, 1, 0};
        joint.least = -0.4, joint.most = 0.4;
        joint.friction = 0.01;
      } else {
        joint.friction = 0.02, joint.stiffness = 0.5, joint.damping = 0.002;
      }
      def.joints.push_back(joint);
      for (const Vec3& end : {back, front}) {
        CableDef cable;
        cable.name = "cable" + std::to_string(def.cables.size());
        cable.attachments = {{0, end}, {leg, foot}};
        cable.stiffness_n_per_m = stiffness_n_per_m, cable.damping_n_s_per_m = 2;
        const Vec3 d{end.x - foot.x, end.y - foot.y, end.z - foot.z};
        cable.rest_length_m = 0.97 * std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
        def.cables.push_back(cable);
      }
    }
    return def;
  }
};

}  // namespace taut::scenes
