// Bounding volume hierarchy (BVH) of static shapes (bvh.h), and boxes that touch each other.
#include <algorithm>
#include <utility>

#include "base/assert.h"
#include "sim/data/tables.h"
#include "sim/geometry/shape_contacts.h"

namespace taut::sim {
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
  t.tree.resize(2 * leaves.size() - 1);
  BuildTree(leaves.data(), t.tree_shapes, t.tree.data());
  for (WorldPairTable& pair : t.world_pairs) {
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
  for (WorldPairTable& pair : t.world_pairs) {
    pair.joined = pair.b == t.body_count && !pair.on_ground;
  }
}

}  // namespace taut::sim
