#include "math/mesh_fault.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "math/vec.h"

namespace taut::math {
namespace {

using Kind = MeshFault::Kind;
using Faults = std::vector<MeshFault>;

Vec3 Corner(const TerrainMeshDef& mesh, int corner) {
  return mesh.corners_m[static_cast<std::size_t>(corner)];
}

double SizeOf(const TerrainMeshDef& mesh) {
  Vec3 least{1e300, 1e300, 1e300}, most{-1e300, -1e300, -1e300};
  for (const Vec3& p : mesh.corners_m) {
    least = {std::fmin(least.x, p.x), std::fmin(least.y, p.y), std::fmin(least.z, p.z)};
    most = {std::fmax(most.x, p.x), std::fmax(most.y, p.y), std::fmax(most.z, p.z)};
  }
  return most.x - least.x + (most.y - least.y) + (most.z - least.z);
}

Faults FaultsOfTriangles(const TerrainMeshDef& mesh, std::size_t at_most) {
  const double size = SizeOf(mesh);
  const int corners = static_cast<int>(mesh.corners_m.size());
  Faults faults;
  for (std::size_t i = 0; i < mesh.triangles.size() && faults.size() < at_most; ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= corners) {
      faults.push_back({Kind::kNoCorner, static_cast<int>(i)});
      continue;
    }
    const Vec3 n = Cross(Corner(mesh, b) - Corner(mesh, a), Corner(mesh, c) - Corner(mesh, a));
    if (Dot(n, n) > 1e-24 * size * size * size * size) continue;
    faults.push_back({Kind::kNoArea, static_cast<int>(i)});
  }
  return faults;
}

/// Of a closed mesh every edge belongs to two triangles, which run along it in opposite directions.
Faults FaultsOfEdges(const TerrainMeshDef& mesh, std::size_t at_most) {
  struct Use {
    int count = 0, last = -1;
  };
  std::map<std::pair<int, int>, Use> edges;
  double six_volumes = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::array<int, 3>& t = mesh.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      Use& use = edges[{t[k], t[(k + 1) % 3]}];
      ++use.count, use.last = static_cast<int>(i);
    }
    six_volumes += Dot(Corner(mesh, t[0]), Cross(Corner(mesh, t[1]), Corner(mesh, t[2])));
  }
  Faults faults;
  for (const auto& [edge, use] : edges) {
    if (faults.size() == at_most) return faults;
    const auto [from, to] = edge;
    if (use.count > 1) {
      faults.push_back({Kind::kCrowded, use.last, from, to});
    } else if (edges.count({to, from}) == 0) {
      faults.push_back({Kind::kOpen, use.last, from, to});
    }
  }
  if (faults.empty() && !(six_volumes > 0)) faults.push_back({Kind::kInsideOut});
  return faults;
}

}  // namespace

Faults FindFaults(const TerrainMeshDef& mesh, std::size_t most) {
  Faults faults = FaultsOfTriangles(mesh, most);
  if (!faults.empty() || !mesh.solid || mesh.triangles.empty()) return faults;
  return FaultsOfEdges(mesh, most);
}

}  // namespace taut::math
