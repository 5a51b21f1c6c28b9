#include "math/closed_mesh.h"

#include <map>
#include <utility>

#include "math/vec.h"

namespace taut::math {

double SixVolumes(const std::vector<Vec3>& corners_m, const Triangles& triangles) {
  double six_volumes = 0;
  for (const std::array<int, 3>& t : triangles) {
    const auto corner = [&](std::size_t k) { return corners_m[static_cast<std::size_t>(t[k])]; };
    six_volumes += Dot(corner(0), Cross(corner(1), corner(2)));
  }
  return six_volumes;
}

std::string WhyNotClosed(const std::vector<Vec3>& corners_m, const Triangles& triangles) {
  std::map<std::pair<int, int>, int> edges;
  for (const std::array<int, 3>& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    const std::string where = "the edge between corners " + std::to_string(edge.first) + " and " +
                              std::to_string(edge.second);
    if (count > 1) return ": " + where + " has two triangles on one side, or more than two in all";
    if (edges.count({edge.second, edge.first}) == 0) {
      return " is not closed: " + where + " has one triangle only";
    }
  }
  if (SixVolumes(corners_m, triangles) > 0) return {};
  return " is inside out: corners must run counter-clockwise seen from outside";
}

}  // namespace taut::math
