/// Terrain edges around which a cable wraps, for one world (docs/theory/cables.md, section 6). A
/// step includes this header, so it does not use the standard library.
#pragma once

#include "math/cable_wheel.h"
#include "math/vec.h"
#include "sim/data/view.h"

namespace taut::sim {

/// Upper limit of the edge numbers of a shape.
inline constexpr double kEdgesOfShape = 4294967296.0;

/// Cylinder around which a cable may wrap.
struct BendPlace {
  double key;         ///< Unique key of the edge or rod in a model.
  int body;           ///< Body or the world; its frame P is the frame of `center` and `axis`.
  Vec3 center, axis;  ///< Center [m], and unit vector.
  /// Largest angle about the axis at which the cable does not pass through the solid.
  double most_rad;
  double half_m;    ///< Half the length of the cylinder.
  double radius_m;  ///< Distance from the axis to the center line of a cable on it.
};

/// Distance from the end of an edge at which a cable slips off, in radii. Closer to a corner, the
/// cylinders of adjacent edges overlap.
inline constexpr double kCornerRadii = 3.0;

/// Convex edge of the terrain.
struct TerrainEdge {
  BendPlace place;
  Vec3 out;  ///< Unit vector normal to the edge, away from the solid.
};

/// Straight part of a cable.
struct FreeSpan {
  Vec3 from, to;
  bool starts, ends;  ///< Whether `from` and `to` are ends of the cable.
};

TAUT_INLINE bool IsTaken(double key, const double* taken, int count) noexcept {
  for (int i = 0; i < count; ++i) {
    if (taken[i] == key) return true;
  }
  return false;
}

/// Edge or rod that a span penetrates. `side`: sign of the wrap angle.
struct BendFound {
  BendPlace place;
  double depth_m, side;
};

/// Returns whether a span that wraps around `place` on the given side would touch it within its
/// length.
bool CanLieOn(const BendPlace& place, const FreeSpan& span, double side) noexcept;

/// Finds the edge with the deepest penetration by the span, among edges not in `taken` that can
/// lift the span out. `any`: `found` contains an earlier result, and only a deeper edge replaces
/// it. Returns false if `found` is unchanged. Boxes that contain an end of the cable are ignored:
/// the span passes through them.
bool FindEdge(const View& m, const FreeSpan& span, double radius_m, const double* taken,
              int taken_count, bool any, BendFound* found) noexcept;

/// Returns a lower bound of the distance from the span to any edge [m], at most `enough_m`. If the
/// bound is <= 0, the span may touch an edge.
double FreeDistance(const View& m, const FreeSpan& span, double radius_m, double enough_m) noexcept;

}  // namespace taut::sim
