/// Points of a terrain surface nearest to a point or to a line.
#pragma once

#include "sim/geometry/surface_parts.h"

namespace taut::sim {

/// Local minimum of the distance to the surface.
struct SurfacePlace {
  Vec3 at;
  Vec3 normal;        ///< Unit vector from the surface to the point.
  double distance_m;  ///< Negative: the point is inside.
};

/// Finds the local minima of a point's distance within `limit_m`, nearest first, at most `most`.
/// Returns their number. Inside a solid, it finds only the nearest one, because several exits could
/// contradict each other. `known`: cached parts near the point (surface_parts.h), or null; `above`:
/// the point is above the field; `middle`: center of the body with this corner.
int NearestPlaces(const SurfaceTable& s, const Vec3& point, double limit_m, SurfacePlace* out,
                  int most, const NearParts::OfEnd* known = nullptr, bool above = false,
                  const Vec3* middle = nullptr) noexcept;

/// Returns the point of a triangle nearest to a given point.
Vec3 NearestPlaceOf(const SurfaceTriangle& t, const Vec3& point) noexcept;

/// Interior point of a line that is nearest to an edge or corner.
struct LinePlace {
  double share;  ///< Position on the line, 0 to 1.
  SurfacePlace place;
};

/// Returns the part of a line that may be within `limit_m` of the surface, using the largest height
/// below it. `low` > `high` if there is none.
LineReach ReachOfLine(const SurfaceTable& s, const Vec3& from, const Vec3& to,
                      double limit_m) noexcept;

/// Finds the interior points of a line nearest to sharp edges and corners, one per edge or corner.
/// Sorted by `share`; at most `most`. Returns their number.
int NearestAlong(const SurfaceTable& s, const LineReach& line, double radius_m, LinePlace* out,
                 int most, const NearParts::Between* known = nullptr) noexcept;

}  // namespace taut::sim
