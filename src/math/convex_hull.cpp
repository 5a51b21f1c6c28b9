// Convex hull by brute force: three points form a face if all others are on one side of their
// plane. The work is proportional to the fourth power of the number of corners, which is small.
// There are no special cases: points that are coplanar to within a tolerance form one face.
#include "math/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "math/vec.h"

namespace taut::math {
namespace {

/// Tolerance for coplanar or coincident points, relative to the size of the body. While faces do
/// not close, it increases by the factor kWider, up to kWidest.
constexpr double kSame = 1e-7, kWidest = 1e-3, kWider = 10.0;
/// Maximum number of successive points that may be added without an increase of the number of
/// corners. In a body with a thickness near the tolerance, an added corner may disappear later, or
/// remove another one.
constexpr int kMostFruitless = 16;

using Face = std::vector<int>;
using Points = std::vector<Vec3>;

const Vec3& At(const Points& points, int i) { return points[static_cast<std::size_t>(i)]; }

struct Plane {
  Vec3 normal;  ///< Unit vector, outward.
  double offset_m;
  double Above(const Vec3& p) const { return Dot(normal, p) - offset_m; }
};

/// Returns the corners of a face among the coplanar points `on`, counterclockwise seen from
/// outside. The next corner is the point without others to its right; of several, the farthest.
Face Around(const Points& points, const Face& on, const Vec3& normal, double same_m) {
  int start = on.front();
  Vec3 u = Cross(normal, std::fabs(normal.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
  u = (1.0 / Length(u)) * u;
  for (const int i : on) {
    if (Dot(u, At(points, i)) > Dot(u, At(points, start)) + same_m) start = i;
  }
  // Of points with equal coordinate along u, take the foremost along v.
  const Vec3 v = Cross(normal, u);
  const double foremost = Dot(u, At(points, start));
  for (const int i : on) {
    if (Dot(u, At(points, i)) < foremost - same_m) continue;
    if (Dot(v, At(points, i)) > Dot(v, At(points, start))) start = i;
  }
  Face face;
  int here = start;
  do {
    face.push_back(here);
    int next = -1;
    for (const int i : on) {
      if (i == here) continue;
      if (next < 0) {
        next = i;
        continue;
      }
      const Vec3 way = At(points, next) - At(points, here),
                 other = At(points, i) - At(points, here);
      const double right = -Dot(normal, Cross(way, other)), far = Length(way);
      if (right > same_m * far) next = i;
      if (std::fabs(right) <= same_m * far && Dot(way, other) > far * far) next = i;
    }
    here = next;
  } while (here >= 0 && here != start && face.size() <= on.size());
  return face;
}

std::vector<Face> FacesOf(const Points& points, double same_m) {
  std::vector<Face> faces;
  std::vector<Face> seen;
  const int count = static_cast<int>(points.size());
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) {
      for (int c = b + 1; c < count; ++c) {
        Vec3 n = Cross(At(points, b) - At(points, a), At(points, c) - At(points, a));
        const double length = Length(n);
        const double longest =
            std::max(Length(At(points, b) - At(points, a)), Length(At(points, c) - At(points, a)));
        if (!(length > same_m * longest)) continue;
        n = (1.0 / length) * n;
        bool above = false, below = false;
        Face on;
        for (int i = 0; i < count && !(above && below); ++i) {
          const double at = Dot(n, At(points, i) - At(points, a));
          if (at > same_m)
            above = true;
          else if (at < -same_m)
            below = true;
          else
            on.push_back(i);
        }
        if (above && below) continue;
        // Faces may contain each other, since the plane of nearly collinear points is inaccurate.
        const auto holds = [](const Face& big, const Face& small) {
          return std::includes(big.begin(), big.end(), small.begin(), small.end());
        };
        if (std::any_of(seen.begin(), seen.end(), [&](const Face& f) { return holds(f, on); })) {
          continue;
        }
        for (std::size_t i = seen.size(); i-- > 0;) {
          if (!holds(on, seen[i])) continue;
          seen.erase(seen.begin() + static_cast<std::ptrdiff_t>(i));
          faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(i));
        }
        seen.push_back(on);
        faces.push_back(Around(points, on, above ? -1.0 * n : n, same_m));
      }
    }
  }
  return faces;
}

Plane PlaneOf(const Points& points, const Face& face) {
  const Vec3 n = NormalOf(points, face);
  double offset_m = -1e300;
  for (const int i : face) offset_m = std::max(offset_m, Dot(n, At(points, i)));
  return {n, offset_m};
}

/// Returns whether every edge belongs to two faces, once in each direction.
bool Closes(const std::vector<Face>& faces) {
  std::map<std::pair<int, int>, int> edges;
  for (const Face& face : faces) {
    if (face.size() < 3) return false;
    for (std::size_t i = 0; i < face.size(); ++i) {
      if (++edges[{face[i], face[(i + 1) % face.size()]}] > 1) return false;
    }
  }
  return !faces.empty() && std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    return edges.count({edge.first.second, edge.first.first}) == 1;
  });
}

