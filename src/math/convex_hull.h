/// The smallest convex body that holds some points, as faces with any number of corners.
#pragma once

#include <vector>

#include "math/triangles.h"

namespace taut::math {

/// Corners are some of the points that were given. Faces have them counter-clockwise seen from
/// outside; three faces or more meet in each, and two at each edge.
struct ConvexHull {
  std::vector<Vec3> corners;
  std::vector<std::vector<int>> faces;
  double left_out_m = 0.0;  ///< How far the farthest point is outside.
  bool too_thin = false;    ///< Faces cannot be told apart: points stay outside for that reason.
};

/// Of `points`, with `most_corners` corners at most: from the outermost inwards. Points that are
/// nearer than a ten-millionth of the size to a face lie in it. No corners if the points have no
/// volume, or are not finite.
ConvexHull HullOf(const std::vector<Vec3>& points, int most_corners);

/// Of a face: unit, outwards, the sum over its fan, so that rounding of single corners counts
/// little.
Vec3 NormalOf(const std::vector<Vec3>& corners, const std::vector<int>& face);

/// Its faces as fans, counter-clockwise seen from outside.
Triangles TrianglesOf(const ConvexHull& hull);

}  // namespace taut::math
