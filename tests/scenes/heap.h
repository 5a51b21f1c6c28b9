/// Random heaps: bodies that fall into a funnel onto each other, with indeterminate contact forces
/// and bodies held from several sides.
#pragma once

#include "tests/scenes/ball.h"
#include "tests/scenes/box.h"
#include "tests/scenes/chance.h"
#include "tests/scenes/rod.h"

namespace taut::scenes {

/// Adds the ground and four walls that lean outwards: at the height z they are 0.3 m + 0.3 z from
/// the center.
inline void AddFunnel(ModelDef& def, const Material& material) {
  AddGround(def, material);
  const double along = 1 / std::sqrt(1.09), up = 0.3 / std::sqrt(1.09);
  const Vec3 inwards[4] = {{along, 0, up}, {-along, 0, up}, {0, along, up}, {0, -along, up}};
  for (int i = 0; i < 4; ++i) {
    PlaneDef wall;
    wall.name = "wall_" + std::to_string(i);
    wall.normal = inwards[i];
    wall.point_m = {i == 0 ? -0.3 : i == 1 ? 0.3 : 0, i == 2 ? -0.3 : i == 3 ? 0.3 : 0, 0};
    wall.material = material;
    def.planes.push_back(wall);
  }
}

struct RodHeap {
  int rods = 20;
  std::uint64_t seed = 1;
  double friction = 0.5;
  double half_length_m = 0.2, radius_m = 0.01, mass_kg = 0.1;
  double first_m = 0.3, apart_m = 0.06;  ///< Height of the lowest rod, and distance to the next.

  ModelDef Def() const {
    ModelDef def;
    def.name = "rod_heap";
    const Material material{friction, friction, 0.0};
    AddFunnel(def, material);
    Chance chance(seed);
    for (int i = 0; i < rods; ++i) {
      // The slopes are so small that neighboring rods do not touch at the start.
      const double heading = chance.Within(-3.2, 3.2), slope = chance.Within(-0.09, 0.09);
      const Vec3 along = Scaled(half_length_m / std::sqrt(1 + slope * slope),
                                {std::cos(heading), std::sin(heading), slope});
      const Vec3 middle{chance.Within(-0.15, 0.15), chance.Within(-0.15, 0.15),
                        first_m + apart_m * i};
      AddRod(def, "rod_" + std::to_string(i), mass_kg, radius_m, Between(along, middle),
             Sum(middle, along), material);
    }
    return def;
  }
};

/// Balls and boxes of several sizes, alternating.
struct MixedHeap {
  int things = 20;
  std::uint64_t seed = 1;
  double friction = 0.5;
  double density_kg_per_m3 = 500;

  ModelDef Def() const {
    ModelDef def;
    def.name = "mixed_heap";
    const Material material{friction, friction, 0.0};
    AddFunnel(def, material);
    Chance chance(seed);
    for (int i = 0; i < things; ++i) {
      const Vec3 at{chance.Within(-0.15, 0.15), chance.Within(-0.15, 0.15), 0.2 + 0.14 * i};
      const std::string name = "thing_" + std::to_string(i);
      if (i % 2 == 0) {
        const double r = chance.Within(0.03, 0.06);
        AddBall(def, name, density_kg_per_m3 * 4.1887902047863905 * r * r * r, r, at, material);
      } else {
        const double x = chance.Within(0.03, 0.06), y = chance.Within(0.03, 0.06),
                     z = chance.Within(0.02, 0.04);
        const Quat q = Turn(chance.Direction(), chance.Within(-1, 1));
        AddBox(def, name, density_kg_per_m3 * 8 * x * y * z, {x, y, z}, at, q, material);
      }
    }
    return def;
  }
};

}  // namespace taut::scenes
