/// Convex hull of points, as faces with any number of corners.
#pragma once

#include <vector>

#include "math/triangles.h"

namespace taut::math {

/// Corners are some of the given points. Faces list them counterclockwise seen from outside; at
/// least three faces meet at each corner, and two at each edge.
struct ConvexHull {
  std::vector<Vec3> corners;
  std::vector<std::vector<int>> faces;
  double left_out_m = 0.0;  ///< Distance of the farthest point outside.
  bool too_thin = false;    ///< Faces are indistinguishable, so points stay outside.
};

/// Returns the hull of `points` with at most `most_corners` corners, chosen from the outermost
/// inwards. Points nearer to a face than a ten-millionth of the size lie in it. Returns no corners
/// if the points have no volume, or are not finite.
ConvexHull HullOf(const std::vector<Vec3>& points, int most_corners);

/// Returns the normal of a face: unit, outwards; a sum over its fan, so that rounding of single
/// corners has little effect.
Vec3 NormalOf(const std::vector<Vec3>& corners, const std::vector<int>& face);

/// Returns the faces as fans of triangles, counterclockwise seen from outside.
Triangles TrianglesOf(const ConvexHull& hull);

}  // namespace taut::math
