#include "math/triangles.h"

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

using Corners = std::vector<Vec3>;

const Vec3& At(const Corners& corners, int i) { return corners[static_cast<std::size_t>(i)]; }

double SizeOf(const Corners& corners) {
  Vec3 least{1e300, 1e300, 1e300}, most{-1e300, -1e300, -1e300};
  for (const Vec3& p : corners) {
    least = {std::fmin(least.x, p.x), std::fmin(least.y, p.y), std::fmin(least.z, p.z)};
    most = {std::fmax(most.x, p.x), std::fmax(most.y, p.y), std::fmax(most.z, p.z)};
  }
  return most.x - least.x + (most.y - least.y) + (most.z - least.z);
}

Faults FaultsOfTriangles(const Corners& corners, const Triangles& triangles, std::size_t at_most) {
  const double size = SizeOf(corners);
  const int count = static_cast<int>(corners.size());
  Faults faults;
  for (std::size_t i = 0; i < triangles.size() && faults.size() < at_most; ++i) {
    const auto& [a, b, c] = triangles[i];
    if (std::min({a, b, c}) < 0 || std::max({a, b, c}) >= count) {
      faults.push_back({Kind::kNoCorner, static_cast<int>(i)});
      continue;
    }
    const Vec3 n = Cross(At(corners, b) - At(corners, a), At(corners, c) - At(corners, a));
    if (Dot(n, n) > 1e-24 * size * size * size * size) continue;
    faults.push_back({Kind::kNoArea, static_cast<int>(i)});
  }
  return faults;
}

/// Finds faulty edges: in a closed mesh, every edge belongs to two triangles, with opposite
/// directions.
Faults FaultsOfEdges(const Corners& corners, const Triangles& triangles, std::size_t at_most) {
  struct Use {
    int count = 0, last = -1;
  };
  std::map<std::pair<int, int>, Use> edges;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::array<int, 3>& t = triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      Use& use = edges[{t[k], t[(k + 1) % 3]}];
      ++use.count, use.last = static_cast<int>(i);
    }
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
  if (faults.empty() && !(SixVolumes(corners, triangles) > 0)) faults.push_back({Kind::kInsideOut});
  return faults;
}

}  // namespace

double SixVolumes(const Corners& corners_m, const Triangles& triangles) {
  double six_volumes = 0;
  for (const auto& [a, b, c] : triangles) {
    six_volumes += Dot(At(corners_m, a), Cross(At(corners_m, b), At(corners_m, c)));
  }
  return six_volumes;
}

Faults FindFaults(const Corners& corners_m, const Triangles& triangles, bool closed,
                  std::size_t most) {
  Faults faults = FaultsOfTriangles(corners_m, triangles, most);
  if (!faults.empty() || !closed || triangles.empty()) return faults;
  return FaultsOfEdges(corners_m, triangles, most);
}

}  // namespace taut::math
