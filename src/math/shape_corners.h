/// Corners, radius, thickness and volume of shapes. A shape is the Minkowski sum of the convex hull
/// of its corners and a ball.
#pragma once

#include "math/vec.h"
#include "taut/model_def.h"

namespace taut::math {

// RadiusOf: returns the radius of this ball [m].
inline double RadiusOf(const SphereDef& sphere) noexcept { return sphere.radius_m; }
inline double RadiusOf(const CapsuleDef& rod) noexcept { return rod.radius_m; }
inline double RadiusOf(const BoxDef&) noexcept { return 0; }
inline double RadiusOf(const HullDef&) noexcept { return 0; }

// EachCorner: calls f(corner) for each corner [m], in W.
template <class F>
void EachCorner(const SphereDef& sphere, F f) {
  f(sphere.center_m);
}
template <class F>
void EachCorner(const CapsuleDef& rod, F f) {
  f(rod.from_m), f(rod.to_m);
}
/// Corner i is at the upper end of axis k if bit k of i is set.
template <class F>
void EachCorner(const BoxDef& box, F f) {
  const Vec3& h = box.half_extents_m;
  for (int i = 0; i < 8; ++i) {
    const Vec3 out{i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z};
    f(box.center_m + Rotate(box.orientation, out));
  }
}
template <class F>
void EachCorner(const HullDef& hull, F f) {
  for (const Vec3& corner : hull.corners_m) f(corner);
}

/// Returns half the smallest extent [m] along the axes of the shape; for hulls, along the axes of
/// W.
double HalfExtent(const SphereDef& sphere);
double HalfExtent(const CapsuleDef& rod);
double HalfExtent(const BoxDef& box);
double HalfExtent(const HullDef& hull);

/// Returns the volume [m^3]; rods without their round ends.
double VolumeOf(const SphereDef& sphere);
double VolumeOf(const CapsuleDef& rod);
double VolumeOf(const BoxDef& box);
double VolumeOf(const HullDef& hull);

}  // namespace taut::math
