#include "sim/batch/named_shape.h"

namespace taut::sim {

using List = ShapeRef::List;

bool IsTerrain(const ShapeRef& ref) noexcept {
  return ref.list == List::kPlanes || ref.list == List::kTerrainBoxes ||
         ref.list == List::kHeightFields || ref.list == List::kTerrainMeshes;
}

std::string ShapeText(const ModelDef& def, const ShapeRef& ref) {
  const auto text = [&](const char* kind, const auto& shapes) {
    return std::string("the ") + kind + " \"" + shapes[static_cast<std::size_t>(ref.index)].name +
           '"';
  };
  switch (ref.list) {
    case List::kSpheres:
      return text("sphere", def.spheres);
    case List::kCapsules:
      return text("rod", def.capsules);
    case List::kBoxes:
      return text("box", def.boxes);
    case List::kHulls:
      return text("hull", def.hulls);
    case List::kTerrainBoxes:
      return text("terrain", def.terrain_boxes);
    case List::kPlanes:
      return text("terrain", def.planes);
    case List::kHeightFields:
      return text("terrain", def.height_fields);
    case List::kTerrainMeshes:
      return text("terrain", def.terrain_meshes);
  }
  return {};
}

}  // namespace taut::sim
