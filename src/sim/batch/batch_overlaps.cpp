/// Overlaps of shapes in the current pose of a world.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "math/rotation.h"
#include "sim/batch/batch_impl.h"
#include "sim/contacts/moving_pairs.h"
#include "sim/geometry/bvh.h"
#include "sim/geometry/convex.h"
#include "sim/geometry/shape_contacts.h"

namespace taut {
namespace {

using sim::Shape;
using sim::ShapePose;
using sim::ShapeTable;

double HalfThickness(const sim::RoundShape& shape) { return shape.radius_m; }
double HalfThickness(const sim::BoxShape& shape) {
  return std::min({shape.half_m[0], shape.half_m[1], shape.half_m[2]});
}
double HalfThickness(const sim::HullShape& shape) { return shape.table->thin_m; }
double HalfThickness(const sim::SurfaceShape&) { return 1e300; }
double HalfThicknessOf(const Shape& shape) {
  return WithShape(shape, [](const auto& s) noexcept { return HalfThickness(s); });
}

/// Returns the smallest coordinate of a shape along a direction in W.
double Lowest(const sim::RoundShape& s, const double n[3]) {
  const auto along = [n](const double p[3]) { return n[0] * p[0] + n[1] * p[1] + n[2] * p[2]; };
  return std::min(along(s.from), along(s.to)) - s.radius_m;
}
double Lowest(const sim::BoxShape& s, const double n[3]) {
  double lowest = n[0] * s.center[0] + n[1] * s.center[1] + n[2] * s.center[2];
  for (int i = 0; i < 3; ++i) {
    const double* const axis = s.axes + 3 * i;
    lowest -= s.half_m[i] * std::abs(n[0] * axis[0] + n[1] * axis[1] + n[2] * axis[2]);
  }
  return lowest;
}

double Lowest(const sim::HullShape& s, const double n[3]) {
  return sim::Convex(s).Lowest({n[0], n[1], n[2]}, 0.0);
}
double Lowest(const sim::SurfaceShape&, const double*) { return 1e300; }

class Finder {
 public:
  /// `poses`: poses of the principal frames of all bodies, then of the world.
  Finder(const sim::Tables& tables, const sim::View& view, std::vector<ShapePose> poses)
      : t_(tables), view_(view), poses_(std::move(poses)) {}

  std::vector<Overlap> Run() {
    const auto other = [&](const sim::WorldPairTable& pair) {
      return t_.shape_pairs[static_cast<std::size_t>(pair.first_pair)].b;
    };
    for (std::size_t k = 0; k < t_.world_pairs.size(); ++k) {
      const sim::WorldPairTable& pair = t_.world_pairs[k];
      // All shapes of a body on the same ground are consecutive.
      const bool goes_on = k > 0 && pair.on_ground && t_.world_pairs[k - 1].on_ground &&
                           t_.world_pairs[k - 1].a == pair.a &&
                           other(t_.world_pairs[k - 1]) == other(pair);
      if (!goes_on) {
        End();
        Begin(pair.a, pair.b == t_.body_count ? kWorld : pair.b);
      }
      for (int i = pair.first_pair; i < pair.first_pair + pair.pair_count; ++i) {
        const sim::ShapePairTable& shapes = t_.shape_pairs[static_cast<std::size_t>(i)];
        Look(static_cast<std::size_t>(shapes.a), static_cast<std::size_t>(shapes.b));
      }
    }
    End();
    LookAtMoving();
    std::vector<std::vector<std::size_t>> shapes_of(poses_.size());
    for (std::size_t i = 0; i < t_.shapes.size(); ++i) {
      shapes_of[static_cast<std::size_t>(t_.shapes[i].body)].push_back(i);
    }
    for (int body = 0; body < t_.body_count; ++body) {
      if (t_.def().bodies[static_cast<std::size_t>(body)].fixed) continue;
      for (int plane = 0; plane < t_.plane_count; ++plane) {
        Begin(body, kWorld);
        for (const std::size_t shape : shapes_of[static_cast<std::size_t>(body)]) {
          LookAtPlane(shape, plane);
        }
        End();
      }
    }
    return std::move(found_);
  }

 private:
  const ShapePose& PoseOf(const ShapeTable& shape) const {
    return poses_[static_cast<std::size_t>(shape.body)];
  }

