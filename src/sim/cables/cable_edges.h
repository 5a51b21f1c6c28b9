/// Terrain edges that a cable wraps around, for one world (docs/theory/cables.md, section 6). Part
/// of a step: no standard library.
#pragma once

#include "math/cable_wheel.h"
#include "math/vec.h"
#include "sim/data/view.h"

namespace taut::sim {

/// Edge numbers of a shape are below this value.
inline constexpr double kEdgesOfShape = 4294967296.0;

/// A cylinder that a cable may wrap around.
struct BendPlace {
  double key;         ///< Identifies the edge or rod of a model.
  int body;           ///< Body or the world; its frame P is the frame
  Vec3 center, axis;  ///< of these; the axis is a unit vector [m], [1].
  double most_rad;    ///< Largest angle about it that does not lead through the solid.
  double half_m;      ///< Half its length.
  double radius_m;    ///< To the middle of a cable on it.
};

/// A cable slips off an edge at this distance from its end, in radii: cylinders about edges that
/// meet in a corner overlap there.
inline constexpr double kCornerRadii = 3.0;

/// A convex edge.
struct TerrainEdge {
  BendPlace place;
  Vec3 out;  ///< Unit vector across it, away from the solid.
};

/// A straight part of a cable.
struct FreeSpan {
  Vec3 from, to;
  bool starts, ends;  ///< Whether they are ends of the cable.
};

TAUT_INLINE bool IsTaken(double key, const double* taken, int count) noexcept {
  for (int i = 0; i < count; ++i) {
    if (taken[i] == key) return true;
  }
  return false;
}

/// An edge or rod that a span penetrates. `side`: sign of the wrap angle.
struct BendFound {
  BendPlace place;
  double depth_m, side;
};

/// Returns whether a span from end to end, on the given side, would wrap around the place within
/// its length.
bool CanLieOn(const BendPlace& place, const FreeSpan& span, double side) noexcept;

/// Finds the edge that penetrates the span most deeply, among edges not in `taken` that can lift
/// the span out. Returns false if no edge is deeper than the previous result (`any`: there was
/// one). A box in which the cable ends is passed through.
bool FindEdge(const View& m, const FreeSpan& span, double radius_m, const double* taken,
              int taken_count, bool any, BendFound* found) noexcept;

/// Returns a lower bound, up to `enough_m`, of the distance from the span to any edge [m]; 0 or
/// less if an edge may be touched.
double FreeDistance(const View& m, const FreeSpan& span, double radius_m, double enough_m) noexcept;

}  // namespace taut::sim
