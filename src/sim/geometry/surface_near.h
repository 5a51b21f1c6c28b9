/// Points of a terrain surface nearest to a point or to a line.
#pragma once

#include "sim/geometry/surface_parts.h"

namespace taut::sim {

/// A local minimum of the distance to the surface.
struct SurfacePlace {
  Vec3 at;
  Vec3 normal;        ///< Unit, from the surface to the point.
  double distance_m;  ///< Negative: the point is inside.
};

/// Finds the local minima of a point's distance within `limit_m`, the nearest first; at most
/// `most`. Returns their number. Inside a solid only the nearest: several ways out could contradict
/// each other. `known`: cached parts near the point (surface_parts.h), or null; `above`: the point
/// is above the field; `middle`: center of the body whose corner it is.
int NearestPlaces(const SurfaceTable& s, const Vec3& point, double limit_m, SurfacePlace* out,
                  int most, const NearParts::OfEnd* known = nullptr, bool above = false,
                  const Vec3* middle = nullptr) noexcept;

/// Returns the point of a triangle nearest to a given point.
Vec3 NearestPlaceOf(const SurfaceTriangle& t, const Vec3& point) noexcept;

/// Place where a straight line, between its ends, is nearest to an edge or a corner.
struct LinePlace {
  double share;  ///< Along the line, between 0 and 1.
  SurfacePlace place;
};

/// Returns the part of a line that may be within `limit_m` of the surface, by the greatest height
/// below it; `low` > `high` if none.
LineReach ReachOfLine(const SurfaceTable& s, const Vec3& from, const Vec3& to,
                      double limit_m) noexcept;

/// Finds the places where the interior of a line is nearest to sharp edges and corners, one for
/// each, among the places of the line that it is nearest to. Ordered by `share`; at most `most`.
/// Returns their number.
int NearestAlong(const SurfaceTable& s, const LineReach& line, double radius_m, LinePlace* out,
                 int most, const NearParts::Between* known = nullptr) noexcept;

}  // namespace taut::sim
