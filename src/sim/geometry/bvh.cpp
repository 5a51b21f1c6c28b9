// Bounds and construction of the bounding volume hierarchy (BVH) of the broad phase.
#include "sim/geometry/bvh.h"

#include <algorithm>

#include "sim/geometry/convex.h"

namespace taut::sim {
namespace {

double Magnitude(double x) noexcept { return x < 0 ? -x : x; }

Bounds Around(const Bounds& a, const Bounds& b) noexcept {
  Bounds both;
  for (int i = 0; i < 3; ++i) {
    both.low[i] = std::min(a.low[i], b.low[i]);
    both.high[i] = std::max(a.high[i], b.high[i]);
  }
  return both;
}

double TwiceCenter(const TreeNode& node, int axis) noexcept {
  return node.bounds.low[axis] + node.bounds.high[axis];
}

/// Returns the axis along which the centers of the leaves are spread most.
int WidestAxis(const TreeNode* leaves, int count) noexcept {
  int widest = 0;
  double width = -1;
  for (int axis = 0; axis < 3; ++axis) {
    double least = TwiceCenter(leaves[0], axis), most = least;
    for (int i = 1; i < count; ++i) {
      least = std::min(least, TwiceCenter(leaves[i], axis));
      most = std::max(most, TwiceCenter(leaves[i], axis));
    }
    if (most - least > width) widest = axis, width = most - least;
  }
  return widest;
}

Bounds BoundsOf(const RoundShape& shape) noexcept {
  Bounds bounds;
  for (int i = 0; i < 3; ++i) {
    const bool rises = shape.from[i] < shape.to[i];
    bounds.low[i] = (rises ? shape.from[i] : shape.to[i]) - shape.radius_m;
    bounds.high[i] = (rises ? shape.to[i] : shape.from[i]) + shape.radius_m;
  }
  return bounds;
}

Bounds BoundsOf(const BoxShape& shape) noexcept {
  Bounds bounds;
  for (int i = 0; i < 3; ++i) {
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
      reach += Magnitude(shape.axes[3 * axis + i]) * shape.half_m[axis];
    }
    bounds.low[i] = shape.center[i] - reach;
    bounds.high[i] = shape.center[i] + reach;
  }
  return bounds;
}

Bounds BoundsOf(const HullShape& shape) noexcept {
  Vec3 low, high;
  Convex(shape).Bounds(&low, &high);
  return {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
}

/// Surfaces have their own search structure and are in no tree.
Bounds BoundsOf(const SurfaceShape&) noexcept { return {}; }

/// Returns the squared distance of a point from a centerline or a box.
double SkeletonDistance2(const RoundShape& shape, const double* p) noexcept {
  double line[3], to_p[3], length2 = 0, along = 0;
  for (int i = 0; i < 3; ++i) {
    line[i] = shape.to[i] - shape.from[i];
    to_p[i] = p[i] - shape.from[i];
    length2 += line[i] * line[i];
    along += line[i] * to_p[i];
  }
  const double share = along <= 0 ? 0.0 : along >= length2 ? 1.0 : along / length2;
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double d = to_p[i] - share * line[i];
    sum += d * d;
  }
  return sum;
}

double SkeletonDistance2(const BoxShape& shape, const double* p) noexcept {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double* const u = shape.axes + 3 * axis;
    double at = 0;
    for (int i = 0; i < 3; ++i) at += u[i] * (p[i] - shape.center[i]);
    const double beyond = Magnitude(at) - shape.half_m[axis];
    if (beyond > 0) sum += beyond * beyond;
  }
  return sum;
}

/// Returns a lower bound from the bounding ball of the hull.
double SkeletonDistance2(const HullShape& shape, const double* p) noexcept {
  const Vec3 own = shape.table->center;
  const double center[3] = {own.x, own.y, own.z};
  double moved[3];
  Move(shape.at, center, moved);
  const double beyond = Larger(Norm(Load(p) - Load(moved)) - shape.table->bound_m, 0.0);
  return beyond * beyond;
}

double SkeletonDistance2(const SurfaceShape&, const double*) noexcept { return 0.0; }

}  // namespace

Shape MovedShape(const Shape& shape, const ShapePose& pose) noexcept {
  Shape moved;
  moved.kind = shape.kind;
  switch (shape.kind) {
    case ShapeKind::kRound:
      moved.round = Moved(shape.round, pose);
      break;
    case ShapeKind::kBox:
      moved.box = Moved(shape.box, pose);
      break;
    case ShapeKind::kHull:
      moved.hull = Moved(shape.hull, pose);
      break;
    case ShapeKind::kSurface:
      moved.surface = shape.surface;
      break;
  }
  return moved;
}

Bounds BoundsOf(const Shape& shape) noexcept {
  return WithShape(shape, [](const auto& kind) noexcept { return BoundsOf(kind); });
}

bool MayReach(const Shape& shape, const double* center, double radius_m, double reach_m) noexcept {
  const double far_m = radius_m + reach_m + RadiusOf(shape);
  const double distance2 =
      WithShape(shape, [&](const auto& kind) noexcept { return SkeletonDistance2(kind, center); });
  return distance2 <= far_m * far_m;
}

void BuildTree(TreeNode* leaves, int count, TreeNode* tree) noexcept {
  // Nodes refer to each other by number; a subtree of n leaves has 2 n - 1 nodes.
  struct Builder {
    TreeNode* const first;
    void Build(TreeNode* leaves, int count, TreeNode* node) const noexcept {
      *node = *leaves;
      node->next = static_cast<int>(node - first) + 2 * count - 1;
      if (count == 1) return;
      node->shape = -1;
      const int axis = WidestAxis(leaves, count);
      for (int i = 1; i < count; ++i) node->bounds = Around(node->bounds, leaves[i].bounds);
      const int half = count / 2;
      std::nth_element(leaves, leaves + half, leaves + count,
                       [axis](const TreeNode& a, const TreeNode& b) {
                         return TwiceCenter(a, axis) < TwiceCenter(b, axis);
                       });
      Build(leaves, half, node + 1);
      Build(leaves + half, count - half, node + 2 * half);
    }
  };
  Builder{tree}.Build(leaves, count, tree);
}

void MarkNear(const TreeNode* tree, int count, const Bounds& bounds, double reach_m,
              uint64_t* marks) noexcept {
  EachNear(tree, count, bounds, reach_m,
           [&](int shape) noexcept { marks[shape / 64] |= uint64_t{1} << (shape % 64); });
}

}  // namespace taut::sim
