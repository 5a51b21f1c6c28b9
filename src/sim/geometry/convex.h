/// Convex polyhedron in W (a hull or a box), so that both share narrow-phase code. A step includes
/// this header, so it does not use the standard library.
#pragma once

#include "sim/geometry/hull.h"
#include "sim/geometry/touch_list.h"

namespace taut::sim {

struct Convex {
  const HullTable* table;  ///< Topology; its coordinates are in the frame of the hull.
  Vec3 corners[kMaxHullCorners], normals[kMaxHullFaces];
  double offsets_m[kMaxHullFaces];
  Vec3 center;
  double thin_m;  ///< Distance from the center to the nearest face.

  explicit Convex(const HullShape& hull) noexcept;
  explicit Convex(const BoxShape& box) noexcept;

  /// Returns the signed height of a point above the plane of a face.
  double Above(int face, const Vec3& p) const noexcept {
    return Dot(normals[face], p) - offsets_m[face];
  }
  /// Returns the signed height of the lowest corner above a plane.
  double Lowest(const Vec3& normal, double offset_m) const noexcept {
    double lowest = Dot(normal, corners[0]);
    for (int i = 1; i < table->corner_count; ++i) {
      lowest = Smaller(lowest, Dot(normal, corners[i]));
    }
    return lowest - offset_m;
  }
  /// Computes the smallest and largest coordinates of the corners.
  void Bounds(Vec3* low, Vec3* high) const noexcept {
    *low = *high = corners[0];
    for (int i = 1; i < table->corner_count; ++i) {
      const Vec3& p = corners[i];
      *low = {Smaller(low->x, p.x), Smaller(low->y, p.y), Smaller(low->z, p.z)};
      *high = {Larger(high->x, p.x), Larger(high->y, p.y), Larger(high->z, p.z)};
    }
  }
  Vec3 FromOf(const HullEdge& edge) const noexcept { return corners[edge.from]; }
  Vec3 AlongOf(const HullEdge& edge) const noexcept {
    return corners[edge.to] - corners[edge.from];
  }

  /// Calls `use` with both ends of every edge of a face, counterclockwise seen from outside.
  template <class Use>
  void EachSide(int face, const Use& use) const noexcept {
    const int first = table->first_in_face[face], last = table->first_in_face[face + 1];
    for (int i = first; i < last; ++i) {
      use(corners[table->in_face[i]], corners[table->in_face[i + 1 < last ? i + 1 : first]]);
    }
  }
};

/// Point on the surface of a convex body that is nearest to a given point; for a given point inside
/// the body, on the nearest face.
struct NearestOfConvex {
  Vec3 at, normal;    ///< Outward unit normal; toward the given point if that is outside.
  double distance_m;  ///< Negative: inside.
};
NearestOfConvex NearestTo(const Convex& convex, const Vec3& point) noexcept;

}  // namespace taut::sim