  /// Tests all pairs of moving bodies with overlapping bounding spheres, in ascending order.
  void LookAtMoving() {
    std::vector<int> bodies;
    std::vector<sim::TreeNode> leaves;
    for (const int body : t_.colliders) {
      const double* const x = poses_[static_cast<std::size_t>(body)].origin;
      const double r = t_.bound_m[static_cast<std::size_t>(body)];
      if (!std::isfinite(x[0] + x[1] + x[2])) continue;
      bodies.push_back(body);
      leaves.push_back({{{x[0] - r, x[1] - r, x[2] - r}, {x[0] + r, x[1] + r, x[2] + r}},
                        0,
                        static_cast<int>(leaves.size())});
    }
    if (bodies.empty()) return;
    const std::vector<sim::TreeNode> bounds = leaves;
    const int count = static_cast<int>(leaves.size());
    std::vector<sim::TreeNode> tree(2 * leaves.size() - 1);
    BuildTree(leaves.data(), count, tree.data());
    std::vector<int> near;
    for (int i = 0; i < count; ++i) {
      near.clear();
      sim::EachNear(tree.data(), tree[0].next, bounds[static_cast<std::size_t>(i)].bounds, 0.0,
                    [&](int k) {
                      if (k > i) near.push_back(bodies[static_cast<std::size_t>(k)]);
                    });
      std::sort(near.begin(), near.end());
      for (const int other : near) {
        const int body = bodies[static_cast<std::size_t>(i)];
        if (AreApart(view_, body, other)) continue;
        const auto [a, b] = Ordered(view_, body, other);
        Begin(a, b);
        for (int k = view_.first_shape[a]; k < view_.first_shape[a + 1]; ++k) {
          for (int j = view_.first_shape[b]; j < view_.first_shape[b + 1]; ++j) {
            Look(static_cast<std::size_t>(view_.body_shapes[k]),
                 static_cast<std::size_t>(view_.body_shapes[j]));
          }
        }
        End();
      }
    }
  }

  void Look(std::size_t shape_a, std::size_t shape_b) {
    const ShapeTable &a = t_.shapes[shape_a], &b = t_.shapes[shape_b];
    double at_a[3], at_b[3], distance2 = 0;
    Move(PoseOf(a), a.center_P, at_a);
    Move(PoseOf(b), b.center_P, at_b);
    for (int i = 0; i < 3; ++i) distance2 += (at_a[i] - at_b[i]) * (at_a[i] - at_b[i]);
    const double reach = a.bound_m + b.bound_m;
    if (!(distance2 < reach * reach)) return;
    sim::TouchPoint points[sim::kMaxPointsPerPair];
    const int count = TouchShapes(a.shape_P, PoseOf(a), b.shape_P, PoseOf(b), 0.0, points);
    double gap_m = 0;
    for (int i = 0; i < count; ++i) gap_m = std::min(gap_m, points[i].gap_m);
    Take(-gap_m, std::min(HalfThicknessOf(a.shape_P), HalfThicknessOf(b.shape_P)),
         t_.shape_refs[shape_a], t_.shape_refs[shape_b]);
  }

  void LookAtPlane(std::size_t shape, int plane) {
    const ShapeTable& a = t_.shapes[shape];
    const sim::PlaneTable& ground = t_.planes[static_cast<std::size_t>(plane)];
    const double lowest_m = WithShape(a.shape_P, [&](const auto& s) noexcept {
      return Lowest(Moved(s, PoseOf(a)), ground.normal);
    });
    Take(ground.offset_m - lowest_m, HalfThicknessOf(a.shape_P), t_.shape_refs[shape],
         {ShapeRef::List::kPlanes, plane});
  }

  void Begin(int body_a, int body_b) {
    worst_ = {};
    worst_.body_a = body_a;
    worst_.body_b = body_b;
  }
  void Take(double depth_m, double half_thickness_m, const ShapeRef& a, const ShapeRef& b) {
    if (!(depth_m > 0)) return;
    if (worst_.depth_m * half_thickness_m >= depth_m * worst_.half_thickness_m &&
        worst_.depth_m > 0) {
      return;
    }
    worst_.a = a, worst_.b = b;
    worst_.depth_m = depth_m;
    worst_.half_thickness_m = half_thickness_m;
  }
  void End() {
    if (worst_.depth_m > 0) found_.push_back(worst_);
  }

  const sim::Tables& t_;
  const sim::View& view_;
  std::vector<ShapePose> poses_;
  Overlap worst_;  ///< Worst overlap of the current pair of bodies.
  std::vector<Overlap> found_;
};

}  // namespace

std::vector<Overlap> WorldBatch::Overlaps(int world) const {
  const Impl& d = *impl_;
  d.CheckWorld(__func__, world);
  std::vector<ShapePose> poses;
  for (int body = 0; body < d.view.body_count; ++body) {
    const Vec3 p = d.vec(world, d.layout.pos + 3 * body);
    ShapePose pose{{}, {p.x, p.y, p.z}};
    MatrixOf(d.quat(world, body), pose.r);
    poses.push_back(pose);
  }
  poses.push_back({{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}});
  return Finder(*d.model, d.view, std::move(poses)).Run();
}

}  // namespace taut
