/// Construction of the contact tables of a convex hull from its corners and faces.
#pragma once

#include <memory>
#include <vector>

#include "math/convex_hull.h"
#include "sim/geometry/hull.h"

namespace taut::sim {

class Hull {
 public:
  /// `hull` has at most kMaxHullCorners corners.
  explicit Hull(math::ConvexHull hull);

  /// Moving the hull does not change this address.
  const HullTable& table() const { return *table_; }

 private:
  std::unique_ptr<HullTable> table_ = std::make_unique<HullTable>();
  std::vector<Vec3> corners_, normals_;
  std::vector<double> offsets_m_;
  std::vector<int> first_in_face_, in_face_;
  std::vector<HullEdge> edges_;
};

}  // namespace taut::sim
