/// Stacks: each layer carries all layers above it.
#pragma once

#include "tests/scenes/ball.h"
#include "tests/scenes/box.h"
#include "tests/scenes/chance.h"
#include "tests/scenes/rod.h"

namespace taut::scenes {

/// Boxes that fall a centimeter onto each other, slightly displaced and rotated: the heavier the
/// load above, the less an edge may yield.
struct BoxStack {
  int boxes = 10;
  std::uint64_t seed = 1;
  double half_m = 0.05, mass_kg = 0.5;
  double aside_m = 0.02, turned_rad = 0.05;  ///< Largest values.
  Material material{0.6, 0.6, 0.0};

  ModelDef Def() const {
    ModelDef def;
    def.name = "box_stack";
    AddGround(def, material);
    Chance chance(seed);
    for (int i = 0; i < boxes; ++i) {
      const Vec3 at{chance.Within(-aside_m, aside_m), chance.Within(-aside_m, aside_m),
                    half_m + 0.01 + (2 * half_m + 0.01) * i};
      const Quat q = Turn(chance.Direction(), turned_rad);
      AddBox(def, "box_" + std::to_string(i), mass_kg, {half_m, half_m, half_m}, at, q, material);
    }
    return def;
  }
};

/// Layers of two logs, each across the layer below, like a log cabin.
struct LogPile {
  int layers = 10;
  std::uint64_t seed = 1;
  double half_length_m = 0.3, radius_m = 0.02, mass_kg = 0.5;
  double aside_m = 0.2;     ///< Distance of a log from the center.
  double crooked_m = 0.01;  ///< Largest lateral deviation of each end.
  Material material{0.5, 0.5, 0.0};

  ModelDef Def() const {
    ModelDef def;
    def.name = "log_pile";
    AddGround(def, material);
    Chance chance(seed);
    for (int i = 0; i < 2 * layers; ++i) {
      const double side = i % 2 == 0 ? -aside_m : aside_m, z = radius_m * (1 + 2 * (i / 2));
      const double one = side + chance.Within(-crooked_m, crooked_m),
                   other = side + chance.Within(-crooked_m, crooked_m);
      const bool along_x = i / 2 % 2 != 0;
      const Vec3 from = along_x ? Vec3{-half_length_m, one, z} : Vec3{one, -half_length_m, z};
      const Vec3 to = along_x ? Vec3{half_length_m, other, z} : Vec3{other, half_length_m, z};
      AddRod(def, "log_" + std::to_string(i), mass_kg, radius_m, from, to, material);
    }
    return def;
  }
};

/// A slab on three thin rods: light bodies between a heavy one and the ground.
struct SlabOnRods {
  double mass_ratio = 1e4;  ///< Mass of the slab over the mass of a rod.
  std::uint64_t seed = 1;   ///< Seed for the directions of the rods.
  double rod_kg = 0.01, rod_radius_m = 0.01;
  Material material{0.5, 0.5, 0.0};

  ModelDef Def() const {
    ModelDef def;
    def.name = "slab_on_rods";
    AddGround(def, material);
    Chance chance(seed);
    for (int i = 0; i < 3; ++i) {
      const double a = 2.0943951023931953 * i;  // 2 pi / 3
      const double heading = chance.Within(-0.3, 0.3);
      const Vec3 middle{0.2 * std::cos(a), 0.2 * std::sin(a), rod_radius_m};
      const Vec3 half{0.05 * std::cos(heading), 0.05 * std::sin(heading), 0};
      AddRod(def, "rod_" + std::to_string(i), rod_kg, rod_radius_m, Between(half, middle),
             Sum(middle, half), material);
    }
    const Vec3 half{0.3, 0.3, 0.05};
    AddBox(def, "slab", rod_kg * mass_ratio, half, {0, 0, 2 * rod_radius_m + half.z}, {}, material);
    return def;
  }
};

/// A wall of bricks, each on two of the course below, without mortar. Every brick is slightly
/// displaced, so that none lies quite flat.
struct BrickWall {
  int courses = 4, bricks = 4;  ///< Every other course has one brick less.
  std::uint64_t seed = 1;
  Vec3 half_m{0.1, 0.05, 0.03};
  double mass_kg = 1.8, off_m = 0.001;
  Material material{0.6, 0.6, 0.0};

  ModelDef Def() const {
    ModelDef def;
    def.name = "brick_wall";
    AddGround(def, material);
    Chance chance(seed);
    const double long_m = 2 * half_m.x + 0.004, high_m = 2 * half_m.z + 0.001;
    for (int course = 0; course < courses; ++course) {
      const int count = bricks - course % 2;
      for (int i = 0; i < count; ++i) {
        const Vec3 place{long_m * (i - 0.5 * (count - 1)), 0, half_m.z + high_m * course};
        const Vec3 off = chance.Jolt(off_m);
        const Quat q = Turn({0, 0, 1}, chance.Within(-0.01, 0.01));
        AddBox(def, "brick_" + std::to_string(course) + "_" + std::to_string(i), mass_kg, half_m,
               {place.x + off.x, place.y + off.y, place.z + 0.0005 + std::fabs(off.z) / 4}, q,
               material);
      }
    }
    return def;
  }
};

}  // namespace taut::scenes
