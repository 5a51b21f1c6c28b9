/// Convex hull of points, with polygonal faces.
#pragma once

#include <vector>

#include "math/triangles.h"

namespace taut::math {

/// The corners are a subset of the points. Faces list corners counterclockwise seen from outside.
/// At least three faces meet at each corner, and two at each edge.
struct ConvexHull {
  std::vector<Vec3> corners;
  std::vector<std::vector<int>> faces;
  double left_out_m = 0.0;  ///< Distance of the farthest point that is outside of the hull.
  /// The body is too thin to distinguish its faces, so points remain outside.
  bool too_thin = false;
};

/// Returns the hull of `points` with at most `most_corners` corners, added from the outermost
/// inward. Points closer to a face than 1e-7 of the size count as in it. Returns no corners if the
/// points are coplanar or not finite.
ConvexHull HullOf(const std::vector<Vec3>& points, int most_corners);

/// Returns the outward unit normal of a face. The normal is the normalized sum over a triangle fan,
/// so that rounding of single corners has little effect.
Vec3 NormalOf(const std::vector<Vec3>& corners, const std::vector<int>& face);

/// Returns the faces as triangle fans, counterclockwise seen from outside.
Triangles TrianglesOf(const ConvexHull& hull);

}  // namespace taut::math
