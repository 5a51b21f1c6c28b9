/// Broad phase of moving bodies in large models: lists of near bodies (Verlet lists), so that the
/// cost of a step and the memory of a world do not grow with the square of the number of bodies.
///
/// A search with a bounding volume hierarchy (BVH) finds all bodies within a distance of each
/// other. Pairs that it does not find cannot touch until two bodies together have moved by that
/// distance. Only the pairs in the list are tested. A test of all pairs has bit-identical results:
/// the list never lacks a pair that may touch, and it ascends like all pairs. A group of worlds has
/// one list with the pairs of all lanes. For one lane, the other lanes therefore only add pairs
/// that do not touch.
#pragma once

#include "sim/contacts/body_distance.inl"
#include "sim/contacts/moving_pairs.h"
#include "sim/contacts/slots.inl"
#include "sim/data/rows.h"
#include "sim/geometry/bvh.h"

namespace taut::sim {

/// Tolerance of displacements and distances for rounding [1].
inline constexpr double kNearRounding = 1e-7;

/// Returns upper bounds of the motion of all points of a body: since the last search, plus in this
/// step at the current velocities [m].
template <class W>
TAUT_INLINE W MotionSinceSearch(const View& m, const Rows<W>& s, const Scratch<W>& work, int body,
                                W h) noexcept {
  const V3<W> d = s.pos[body] - s.near_pos[body];
  const Q4<W>&q = s.quat[body], &p = s.near_quat[body];
  // Cosine of half the rotation angle x. A point at distance r moves by 2 r sin(x / 2).
  const W cosine = q.w * p.w + q.x * p.x + q.y * p.y + q.z * p.z;
  const W sine2 =
      Max(W::Splat(1.0 + kNearRounding * kNearRounding) - cosine * cosine, W::Splat(0.0));
  const BodyWork<W>& b = work.bodies[body];
  return Sqrt(Dot(d, d)) + W::Splat(2.0 * m.bound_m[body]) * Sqrt(sine2) +
         (h * Norm1(b.v) + b.turns);
}

/// Returns the bounds of the bounding sphere of a body in a lane.
template <class W>
Bounds SphereBounds(const View& m, const Rows<W>& s, int body, int lane) noexcept {
  constexpr double kFar_m = 1e30;  // replaces coordinates that are not finite
  const V3<W>& x = s.pos[body];
  const double center[3] = {x.x[lane], x.y[lane], x.z[lane]};
  Bounds bounds;
  for (int k = 0; k < 3; ++k) {
    const double at = -kFar_m < center[k] && center[k] < kFar_m ? center[k] : kFar_m;
    bounds.low[k] = at - m.bound_m[body];
    bounds.high[k] = at + m.bound_m[body];
  }
  return bounds;
}

/// Builds a BVH of the bounding spheres of all bodies in each lane.
template <class W>
void BuildNearTrees(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept {
  const int n = m.collider_count;
  for (int lane = 0; lane < W::kLanes; ++lane) {
    for (int i = 0; i < n; ++i) {
      work.near_leaves[i] = {SphereBounds(m, s, m.colliders[i], lane), 0, i};
    }
    BuildTree(work.near_leaves, n, work.near_tree + 2 * n * lane);
  }
}

/// Calls use(bodies) for each pair of bodies within the distance `reach_m` in some lane, ascending,
/// until `use` returns false; then returns false, otherwise true. Needs the trees of
/// BuildNearTrees.
template <class W, class Use>
bool EachNearPair(const View& m, const Rows<W>& s, Scratch<W>& work, W reach_m,
                  const Use& use) noexcept {
  const int n = m.collider_count, words = (n + 63) / 64;
  for (int i = 0; i < n; ++i) {
    const int a = m.colliders[i];
    for (int w = i / 64; w < words; ++w) work.near_marks[w] = 0;
    for (int lane = 0; lane < W::kLanes; ++lane) {
      const TreeNode* const tree = work.near_tree + 2 * n * lane;
      MarkNear(tree, tree[0].next, SphereBounds(m, s, a, lane), reach_m[lane], work.near_marks);
    }
    work.near_marks[i / 64] &= ~(~uint64_t{0} >> (63 - i % 64));  // keeps later bodies only
    for (int w = i / 64; w < words; ++w) {
      for (; work.near_marks[w] != 0; work.near_marks[w] &= work.near_marks[w] - 1) {
        const int b = m.colliders[64 * w + __builtin_ctzll(work.near_marks[w])];
        const V3<W> d = s.pos[a] - s.pos[b];
        const W limit = W::Splat(m.bound_m[a] + m.bound_m[b]) + reach_m;
        if (!Any(!(Dot(d, d) > limit * limit)) || AreApart(m, a, b)) continue;
        if (!use(Ordered(m, a, b))) return false;
      }
    }
  }
  return true;
}

/// Lists all pairs within the distance `reach_m`. Returns false if the list is too short.
template <class W>
bool ListNear(const View& m, const Rows<W>& s, Group& g, Scratch<W>& work, W reach_m) noexcept {
  g.near_count = 0;
  return EachNearPair(m, s, work, reach_m, [&](const MovingPair& bodies) {
    const auto lanes = MaskOf<W>::Splat(true);
    if (!Any(DistanceOfBodies(m, s, work, bodies, lanes).least < reach_m)) return true;
    if (g.near_count == m.near_capacity) return false;
    g.near[g.near_count++] = bodies;
    return true;
  });
}

/// Makes the list of near bodies again if a pair that is not in it may touch in this step. If the
/// list is too short, sets Group::near_count to -1. In this case, the trees are built in every
/// step, and near_m[0] is the distance for EachNearPair.
template <class W>
void FindNear(const View& m, const Rows<W>& s, Group& g, Scratch<W>& work, W h) noexcept {
  const W two = W::Splat(2.0 + kNearRounding), least = W::Splat(2.0 * kContactMarginM);
  if (g.near_count >= 0) {
    W most = W::Splat(0.0);
    for (int i = 0; i < m.collider_count; ++i) {
      most = Max(MotionSinceSearch(m, s, work, m.colliders[i], h), most);
    }
    if (!Any(!(two * most + least < s.near_m[0]))) return;
  }
  W reach = W::Splat(0.0);
  for (int i = 0; i < m.collider_count; ++i) {
    const int body = m.colliders[i];
    const BodyWork<W>& b = work.bodies[body];
    reach = Max(h * Norm1(b.v) + b.turns, reach);
    s.near_pos[body] = s.pos[body], s.near_quat[body] = s.quat[body];
  }
  BuildNearTrees(m, s, work);
  for (int i = 0; i < m.near_capacity; ++i) s.clearance[m.world_pair_count + i] = W::Splat(0.0);
  // For fast bodies, the list must last for several steps.
  constexpr double kSteps = 4.0;
  s.near_m[0] = two * Max(W::Splat(kSteps) * reach, reach + W::Splat(m.near_m)) + least;
  if (ListNear(m, s, g, work, s.near_m[0])) return;
  s.near_m[0] = two * reach + (least + least);
  if (ListNear(m, s, g, work, s.near_m[0])) return;
  g.near_count = -1;
}

}  // namespace taut::sim
