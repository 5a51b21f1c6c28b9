/// Shapes as the convex hull of corners, widened by a radius; their thickness and volume.
#pragma once

#include "math/vec.h"
#include "taut/model_def.h"

namespace taut::math {

/// Distance by which the hull of the corners is widened [m].
inline double RadiusOf(const SphereDef& sphere) noexcept { return sphere.radius_m; }
inline double RadiusOf(const CapsuleDef& rod) noexcept { return rod.radius_m; }
inline double RadiusOf(const BoxDef&) noexcept { return 0; }
inline double RadiusOf(const HullDef&) noexcept { return 0; }

// Call f(corner) for each corner [m], in W.
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

/// Returns half the smallest extent along an axis of the shape, or of W for hulls [m].
double HalfThickness(const SphereDef& sphere);
double HalfThickness(const CapsuleDef& rod);
double HalfThickness(const BoxDef& box);
double HalfThickness(const HullDef& hull);

/// Returns the volume; of a rod without its round ends [m^3].
double VolumeOf(const SphereDef& sphere);
double VolumeOf(const CapsuleDef& rod);
double VolumeOf(const BoxDef& box);
double VolumeOf(const HullDef& hull);

}  // namespace taut::math
