/// Which edges of the terrain a cable comes to lie against, for one world (docs/theory/cables.md,
/// section 6). Part of a step: no standard library.
#pragma once

#include "math/cable_wheel.h"
#include "math/vec.h"
#include "sim/tables.h"

namespace taut::sim {

/// An edge that sticks out, as a cable meets it.
struct TerrainEdge {
  double key;         ///< Which one: the same number is the same edge of a model.
  Vec3 center, axis;  ///< In W; a unit vector [m], [1].
  double half_m;      ///< Half its length.
  Vec3 out;           ///< Unit vector across it, away from the solid.
};

/// A straight stretch of a cable.
struct FreeSpan {
  Vec3 from, to;
  bool starts, ends;  ///< Whether those are ends of the cable.
};

/// The edge with the deepest place of a span below it, of those that can lift the span out, but for
/// `taken`. `side`: the sign of the angle by which it goes round it. False if there is none. A box
/// in which the cable ends is passed through.
struct EdgeFound {
  TerrainEdge edge;
  double depth_m, side;
};
bool FindEdge(const View& m, const FreeSpan& span, double radius_m, const double* taken,
              int taken_count, EdgeFound* found) noexcept;

/// No edge is nearer to the span, up to `enough_m`; 0 or less where one may be touched.
double FreeDistance(const View& m, const FreeSpan& span, double radius_m, double enough_m) noexcept;

}  // namespace taut::sim