/// Returns the hull of points, without points that are corners of fewer than three faces.
ConvexHull Closed(Points points, double same_m) {
  for (;;) {
    ConvexHull hull;
    hull.faces = FacesOf(points, same_m);
    std::vector<int> used(points.size(), 0);
    for (const Face& face : hull.faces) {
      for (const int i : face) ++used[static_cast<std::size_t>(i)];
    }
    Points kept;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (used[i] >= 3) kept.push_back(points[i]);
    }
    if (kept.size() == points.size()) {
      if (!Closes(hull.faces)) return {};
      hull.corners = std::move(points);
      return hull;
    }
    if (kept.size() < 4) return {};
    points = std::move(kept);
  }
}

/// Returns four points that span a volume, outermost first.
Points Start(const Points& points, double same_m) {
  Points start{points.front()};
  const auto add_farthest = [&](const auto& distance) {
    const auto far =
        std::max_element(points.begin(), points.end(),
                         [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    if (distance(*far) > same_m) start.push_back(*far);
  };
  add_farthest([&](const Vec3& p) { return Length(p - start[0]); });
  if (start.size() < 2) return {};
  start.erase(start.begin());
  add_farthest([&](const Vec3& p) { return Length(p - start[0]); });
  if (start.size() < 2) return {};
  const Vec3 along = (1.0 / Length(start[1] - start[0])) * (start[1] - start[0]);
  add_farthest([&](const Vec3& p) { return Length(Cross(along, p - start[0])); });
  if (start.size() < 3) return {};
  Vec3 n = Cross(along, start[2] - start[0]);
  n = (1.0 / Length(n)) * n;
  add_farthest([&](const Vec3& p) { return std::fabs(Dot(n, p - start[0])); });
  return start.size() == 4 ? start : Points{};
}

/// Returns the point farthest outside and its distance. Removes points that are inside from
/// `outside`, since they remain inside as the hull grows.
std::pair<Vec3, double> Outermost(Points& outside, const ConvexHull& hull, double same_m) {
  std::vector<Plane> planes;
  for (const Face& face : hull.faces) planes.push_back(PlaneOf(hull.corners, face));
  std::pair<Vec3, double> best{{}, 0.0};
  std::erase_if(outside, [&](const Vec3& p) {
    double out = -1e300;
    for (const Plane& plane : planes) out = std::max(out, plane.Above(p));
    if (out > best.second) best = {p, out};
    return out <= same_m;
  });
  return best;
}

}  // namespace

ConvexHull HullOf(const std::vector<Vec3>& points, int most_corners) {
  Vec3 low{1e300, 1e300, 1e300}, high = -1.0 * low;
  for (const Vec3& p : points) {
    if (!std::isfinite(p.x + p.y + p.z)) return {};
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  if (points.size() < 4) return {};
  const double size_m = Length(high - low), same_m = kSame * size_m;
  ConvexHull hull;
  Points chosen = Start(points, same_m), outside = points;
  if (chosen.empty()) return {};
  for (int fruitless = 0;;) {
    const std::size_t corners_before = hull.corners.size();
    for (double near_m = same_m; near_m <= kWidest * size_m; near_m *= kWider) {
      hull = Closed(chosen, near_m);
      if (!hull.corners.empty()) break;
    }
    if (hull.corners.empty()) return {};
    if (hull.corners.size() <= corners_before && ++fruitless > kMostFruitless) {
      outside = points;
      hull.left_out_m = Outermost(outside, hull, same_m).second;
      hull.too_thin = true;
      break;
    }
    const auto [farthest, out_m] = Outermost(outside, hull, same_m);
    hull.left_out_m = out_m;
    const bool full = static_cast<int>(hull.corners.size()) >= most_corners;
    if (out_m <= same_m || full) break;
    chosen = hull.corners;
    chosen.push_back(farthest);
  }
  return hull;
}

Vec3 NormalOf(const std::vector<Vec3>& corners, const std::vector<int>& face) {
  Vec3 n;
  const Vec3 first = At(corners, face[0]);
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    n = n + Cross(At(corners, face[i]) - first, At(corners, face[i + 1]) - first);
  }
  return (1.0 / Length(n)) * n;
}

Triangles TrianglesOf(const ConvexHull& hull) {
  Triangles triangles;
  for (const Face& face : hull.faces) {
    for (std::size_t i = 2; i < face.size(); ++i) {
      triangles.push_back({face[0], face[i - 1], face[i]});
    }
  }
  return triangles;
}

}  // namespace taut::math
