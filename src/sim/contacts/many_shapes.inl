/// Broad phase of a body in a world of many static shapes. Each lane searches the bounding volume
/// hierarchy (BVH) for near shapes, finds their contacts, and stores a clearance for all other
/// shapes.
#pragma once

#include "sim/contacts/joined_boxes.inl"
#include "sim/contacts/shape_pairs.inl"
#include "sim/contacts/slots.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Finds the contacts with the shapes near a body in one lane, in the order of their pairs. Returns
/// the clearance, a lower bound of the distance to all static shapes. `kJoined`: some shapes are
/// adjacent.
template <bool kJoined, class W>
double CollideNear(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                   const WorldPairTable& bodies, double margin, double step_s, int lane,
                   SlotFiller<W>* slots, uint32_t* overflow) noexcept {
  const ShapePose at = LanePose(m, s, work, bodies.a, lane);
  const ShapePose world = LanePose(m, s, work, bodies.b, lane);
  // Touching shapes have a gap below the margin. The tolerance is slightly larger, because distance
  // and gap may differ by rounding.
  const double touch_m = margin + kContactMarginM;
  double clearance = kLookAheadSteps * margin;
  const int words = (m.tree_shapes + 63) / 64;
  for (int i = 0; i < words; ++i) work.near[i] = 0;
  [[maybe_unused]] NearPairs<W> together(m, s, g, work, margin, step_s, lane, slots, overflow);
  const ShapePairTable* pairs = m.shape_pairs + bodies.first_pair;
  const ShapePairTable* const end = pairs + bodies.pair_count;
  for (; pairs != end; pairs += m.tree_shapes) {
    const Shape shape = MovedShape(m.shapes[pairs->a].shape_P, at);
    double reach = clearance < touch_m ? touch_m : clearance;
    MarkNear(m.tree, m.tree_nodes, BoundsOf(shape), reach, work.near);
    for (int i = 0; i < words; ++i) {
      for (; work.near[i] != 0; work.near[i] &= work.near[i] - 1) {
        const ShapePairTable& pair = pairs[64 * i + __builtin_ctzll(work.near[i])];
        const ShapeTable& other = m.shapes[pair.b];
        if (!MayReach(shape, other.center_P, other.bound_m, reach)) continue;
        const double distance = DistanceOfShapes(shape, world, other.shape_P, world);
        if (distance < clearance) {
          clearance = distance;
          reach = clearance < touch_m ? touch_m : clearance;
        }
        if (!(distance < touch_m)) continue;
        if constexpr (kJoined) {
          together.Add(pair);
        } else {
          PutTouches(m, s, g, work, pair, lane, margin, step_s, slots, overflow);
        }
      }
    }
    if constexpr (kJoined) together.Flush();
  }
  return clearance;
}

template <class W>
void CollideManyShapes(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work, int pair,
                       double step_s, W since_last, SlotFiller<W>* slots,
                       uint32_t* overflow) noexcept {
  const WorldPairTable& bodies = m.world_pairs[pair];
  W margin;
  const auto near = ClearanceUsedUp(work, bodies.a, bodies.b, s.clearance[pair], W::Splat(step_s),
                                    since_last, margin);
  if (!Any(near)) return;
  for (int lane = 0; lane < W::kLanes; ++lane) {
    if (!near[lane]) continue;
    const double clearance = bodies.joined ? CollideNear<true>(m, s, g, work, bodies, margin[lane],
                                                               step_s, lane, slots, overflow)
                                           : CollideNear<false>(m, s, g, work, bodies, margin[lane],
                                                                step_s, lane, slots, overflow);
    s.clearance[pair].Set(lane, clearance);
  }
}

}  // namespace taut::sim
