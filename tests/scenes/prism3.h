/// Three-strut prism, the simplest tensegrity in space. Its shape and its self-stress are known in
/// closed form (Connelly and Terrell 1995; docs/theory/statics.md): the upper triangle is rotated
/// by 150 degrees from one end of a strut to the other, and the force densities of strut, side
/// cable and triangle cable are as -1 : 1 : 1 / sqrt(3).
#pragma once

#include <array>

#include "tests/scenes/rod.h"

namespace taut::scenes {

struct Prism3 {
  double radius_m = 0.1;  ///< Radius of the circles through the triangles' corners.
  double height_m = 0.2;
  double rod_mass_kg = 0.05;
  double rod_radius_m = 0.004;
  double stiffness_n_per_m = 1000;
  double damping_n_s_per_m = 0;
  double force_density_n_per_m = 100;  ///< Tension / length of the side cables.
  double clearance_m = 0.0;            ///< Height of the lowest points above the ground.
  Material material{0.5, 0.5, 0.0};

  /// Returns three rods; cables bottom_0..2, top_0..2, side_0..2.
  ModelDef Def() const {
    ModelDef def;
    def.name = "prism3";
    const double low = clearance_m + rod_radius_m, pi = 3.14159265358979323846;
    std::array<Vec3, 3> bottom, top;
    for (int i = 0; i < 3; ++i) {
      const double a = 2 * pi / 3 * i, b = a + 5 * pi / 6;
      const auto k = static_cast<std::size_t>(i);
      bottom[k] = {radius_m * std::cos(a), radius_m * std::sin(a), low};
      top[k] = {radius_m * std::cos(b), radius_m * std::sin(b), low + height_m};
      AddRod(def, "strut_" + std::to_string(i), rod_mass_kg, rod_radius_m, bottom[k], top[k],
             material);
    }
    const double side = force_density_n_per_m, triangle = side / std::sqrt(3.0);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      Cable(def, "bottom_" + std::to_string(i), i, bottom, j, bottom, triangle);
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      Cable(def, "top_" + std::to_string(i), i, top, j, top, triangle);
    }
    // A side cable leads from a bottom corner to the top corner 30 degrees further, which belongs
    // to the previous strut.
    for (int i = 0; i < 3; ++i) {
      Cable(def, "side_" + std::to_string(i), i, bottom, (i + 2) % 3, top, side);
    }
    return def;
  }

 private:
  void Cable(ModelDef& def, const std::string& name, int a, const std::array<Vec3, 3>& from, int b,
             const std::array<Vec3, 3>& to, double density) const {
    const Vec3 &p = from[static_cast<std::size_t>(a)], &q = to[static_cast<std::size_t>(b)];
    const double length = LengthOf(Between(p, q));
    CableDef cable;
    cable.name = name;
    cable.attachments = {{a, p}, {b, q}};
    cable.stiffness_n_per_m = stiffness_n_per_m;
    cable.damping_n_s_per_m = damping_n_s_per_m;
    cable.rest_length_m = length - density * length / stiffness_n_per_m;
    def.cables.push_back(cable);
  }
};

}  // namespace taut::scenes
