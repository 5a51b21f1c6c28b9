// Detection of sharp edges and corners during the construction of a surface.
#include <algorithm>
#include <map>
#include <utility>

#include "sim/geometry/surface_build.h"
#include "sim/geometry/surface_sharp.h"

namespace taut::sim {
namespace {

/// Angle between the planes of two triangles below which they continue straight [rad]. A rod would
/// touch the edge between them over less than a millionth of its radius, which surface_line.cpp
/// ignores.
constexpr double kStraight = 1e-8;
/// Minimum number of sharp edges at a sharp corner; fewer do not span a cone.
constexpr int kEdgesOfSharpCorner = 3;

/// Returns 1 if the sides of an edge fall away from each other by more than kStraight, -1 if they
/// rise, otherwise 0. Seen from the side where the corners of the first triangle are
/// counterclockwise.
int Falls(const Vec3& from, const Vec3& to, const Vec3& apex, const Vec3& other) {
  const Vec3 along = to - from, n = Cross(along, apex - from), m = Cross(along, other - from);
  // Sine of the angle times the lengths of n and m, divided by the length of the edge.
  const double sine = -Dot(n, other - from);
  if (sine * sine * Dot(along, along) <= kStraight * kStraight * Dot(n, n) * Dot(m, m)) return 0;
  return sine > 0.0 ? 1 : -1;
}

bool IsSharp(const SurfaceEdge& edge) {
  if (edge.border) return true;
  // Order the corners counterclockwise, seen from above.
  const Vec3 up = Cross(edge.to - edge.from, edge.apex[0] - edge.from);
  return (up.z < 0.0 ? Falls(edge.to, edge.from, edge.apex[0], edge.apex[1])
                     : Falls(edge.from, edge.to, edge.apex[0], edge.apex[1])) > 0;
}

}  // namespace

void Surface::MarkField() {
  const SurfaceTable& t = *table_;
  const auto mark = [&](int i, int j) -> unsigned char& {
    return marks_[static_cast<std::size_t>(j) * static_cast<std::size_t>(t.columns) +
                  static_cast<std::size_t>(i)];
  };
  for (int j = 0; j < t.rows; ++j) {
    for (int i = 0; i < t.columns; ++i) {
      const bool east = i + 1 < t.columns, north = j + 1 < t.rows;
      const auto look = [&](FieldMark which) {
        if (IsSharp(detail::EdgeOfField(t, i, j, which))) mark(i, j) |= which;
      };
      if (east) look(kSharpAlongX);
      if (north) look(kSharpAlongY);
      if (east && north) look(kSharpDiagonal);
    }
  }
  for (int j = 0; j < t.rows; ++j) {
    for (int i = 0; i < t.columns; ++i) {
      int sharp = 0;
      const auto count = [&](int ci, int cj, FieldMark which) {
        if ((mark(ci, cj) & which) != 0) ++sharp;
      };
      const bool border = i == 0 || j == 0 || i + 1 == t.columns || j + 1 == t.rows;
      if (!border) {
        count(i, j, kSharpAlongX), count(i - 1, j, kSharpAlongX);
        count(i, j, kSharpAlongY), count(i, j - 1, kSharpAlongY);
        if (detail::Rises(t, i, j)) count(i, j, kSharpDiagonal);
        if (detail::Rises(t, i - 1, j - 1)) count(i - 1, j - 1, kSharpDiagonal);
        if (!detail::Rises(t, i - 1, j)) count(i - 1, j, kSharpDiagonal);
        if (!detail::Rises(t, i, j - 1)) count(i, j - 1, kSharpDiagonal);
      }
      if (border || sharp >= kEdgesOfSharpCorner) mark(i, j) |= kSharpCorner;
    }
  }
}

void Surface::FindSharp() {
  SurfaceTable& t = *table_;
  const int triangles = static_cast<int>(triangles_.size()) / 3;
  /// Edge: its first triangle, in which `to` follows `from`, and the third corners of all its
  /// triangles.
  struct Edge {
    int owner, from, to;
    std::vector<int> apexes;
  };
  std::map<std::pair<int, int>, Edge> edges;
  std::vector<int> owner(corners_.size(), -1), sharp(corners_.size(), 0);
  std::vector<std::vector<int>> beside(corners_.size());
  for (int k = 0; k < triangles; ++k) {
    const int* const v = t.triangles + 3 * k;
    for (int n = 0; n < 3; ++n) {
      const int a = v[n], b = v[(n + 1) % 3];
      if (owner[static_cast<std::size_t>(a)] < 0) owner[static_cast<std::size_t>(a)] = k;
      const auto [at, is_new] = edges.try_emplace(std::minmax(a, b), Edge{k, a, b, {}});
      at->second.apexes.push_back(v[(n + 2) % 3]);
      if (!is_new) continue;
      beside[static_cast<std::size_t>(a)].push_back(b);
      beside[static_cast<std::size_t>(b)].push_back(a);
    }
  }
  std::vector<const Edge*> found;
  for (const auto& [key, edge] : edges) {
    bool sticks_out = edge.apexes.size() != 2;
    if (!sticks_out) {
      const auto corner = [&](int c) { return corners_[static_cast<std::size_t>(c)]; };
      const double falls =
          Falls(corner(edge.from), corner(edge.to), corner(edge.apexes[0]), corner(edge.apexes[1]));
      // A sheet has two sides.
      sticks_out = t.solid ? falls > 0 : falls != 0;
    }
    if (!sticks_out) continue;
    found.push_back(&edge);
    // A corner at a border has fewer edges, so a border edge counts as enough for a sharp corner.
    const int counts = edge.apexes.size() == 2 ? 1 : kEdgesOfSharpCorner;
    for (const int end : {edge.from, edge.to}) sharp[static_cast<std::size_t>(end)] += counts;
  }
  std::sort(found.begin(), found.end(), [](const Edge* a, const Edge* b) {
    return std::pair(a->owner, std::pair(a->from, a->to)) <
           std::pair(b->owner, std::pair(b->from, b->to));
  });
  std::vector<int> corners;
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    if (sharp[c] >= kEdgesOfSharpCorner) corners.push_back(static_cast<int>(c));
  }
  std::stable_sort(corners.begin(), corners.end(), [&](int a, int b) {
    return owner[static_cast<std::size_t>(a)] < owner[static_cast<std::size_t>(b)];
  });
  const auto add = [&](const std::vector<int>& list) {
    const int first = static_cast<int>(beside_.size());
    beside_.insert(beside_.end(), list.begin(), list.end());
    return first;
  };
  std::size_t next_edge = 0, next_corner = 0;
  for (int k = 0; k < triangles; ++k) {
    first_edge_.push_back(static_cast<int>(edges_.size()));
    for (; next_edge < found.size() && found[next_edge]->owner == k; ++next_edge) {
      const Edge& e = *found[next_edge];
      edges_.push_back({e.from, e.to, add(e.apexes), static_cast<int>(e.apexes.size())});
    }
    first_corner_.push_back(static_cast<int>(sharp_corners_.size()));
    for (; next_corner < corners.size(); ++next_corner) {
      const auto c = static_cast<std::size_t>(corners[next_corner]);
      if (owner[c] != k) break;
      sharp_corners_.push_back(
          {corners[next_corner], add(beside[c]), static_cast<int>(beside[c].size())});
    }
  }
  first_edge_.push_back(static_cast<int>(edges_.size()));
  first_corner_.push_back(static_cast<int>(sharp_corners_.size()));
  t.first_edge = first_edge_.data(), t.first_corner = first_corner_.data();
  t.edges = edges_.data(), t.sharp_corners = sharp_corners_.data();
  t.beside = beside_.data();
}

}  // namespace taut::sim
