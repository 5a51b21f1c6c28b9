/// Terrain elements that consist of many boxes: scattered blocks and stairs.
#pragma once

#include <vector>

#include "description/model/surface_keys.h"

namespace taut::description {

struct RegionForm {
  static constexpr const char* kSchema =
      R"("type": "array", "title": "[[x, y, z], [x, y, z]]", "items": {"$ref": "#/$defs/vector"}, )"
      R"("minItems": 2, "maxItems": 2)";
};

struct ScatterText {
  int count = 0, seed = 1;
  Raw<RegionForm> within;
  Vec3 low_m, high_m;  ///< Corners of the region `within`.
  Vec3 box_m;
  SurfaceText surface;
  Material material;
};
struct StairsText {
  int steps = 0;
  double width_m = 0.0, tread_m = 0.0, rise_m = 0.0;
  Vec3 at_m;
  Quat rotate;
  SurfaceText surface;
  Material material;
};

/// Limit of boxes in the whole terrain. A resolved experiment with more boxes would be too large to
/// read back.
inline constexpr int kMostBoxes = 5000;

template <class Io>
void Keys(Io& io, Like<ScatterText> auto& s) {
  io.Map("scatter", "terrain.scatter",
         "Fixed upright blocks of equal size, at random positions and headings. Block i, from 0, "
         "is named NAME_i.",
         R"({"count": 500, "seed": 1, "within_m": [[-1, -1, 0], [1, 1, 0]], )"
         R"("box_m": [0.05, 0.05, 0.05]})");
  io("count", s.count, kNeeded, Bound{.least = 1, .most = kMostBoxes}, "Number of blocks.");
  io("seed", s.seed, Bound{.least = 0, .most = 2'147'483'647},
     "Seed of the positions. The x, y, z and heading of block i are uniformly distributed and "
     "drawn in this order from the generator Philox4x32-10 (docs/theory/sensors.md, Noise) with "
     "this seed as its key, stream 100 and index i. Positions are the same on all machines; if you "
     "increase `count`, the first blocks keep their positions.");
  io("within_m", s.within, kNeeded,
     "Two corners of the box that contains the blocks' centers, the corner with the smaller "
     "coordinates first. A "
     "coordinate that is equal in both corners is not random.",
     Example{"[[-1, -1, 0], [1, 1, 0]]"});
  io("box_m", s.box_m, kNeeded, Bound::kPositive,
     "Edge lengths of a block; the third is vertical.");
  SurfaceKeys(io, s.surface);
}
void Check(const MapReader& map, ScatterText& scatter);

template <class Io>
void Keys(Io& io, Like<StairsText> auto& s) {
  io.Map("stairs", "terrain.stairs",
         "Fixed stairs that rise along x: adjacent boxes, one per step, each from the foot's "
         "height up to its tread. The lowest box is named NAME_0, the next NAME_1.",
         R"({"steps": 10, "width_m": 0.2, "tread_m": 0.05, "rise_m": 0.01, "at_m": [0.5, 0, 0]})");
  io("steps", s.steps, kNeeded, Bound{.least = 1, .most = kMostBoxes}, "Number of steps.");
  io("width_m", s.width_m, kNeeded, Bound::kPositive, "Width of the stairs.");
  io("tread_m", s.tread_m, kNeeded, Bound::kPositive, "Depth of a step, along x.");
  io("rise_m", s.rise_m, kNeeded, Bound::kPositive, "Rise from step to step.");
  io("at_m", s.at_m, "Foot: the middle of the lower edge of the first step.");
  io("rotate", s.rotate, "Rotation about the foot. Default: rising along the world's x.");
  SurfaceKeys(io, s.surface);
}
void Check(const MapReader& map, StairsText& stairs);

/// Return the boxes without names.
std::vector<TerrainBoxDef> Boxes(const ScatterText& scatter);
std::vector<TerrainBoxDef> Boxes(const StairsText& stairs);

}  // namespace taut::description
