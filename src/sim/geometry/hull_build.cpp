// Construction of the contact tables of a convex hull.
#include "sim/geometry/hull_build.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/assert.h"
#include "taut/model_def.h"

namespace taut::sim {

static_assert(kMaxHullCorners == HullDef::kMostCorners);

Hull::Hull(math::ConvexHull hull) : corners_(std::move(hull.corners)) {
  std::map<std::pair<int, int>, int> left_of;
  for (const std::vector<int>& face : hull.faces) {
    const int number = static_cast<int>(normals_.size());
    first_in_face_.push_back(static_cast<int>(in_face_.size()));
    in_face_.insert(in_face_.end(), face.begin(), face.end());
    for (std::size_t i = 0; i < face.size(); ++i) {
      left_of[{face[i], face[(i + 1) % face.size()]}] = number;
    }
    const Vec3 n = math::NormalOf(corners_, face);
    double offset_m = -1e300;
    for (const Vec3& p : corners_) offset_m = std::max(offset_m, Dot(n, p));
    normals_.push_back(n);
    offsets_m_.push_back(offset_m);
  }
  first_in_face_.push_back(static_cast<int>(in_face_.size()));
  for (const auto& [edge, left] : left_of) {
    if (edge.first > edge.second) continue;
    edges_.push_back({edge.first, edge.second, left, left_of.at({edge.second, edge.first})});
  }
  HullTable& t = *table_;
  t.corner_count = static_cast<int>(corners_.size());
  t.face_count = static_cast<int>(normals_.size());
  t.edge_count = static_cast<int>(edges_.size());
  TAUT_ASSERT(t.corner_count <= kMaxHullCorners && t.face_count <= kMaxHullFaces &&
              t.edge_count <= kMaxHullEdges);
  t.corners = corners_.data();
  t.normals = normals_.data();
  t.offsets_m = offsets_m_.data();
  t.first_in_face = first_in_face_.data();
  t.in_face = in_face_.data();
  t.edges = edges_.data();
  for (const Vec3& p : corners_) t.center = t.center + p;
  t.center = (1.0 / t.corner_count) * t.center;
  for (const Vec3& p : corners_) {
    const Vec3 d = p - t.center;
    t.bound_m = std::max(t.bound_m, std::sqrt(Dot(d, d)));
  }
  t.thin_m = t.bound_m;
  for (std::size_t face = 0; face < normals_.size(); ++face) {
    t.thin_m = std::min(t.thin_m, offsets_m_[face] - Dot(normals_[face], t.center));
  }
}

}  // namespace taut::sim
