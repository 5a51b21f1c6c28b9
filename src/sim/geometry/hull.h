/// Tables of a convex hull (corners, faces, edges) for contacts.
///
/// A step includes this header, so it does not use the standard library. hull_build.h fills them
/// in.
#pragma once

#include "math/vec.h"

namespace taut::sim {

inline constexpr int kMaxHullCorners = 64;  // HullDef::kMostCorners
/// Maximum number of faces, by Euler's formula for triangles.
inline constexpr int kMaxHullFaces = 2 * kMaxHullCorners - 4;
inline constexpr int kMaxHullEdges = 3 * kMaxHullCorners - 6;

/// Two corners, and the faces on both sides. In the corner list of `left`, `to` follows `from`.
struct HullEdge {
  int from, to, left, right;
};

struct HullTable {
  int corner_count = 0, face_count = 0, edge_count = 0;
  const Vec3* corners = nullptr;       ///< In the hull's frame [m].
  const Vec3* normals = nullptr;       ///< Outward unit normals of the faces.
  const double* offsets_m = nullptr;   ///< normal . x on each face, the maximum over all corners.
  const int* first_in_face = nullptr;  ///< Index in in_face; one more entry than faces.
  const int* in_face = nullptr;  ///< Corners of the faces, counterclockwise seen from outside.
  const HullEdge* edges = nullptr;
  Vec3 center;           ///< Mean of the corners.
  double bound_m = 0.0;  ///< Largest distance of a corner from the center.
  double thin_m = 0.0;   ///< Distance of the center from the nearest face.
};

}  // namespace taut::sim
