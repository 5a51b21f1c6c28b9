/// Contacts of one shape with adjacent static boxes, in one lane: computes all points, then selects
/// the contacts with the union of the boxes (joined_boxes.h).
#pragma once

#include "sim/contacts/joined_boxes.h"
#include "sim/contacts/rod_distance.inl"
#include "sim/contacts/shape_pairs.inl"
#include "sim/contacts/slots.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Static shapes near a shape, in the order of their pairs.
template <class W>
class NearPairs {
 public:
  NearPairs(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work, double margin,
            double step_s, int lane, SlotFiller<W>* slots, uint32_t* overflow) noexcept
      : m_(m),
        s_(s),
        g_(g),
        work_(work),
        margin_(margin),
        step_s_(step_s),
        lane_(lane),
        slots_(slots),
        overflow_(overflow) {}

  void Add(const ShapePairTable& pair) noexcept {
    if (pair_count_ == kMostJoinedPairs) Flush();
    pairs_[pair_count_++] = &pair;
  }
  /// Finds the contacts and stores them in slots.
  void Flush() noexcept {
    bool joined = false;
    for (int i = 0; i < pair_count_; ++i) {
      joined = joined || m_.shapes[pairs_[i]->b].IsJoined();
    }
    if (!joined) {
      for (int i = 0; i < pair_count_; ++i) {
        PutTouches(m_, s_, g_, work_, *pairs_[i], lane_, margin_, step_s_, slots_, overflow_);
      }
    } else {
      PutJoined();
    }
    pair_count_ = 0;
  }

 private:
  void PutJoined() noexcept {
    JoinedPoint points[kMostJoinedPoints];
    TouchPoint found[kMaxPointsPerPair];
    int count = 0;
    for (int i = 0; i < pair_count_; ++i) {
      const int box = pairs_[i]->b;
      if (!m_.shapes[box].IsJoined()) continue;
      const int here = TouchLane(m_, s_, work_, *pairs_[i], lane_, margin_, found);
      for (int k = 0; k < here; ++k) points[count++] = {found[k], box, true};
    }
    const ShapeTable& shape = m_.shapes[pairs_[0]->a];
    MarkKept(MovedShape(shape.shape_P, LanePose(m_, s_, work_, shape.body, lane_)), m_.shapes,
             points, count);
    int next = 0;
    for (int i = 0; i < pair_count_; ++i) {
      const int box = pairs_[i]->b;
      if (!m_.shapes[box].IsJoined()) {
        PutTouches(m_, s_, g_, work_, *pairs_[i], lane_, margin_, step_s_, slots_, overflow_);
        continue;
      }
      int kept = 0;
      for (; next < count && points[next].box == box; ++next) {
        if (points[next].kept) found[kept++] = points[next].touch;
      }
      PutPoints<W>(m_, s_, g_, work_, *pairs_[i], lane_, step_s_, nullptr, found, kept, slots_,
                   overflow_);
    }
  }

  const View& m_;
  const Rows<W>& s_;
  const Group& g_;
  Scratch<W>& work_;
  double margin_, step_s_;
  int lane_;
  SlotFiller<W>* slots_;
  uint32_t* overflow_;
  const ShapePairTable* pairs_[kMostJoinedPairs];
  int pair_count_ = 0;
};

/// Finds the contacts of a body in a world of few shapes with adjacent boxes.
template <class W>
void CollideJoined(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                   const WorldPairTable& bodies, W margin, double step_s, SlotFiller<W>* slots,
                   uint32_t* overflow) noexcept {
  for (int lane = 0; lane < W::kLanes; ++lane) {
    NearPairs<W> near(m, s, g, work, margin[lane], step_s, lane, slots, overflow);
    int shape = -1;
    for (int k = 0; k < bodies.pair_count; ++k) {
      const ShapePairTable& pair = m.shape_pairs[bodies.first_pair + k];
      if (pair.a != shape) near.Flush();
      shape = pair.a;
      const V3<W> d = ShapeCenter(m, s, work, pair.a) - ShapeCenter(m, s, work, pair.b);
      const double reach = m.shapes[pair.a].bound_m + m.shapes[pair.b].bound_m + margin[lane];
      if (Dot(d, d)[lane] < reach * reach) near.Add(pair);
    }
    near.Flush();
  }
}

}  // namespace taut::sim
