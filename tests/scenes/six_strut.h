/// Six-strut tensegrity (expanded octahedron): six equal struts in three parallel pairs and 24
/// cables, in its prestressed equilibrium: parallel struts are half a strut's length apart, all
/// cables are sqrt(3/8) of a strut long and have the same tension (docs/theory/statics.md).
#pragma once

#include <array>

#include "tests/scenes/rod.h"

namespace taut::scenes {

struct SixStrut {
  double length_m = 1.0;  ///< Length of a strut.
  double rod_mass_kg = 0.5;
  double rod_radius_m = 0.01;
  double stiffness_n_per_m = 1000;
  double damping_n_s_per_m = 0;
  double tension_n = 50;
  /// Distance of parallel struts over the strut's length; in equilibrium at 1/2 only. The rest
  /// lengths are the equilibrium's for any start.
  double spacing = 0.5;
  Vec3 center_m{0, 0, 1};
  Quat orientation;
  Material material{0.5, 0.5, 0.0};

  double cable_m() const { return std::sqrt(3.0 / 8) * length_m; }

  /// Struts 2 i and 2 i + 1 are parallel: to y, z, x for i = 0, 1, 2, apart along x, y, z.
  ModelDef Def() const {
    ModelDef def;
    def.name = "six_strut";
    std::array<std::array<Vec3, 2>, 6> ends;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t end = 0; end < 2; ++end) {
        const double away = (i % 2 == 0 ? -0.5 : 0.5) * spacing * length_m;
        const double along = (end == 0 ? -0.5 : 0.5) * length_m;
        const Vec3 p = i / 2 == 0   ? Vec3{away, along, 0}
                       : i / 2 == 1 ? Vec3{0, away, along}
                                    : Vec3{along, 0, away};
        ends[i][end] = Sum(center_m, Turned(orientation, p));
      }
      AddRod(def, "strut_" + std::to_string(i), rod_mass_kg, rod_radius_m, ends[i][0], ends[i][1],
             material);
    }
    // An end is connected to the four nearest ends of struts of other directions.
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t end = 0; end < 2; ++end) {
        for (std::size_t j = i + 1; j < 6; ++j) {
          for (std::size_t other = 0; other < 2; ++other) {
            const double distance = LengthOf(Between(ends[i][end], ends[j][other]));
            if (i / 2 != j / 2 && distance < 0.8 * length_m) {
              Cable(def, static_cast<int>(i), ends[i][end], static_cast<int>(j), ends[j][other]);
            }
          }
        }
      }
    }
    return def;
  }

 private:
  void Cable(ModelDef& def, int a, const Vec3& p, int b, const Vec3& q) const {
    CableDef cable;
    cable.name = "cable_" + std::to_string(def.cables.size());
    cable.attachments = {{a, p}, {b, q}};
    cable.stiffness_n_per_m = stiffness_n_per_m;
    cable.damping_n_s_per_m = damping_n_s_per_m;
    cable.rest_length_m = cable_m() - tension_n / stiffness_n_per_m;
    def.cables.push_back(cable);
  }
};

}  // namespace taut::scenes
