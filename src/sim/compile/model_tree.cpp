// Construction of the bounding volume hierarchy (BVH) of static shapes (bvh.h).
#include <algorithm>
#include <utility>

#include "base/assert.h"
#include "sim/data/tables.h"
#include "sim/geometry/shape_contacts.h"

namespace taut::sim {
namespace {

Bounds Around(const Bounds& a, const Bounds& b) {
  Bounds both;
  for (int i = 0; i < 3; ++i) {
    both.low[i] = std::min(a.low[i], b.low[i]);
    both.high[i] = std::max(a.high[i], b.high[i]);
  }
  return both;
}

/// Appends the tree of the given leaves, split at the median along the axis of their largest
/// spread.
void Append(TreeNode* first, TreeNode* last, std::vector<TreeNode>& tree) {
  const std::size_t at = tree.size();
  tree.push_back(*first);
  if (last - first > 1) {
    TreeNode& node = tree.back();
    node.shape = -1;
    const auto twice_center = [](const TreeNode& n, int axis) {
      return n.bounds.low[axis] + n.bounds.high[axis];
    };
    int widest = 0;
    double width = -1;
    for (int axis = 0; axis < 3; ++axis) {
      const auto [least, most] =
          std::minmax_element(first, last, [&](const auto& a, const auto& b) {
            return twice_center(a, axis) < twice_center(b, axis);
          });
      const double spread = twice_center(*most, axis) - twice_center(*least, axis);
      if (spread > width) widest = axis, width = spread;
    }
    for (const TreeNode* leaf = first; leaf != last; ++leaf) {
      node.bounds = Around(node.bounds, leaf->bounds);
    }
    TreeNode* const middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, [&](const auto& a, const auto& b) {
      return twice_center(a, widest) < twice_center(b, widest);
    });
    Append(first, middle, tree);
    Append(middle, last, tree);
  }
  tree[at].next = static_cast<int>(tree.size());
}

}  // namespace

void LayOutTree(Tables& t) {
  std::vector<TreeNode> leaves;
  for (std::size_t i = 0; i < t.shapes.size(); ++i) {
    const ShapeTable& shape = t.shapes[i];
    if (shape.body != t.body_count || shape.shape_P.kind == ShapeKind::kSurface) continue;
    leaves.push_back({BoundsOf(shape.shape_P), 0, static_cast<int>(leaves.size())});
    t.world_shapes.push_back(static_cast<int>(i));
  }
  if (leaves.size() <= static_cast<std::size_t>(kFewShapes)) return;
  t.tree_shapes = static_cast<int>(leaves.size());
  Append(leaves.data(), leaves.data() + leaves.size(), t.tree);
  for (BodyPairTable& pair : t.body_pairs) {
    pair.by_tree = pair.b == t.body_count && !pair.on_ground;
    TAUT_ASSERT(!pair.by_tree || pair.pair_count % t.tree_shapes == 0);
  }
}

void JoinBoxes(Tables& t) {
  std::vector<int> boxes;
  for (std::size_t i = 0; i < t.shapes.size(); ++i) {
    const ShapeTable& shape = t.shapes[i];
    if (shape.body != t.body_count || shape.shape_P.kind != ShapeKind::kBox) continue;
    boxes.push_back(static_cast<int>(i));
  }
  const auto of = [&](int box) -> ShapeTable& { return t.shapes[static_cast<std::size_t>(box)]; };
  // Sweep and prune along x: tests only boxes with overlapping extents.
  std::vector<Bounds> bounds;
  for (const int box : boxes) bounds.push_back(BoundsOf(of(box).shape_P));
  std::vector<std::size_t> order(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(bounds[a].low[0], a) < std::pair(bounds[b].low[0], b);
  });
  std::vector<std::vector<int>> beside(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t k = i + 1; k < order.size(); ++k) {
      const std::size_t a = order[i], b = order[k];
      if (bounds[b].low[0] - bounds[a].high[0] > kJoinedM) break;
      if (!(Distance(of(boxes[a]).shape_P.box, of(boxes[b]).shape_P.box) <= kJoinedM)) continue;
      beside[a].push_back(boxes[b]);
      beside[b].push_back(boxes[a]);
    }
  }
  std::size_t all = 0;
  for (const std::vector<int>& list : beside) all += list.size();
  if (all == 0) return;
  t.beside.reserve(all);  // shapes contain pointers to it, so it must not be reallocated
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    std::sort(beside[i].begin(), beside[i].end());
    of(boxes[i]).beside = t.beside.data() + t.beside.size();
    of(boxes[i]).beside_count = static_cast<int>(beside[i].size());
    t.beside.insert(t.beside.end(), beside[i].begin(), beside[i].end());
  }
  for (BodyPairTable& pair : t.body_pairs) pair.joined = pair.b == t.body_count && !pair.on_ground;
}

}  // namespace taut::sim
