/// A hull with all that contacts need, from its corners.
#pragma once

#include <memory>
#include <vector>

#include "math/convex_hull.h"
#include "sim/geometry/hull.h"

namespace taut::sim {

class Hull {
 public:
  /// With kMaxHullCorners corners at most.
  explicit Hull(math::ConvexHull hull);

  /// Stays where it is, if the hull is moved, too.
  const HullTable& table() const { return *table_; }

 private:
  std::unique_ptr<HullTable> table_ = std::make_unique<HullTable>();
  std::vector<Vec3> corners_, normals_;
  std::vector<double> offsets_m_;
  std::vector<int> first_in_face_, in_face_;
  std::vector<HullEdge> edges_;
};

}  // namespace taut::sim
