// Overlaps of bodies at the start (docs/formats/checks.md).
#include <string>

#include "base/brief.h"
#include "plant/find_start.h"
#include "sim/batch/named_shape.h"
#include "taut/start.h"

namespace taut {
namespace plant {
namespace {

using base::Brief;
using List = ShapeRef::List;

/// Overlaps up to this depth count as contact, as a share of the half thickness.
constexpr double kTouching = 0.01;

/// Returns the file position of the terrain involved, or else of the body.
SourceRef PlaceOf(const RobotSpec& robot, const Overlap& overlap) {
  const auto at = [](const std::vector<SourceRef>& sources, int index) {
    const auto i = static_cast<std::size_t>(index);
    return index >= 0 && i < sources.size() ? sources[i] : SourceRef{};
  };
  if (overlap.b.list == List::kPlanes) return at(robot.plane_sources, overlap.b.index);
  if (overlap.b.list == List::kTerrainBoxes) return at(robot.terrain_box_sources, overlap.b.index);
  if (overlap.b.list == List::kHeightFields) return at(robot.height_field_sources, overlap.b.index);
  if (overlap.b.list == List::kTerrainMeshes) return at(robot.mesh_sources, overlap.b.index);
  return at(robot.body_sources, overlap.body_a);
}

}  // namespace

bool CheckOverlaps(const RobotSpec& robot, const WorldBatch& batch, bool terrain, bool warn,
                   Diagnostics& out) {
  bool good = true;
  for (const Overlap& overlap : batch.Overlaps(kTheWorld)) {
    const bool with_terrain = sim::IsTerrain(overlap.b);
    if (with_terrain && !terrain) continue;
    const bool deep = overlap.depth_m > overlap.half_thickness_m;
    if (!deep && (!warn || overlap.depth_m <= kTouching * overlap.half_thickness_m)) continue;
    const std::string a = sim::ShapeText(robot.def, overlap.a),
                      b = sim::ShapeText(robot.def, overlap.b);
    const std::string depth = Brief(overlap.depth_m) + " m";
    const std::string what = with_terrain ? a + " is " + depth + " deep in " + b
                                          : a + " and " + b + " overlap by " + depth;
    if (deep) {
      out.Error("start.deep_overlap", PlaceOf(robot, overlap),
                what + " at the start, more than half the thickness of the thinner one, " +
                    Brief(overlap.half_thickness_m) + " m",
                with_terrain
                    ? "move the robot with `place`"
                    : "move one of them, write `collides: false`, or list both bodies in `apart` "
                      "of the model");
      good = false;
    } else {
      out.Warning("start.overlap", PlaceOf(robot, overlap), what + " at the start",
                  "the contact solver separates them without adding velocity");
    }
  }
  return good;
}

}  // namespace plant

bool CheckStart(const RobotSpec& robot, StartKind start, Diagnostics& out) {
  const auto model = Model::CompileForExperiment(robot.def, out);
  if (!model) return false;
  return plant::CheckOverlaps(robot, WorldBatch(model, {}), start != StartKind::kSettledFloating,
                              start == StartKind::kAsDescribed, out);
}

}  // namespace taut
