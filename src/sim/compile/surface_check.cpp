// Validation of height fields and terrain meshes.
#include <string>

#include "math/triangles.h"
#include "sim/compile/checker.h"

namespace taut::sim {
namespace {

constexpr double kMaxCells = 1e8;

void CheckField(const HeightFieldDef& field, Checker& check) {
  const std::string name = "height field " + field.name;
  check.Surface(field.material, name);
  check.Finite(field.origin_m, name + ": origin");
  check.Positive(field.cell_m, name + ": edge length of a cell");
  const bool wide = field.columns >= 2 && field.rows >= 2;
  check.Require(wide, name + " needs at least two corners along x and along y");
  const double corners = static_cast<double>(field.columns) * field.rows;
  check.Require(corners <= kMaxCells, name + " has more than 10^8 cells");
  check.Require(!wide || static_cast<double>(field.height_m.size()) == corners,
                name + " has " + std::to_string(field.height_m.size()) +
                    " heights, but needs one for each of its corners");
  for (std::size_t i = 0; i < field.height_m.size(); ++i) {
    if (std::isfinite(field.height_m[i])) continue;
    check.Require(false, name + ": height " + std::to_string(i) + " must be finite");
    return;
  }
}

/// Returns a message about a mesh fault, with the numbers of triangles and corners.
std::string Text(const math::MeshFault& fault) {
  using Kind = math::MeshFault::Kind;
  const std::string triangle = ": triangle " + std::to_string(fault.triangle),
                    edge = "the edge between corners " + std::to_string(fault.from) + " and " +
                           std::to_string(fault.to);
  switch (fault.kind) {
    case Kind::kNoCorner:
      return triangle + " refers to a corner that does not exist";
    case Kind::kNoArea:
      return triangle + " has no area";
    case Kind::kOpen:
      return " is not closed: " + edge + " has one triangle only";
    case Kind::kCrowded:
      return ": " + edge + " has two triangles on one side, or more than two in all";
    case Kind::kInsideOut:
      return " is inside out: the corners of a triangle must be counter-clockwise as seen from "
             "outside";
  }
  return {};
}

void CheckMesh(const TerrainMeshDef& mesh, Checker& check) {
  const std::string name = "mesh " + mesh.name;
  check.Surface(mesh.material, name);
  check.Require(!mesh.triangles.empty(), name + " has no triangles");
  for (std::size_t i = 0; i < mesh.corners_m.size(); ++i) {
    const Vec3& p = mesh.corners_m[i];
    if (!std::isfinite(p.x + p.y + p.z)) {
      return check.Require(false, name + ": corner " + std::to_string(i) + " must be finite");
    }
  }
  for (const math::MeshFault& fault :
       math::FindFaults(mesh.corners_m, mesh.triangles, mesh.solid, 1)) {
    check.Require(false, name + Text(fault));
  }
}

}  // namespace

void CheckGround(const ModelDef& def, Checker& check) {
  double heights = 0;
  for (const HeightFieldDef& field : def.height_fields) {
    CheckField(field, check);
    heights += static_cast<double>(field.columns) * field.rows;
  }
  check.Require(heights <= kMaxCells, "the height fields have more than 10^8 heights together");
  for (const TerrainMeshDef& mesh : def.terrain_meshes) CheckMesh(mesh, check);
}

}  // namespace taut::sim
