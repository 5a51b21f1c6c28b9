/// Single rods whose motion is dominated by friction.
#pragma once

#include "tests/scenes/ball.h"
#include "tests/scenes/rod.h"

namespace taut::scenes {

/// Painleve's rod: a thin rod that slides on its lower end. If it is steep and rough enough,
/// friction rotates it into the ground faster than the normal force can rotate it out, so that no
/// finite force is a solution; an impulse is.
struct PainleveRod {
  double angle_rad = 1.0;  ///< Angle above the ground; the upper end is towards -x.
  double friction = 1.0;
  double velocity_m_per_s = 3;  ///< Speed along x: against the rod's slant if positive.
  double length_m = 1, radius_m = 0.001, mass_kg = 1;

  ModelDef Def() const {
    ModelDef def;
    def.name = "painleve_rod";
    const Material material{friction, friction, 0.0};
    AddGround(def, material);
    AddRod(def, "rod", mass_kg, radius_m, {0, 0, radius_m},
           {-length_m * std::cos(angle_rad), 0, radius_m + length_m * std::sin(angle_rad)},
           material);
    def.bodies[0].velocity_m_per_s = {velocity_m_per_s, 0, 0};
    return def;
  }
};

/// A rod across a groove of two planes: held by friction alone at the angle at which it jams. Each
/// end touches one plane, and the force along the rod is indeterminate.
struct RodInWedge {
  double opening_rad = 0.8;  ///< Angle between the planes.
  double tilt_rad = 0.2;     ///< Tilt of the rod against the horizontal.
  double friction = 0.8;
  double length_m = 0.4, radius_m = 0.01, mass_kg = 0.1;

  ModelDef Def() const {
    ModelDef def;
    def.name = "rod_in_wedge";
    const Material material{friction, friction, 0.0};
    const double c = std::cos(opening_rad / 2), s = std::sin(opening_rad / 2);
    for (const double side : {-1.0, 1.0}) {
      PlaneDef plane;
      plane.name = side < 0 ? "left" : "right";
      plane.normal = {-side * c, 0, s};
      plane.material = material;
      def.planes.push_back(plane);
    }
    // The height of the center follows from the end that is nearer to its plane.
    const Vec3 half{0.5 * length_m * std::cos(tilt_rad), 0, 0.5 * length_m * std::sin(tilt_rad)};
    const double z = (radius_m + c * half.x) / s + std::fabs(half.z) + 0.001;
    const Vec3 middle{0, 0, z};
    AddRod(def, "rod", mass_kg, radius_m, Between(half, middle), Sum(middle, half), material);
    return def;
  }
};

}  // namespace taut::scenes
