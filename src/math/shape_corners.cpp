#include "math/shape_corners.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "math/convex_hull.h"

namespace taut::math {

double HalfExtent(const SphereDef& sphere) { return sphere.radius_m; }
double HalfExtent(const CapsuleDef& rod) { return rod.radius_m; }
double HalfExtent(const BoxDef& box) {
  return std::min({box.half_extents_m.x, box.half_extents_m.y, box.half_extents_m.z});
}
double HalfExtent(const HullDef& hull) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Vec3 low{kInf, kInf, kInf}, high = -1.0 * low;
  for (const Vec3& p : hull.corners_m) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return 0.5 * std::min({high.x - low.x, high.y - low.y, high.z - low.z});
}

double VolumeOf(const SphereDef& sphere) {
  return 4.0 / 3.0 * std::numbers::pi * std::pow(sphere.radius_m, 3);
}
double VolumeOf(const CapsuleDef& rod) {
  const Vec3 along = rod.to_m - rod.from_m;
  return std::numbers::pi * rod.radius_m * rod.radius_m * std::sqrt(Dot(along, along));
}
double VolumeOf(const BoxDef& box) {
  return 8.0 * box.half_extents_m.x * box.half_extents_m.y * box.half_extents_m.z;
}
double VolumeOf(const HullDef& hull) {
  const ConvexHull found = HullOf(hull.corners_m, HullDef::kMostCorners);
  return SixVolumes(found.corners, TrianglesOf(found)) / 6.0;
}

}  // namespace taut::math
