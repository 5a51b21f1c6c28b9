/// A convex body with flat faces, laid out for contacts.
///
/// Part of a step: no standard library. What fills it in is hull_build.h.
#pragma once

#include "math/vec.h"

namespace taut::sim {

inline constexpr int kMaxHullCorners = 64;  // HullDef::kMostCorners
/// By Euler's formula, where all faces are triangles.
inline constexpr int kMaxHullFaces = 2 * kMaxHullCorners - 4;
inline constexpr int kMaxHullEdges = 3 * kMaxHullCorners - 6;

/// Two corners, and the faces on either side: `left` has them in this order.
struct HullEdge {
  int from, to, left, right;
};

struct HullTable {
  int corner_count = 0, face_count = 0, edge_count = 0;
  const Vec3* corners = nullptr;       ///< In its own frame [m].
  const Vec3* normals = nullptr;       ///< Of the faces: unit, outwards.
  const double* offsets_m = nullptr;   ///< normal . x of what is on a face; no corner is above.
  const int* first_in_face = nullptr;  ///< Into in_face; one more.
  const int* in_face = nullptr;        ///< Corners, counter-clockwise seen from outside.
  const HullEdge* edges = nullptr;
  Vec3 center;           ///< Mean of the corners.
  double bound_m = 0.0;  ///< No corner is farther from the centre.
  double thin_m = 0.0;   ///< The centre's distance from the nearest face.
};

}  // namespace taut::sim
