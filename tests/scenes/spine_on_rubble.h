/// Tetraspine3 with slack cables, dropped onto scattered boxes: its segments slide into each other
/// and rods touch rods, edges and corners.
#pragma once

#include "tests/scenes/chance.h"
#include "tests/scenes/tetraspine3.h"

namespace taut::scenes {

struct SpineOnRubble {
  int boxes = 12;
  std::uint64_t seed = 1;
  double slack = 1.25;  ///< Factor of the cables' rest lengths.
  double drop_m = 0.2;
  Material material{0.6, 0.6, 0.0};

  ModelDef Def() const {
    Tetraspine spine;
    spine.clearance_m = drop_m;
    spine.material = spine.ground = material;
    ModelDef def = spine.Def();
    def.name = "spine_on_rubble";
    def.friction_combine = CombineRule::kGeometricMean;
    for (CableDef& cable : def.cables) cable.rest_length_m *= slack;
    Chance chance(seed);
    for (int i = 0; i < boxes; ++i) {
      const Vec3 at{chance.Within(0.2, 1.1), chance.Within(-0.3, 0.3), chance.Within(0.0, 0.04)};
      const Quat q = Turn(chance.Direction(), chance.Within(-0.6, 0.6));
      const Vec3 half{chance.Within(0.04, 0.1), chance.Within(0.04, 0.1),
                      chance.Within(0.02, 0.05)};
      def.terrain_boxes.push_back({"box_" + std::to_string(i), at, q, half, material});
    }
    return def;
  }
};

}  // namespace taut::scenes
