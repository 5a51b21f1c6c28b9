#include <array>
#include <string>

#include "math/closed_mesh.h"
#include "math/vec.h"
#include "sim/checker.h"

namespace taut::sim {
namespace {

constexpr double kMaxCells = 1e8;

void CheckField(const HeightFieldDef& field, Checker& check) {
  const std::string name = "height field " + field.name;
  check.Surface(field.material, name);
  check.Finite(field.origin_m, name + ": origin");
  check.Positive(field.cell_m, name + ": side of a cell");
  const bool wide = field.columns >= 2 && field.rows >= 2;
  check.Require(wide, name + " needs two corners or more along x and along y");
  const double corners = static_cast<double>(field.columns) * field.rows;
  check.Require(corners <= kMaxCells, name + " has more than 10^8 cells");
  check.Require(!wide || static_cast<double>(field.height_m.size()) == corners,
                name + " has " + std::to_string(field.height_m.size()) +
                    " heights, not a height for each of its corners");
  for (std::size_t i = 0; i < field.height_m.size(); ++i) {
    if (std::isfinite(field.height_m[i])) continue;
    check.Require(false, name + ": height " + std::to_string(i) + " must be finite");
    return;
  }
}

void CheckMesh(const TerrainMeshDef& mesh, Checker& check) {
  const std::string name = "mesh " + mesh.name;
  check.Surface(mesh.material, name);
  check.Require(!mesh.triangles.empty(), name + " has no triangle");
  Vec3 least{1e300, 1e300, 1e300}, most{-1e300, -1e300, -1e300};
  for (std::size_t i = 0; i < mesh.corners_m.size(); ++i) {
    const Vec3& p = mesh.corners_m[i];
    if (!std::isfinite(p.x + p.y + p.z)) {
      return check.Require(false, name + ": corner " + std::to_string(i) + " must be finite");
    }
    least = {std::fmin(least.x, p.x), std::fmin(least.y, p.y), std::fmin(least.z, p.z)};
    most = {std::fmax(most.x, p.x), std::fmax(most.y, p.y), std::fmax(most.z, p.z)};
  }
  const double size = most.x - least.x + (most.y - least.y) + (most.z - least.z);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::array<int, 3>& t = mesh.triangles[i];
    const std::string which = name + ": triangle " + std::to_string(i);
    for (const int corner : t) {
      if (corner < 0 || corner >= static_cast<int>(mesh.corners_m.size())) {
        return check.Require(false, which + " refers to a corner that is not there");
      }
    }
    const auto corner = [&](std::size_t k) {
      return mesh.corners_m[static_cast<std::size_t>(t[k])];
    };
    const Vec3 n = Cross(corner(1) - corner(0), corner(2) - corner(0));
    if (!(Dot(n, n) > 1e-24 * size * size * size * size)) {
      return check.Require(false, which + " has no area");
    }
  }
  if (!mesh.solid || mesh.triangles.empty()) return;
  const std::string why = math::WhyNotClosed(mesh.corners_m, mesh.triangles);
  check.Require(why.empty(), name + why);
}

}  // namespace

void CheckGround(const ModelDef& def, Checker& check) {
  for (const HeightFieldDef& field : def.height_fields) CheckField(field, check);
  for (const TerrainMeshDef& mesh : def.terrain_meshes) CheckMesh(mesh, check);
}

}  // namespace taut::sim
