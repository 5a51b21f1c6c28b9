/// Which edges of the terrain a cable comes to lie against, for one world (docs/theory/cables.md,
/// section 6). Part of a step: no standard library.
#pragma once

#include "math/cable_wheel.h"
#include "math/vec.h"
#include "sim/data/view.h"

namespace taut::sim {

/// Edges of a shape have numbers below this one.
inline constexpr double kEdgesOfShape = 4294967296.0;

/// A cylinder that a cable may come to lie against.
struct BendPlace {
  double key;         ///< Which one: the same number is the same edge or rod of a model.
  int body;           ///< Or the world; in whose frame P
  Vec3 center, axis;  ///< these are; a unit vector [m], [1].
  double most_rad;    ///< The greatest angle about it that does not lead through the solid.
  double half_m;      ///< Half its length.
  double radius_m;    ///< To the middle of a cable on it.
};

/// A cable that comes nearer to an edge's end, in radii, slips off: where edges meet in a corner
/// they would have no two cylinders apart.
inline constexpr double kCornerRadii = 3.0;

/// An edge that sticks out.
struct TerrainEdge {
  BendPlace place;
  Vec3 out;  ///< Unit vector across it, away from the solid.
};

/// A straight stretch of a cable.
struct FreeSpan {
  Vec3 from, to;
  bool starts, ends;  ///< Whether those are ends of the cable.
};

TAUT_INLINE bool IsTaken(double key, const double* taken, int count) noexcept {
  for (int i = 0; i < count; ++i) {
    if (taken[i] == key) return true;
  }
  return false;
}

/// What a span has come to lie against. `side`: the sign of the angle by which it goes round it.
struct BendFound {
  BendPlace place;
  double depth_m, side;
};

/// Whether a span from end to end, on the given side of it, would lie on that, within its length.
bool CanLieOn(const BendPlace& place, const FreeSpan& span, double side) noexcept;

/// The edge with the deepest place of a span below it, of those that can lift the span out, but for
/// `taken`. False if there is none that is deeper than what was found before, if `any` was. A box
/// in which the cable ends is passed through.
bool FindEdge(const View& m, const FreeSpan& span, double radius_m, const double* taken,
              int taken_count, bool any, BendFound* found) noexcept;

/// No edge is nearer to the span, up to `enough_m`; 0 or less where one may be touched.
double FreeDistance(const View& m, const FreeSpan& span, double radius_m, double enough_m) noexcept;

}  // namespace taut::sim
