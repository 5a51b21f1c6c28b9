/// Bounding volume hierarchy (BVH) of static shapes or of moving bodies, for the broad phase.
///
/// A tree replaces a uniform grid, because no cell size suits terrain with stones next to walls of
/// many meters.
#pragma once

#include <stdint.h>

#include "sim/geometry/shapes.h"

namespace taut::sim {

/// Axis-aligned bounding box in W [m].
struct Bounds {
  double low[3], high[3];
};

/// Node of the tree in depth-first order. All nodes after this one, up to `next`, are inside it.
struct TreeNode {
  Bounds bounds;
  int next = 0;    ///< First node after the subtree.
  int shape = -1;  ///< Leaf: index of the shape or body; otherwise -1.
};

/// Builds the tree of `count` leaves, at least one, in 2 * count - 1 nodes. Reorders the leaves.
/// The bounds of the leaves must be finite.
void BuildTree(TreeNode* leaves, int count, TreeNode* tree) noexcept;

Shape MovedShape(const Shape& shape, const ShapePose& pose) noexcept;
Bounds BoundsOf(const Shape& shape) noexcept;

/// Returns false only if a shape is farther than `reach_m` from a ball.
bool MayReach(const Shape& shape, const double* center, double radius_m, double reach_m) noexcept;

/// Returns whether two boxes are at most `reach_m` apart along every axis. False if a number is not
/// finite, since nothing is near such a shape.
inline bool Near(const Bounds& a, const Bounds& b, double reach_m) noexcept {
  for (int i = 0; i < 3; ++i) {
    if (!(a.low[i] - b.high[i] <= reach_m && b.low[i] - a.high[i] <= reach_m)) return false;
  }
  return true;
}

/// Calls `use(index)` for each shape with bounds at most `reach_m` from `bounds` along every axis.
template <class Use>
void EachNear(const TreeNode* tree, int count, const Bounds& bounds, double reach_m,
              const Use& use) noexcept {
  for (int i = 0; i < count;) {
    const TreeNode& node = tree[i];
    if (!Near(node.bounds, bounds, reach_m)) {
      i = node.next;
      continue;
    }
    if (node.shape >= 0) use(node.shape);
    ++i;
  }
}

/// Sets a bit for each shape i that EachNear visits: bit i % 64 of marks[i / 64].
void MarkNear(const TreeNode* tree, int count, const Bounds& bounds, double reach_m,
              uint64_t* marks) noexcept;

}  // namespace taut::sim
