/// Which places of a surface are nearest to a point or to a line.
#pragma once

#include "sim/geometry/surface_parts.h"

namespace taut::sim {

/// A place of the surface that is nearer than all around it.
struct SurfacePlace {
  Vec3 at;
  Vec3 normal;        ///< Unit, from there to the point.
  double distance_m;  ///< Below 0: the point is inside.
};

/// Local minima of the distance of a point, those within `limit_m`, the nearest first; at most
/// `most` of them, and how many. Inside of what is solid only the nearest: ways out could be at
/// odds. `known`: what is near it (surface_parts.h), or null;
/// `above`: the point is above the field; `middle`: center of the body whose corner it is.
int NearestPlaces(const SurfaceTable& s, const Vec3& point, double limit_m, SurfacePlace* out,
                  int most, const NearParts::OfEnd* known = nullptr, bool above = false,
                  const Vec3* middle = nullptr) noexcept;

/// The place of a triangle that is nearest to a point.
Vec3 NearestPlaceOf(const SurfaceTriangle& t, const Vec3& point) noexcept;

/// Where a straight line, between its ends, is nearest to an edge or a corner.
struct LinePlace {
  double share;  ///< Along the line, between 0 and 1.
  SurfacePlace place;
};

/// A line, but for what the highest that is below says to be out of reach; `low` above `high` where
/// all of it is.
LineReach ReachOfLine(const SurfaceTable& s, const Vec3& from, const Vec3& to,
                      double limit_m) noexcept;

/// The same for the inside of a line: edges and corners that stick out, each where it is nearest of
/// all places of the line that it is the nearest to. In the order of `share`.
int NearestAlong(const SurfaceTable& s, const LineReach& line, double radius_m, LinePlace* out,
                 int most, const NearParts::Between* known = nullptr) noexcept;

}  // namespace taut::sim
