/// Storage of detected contacts: in the slots of a body if the other body is static, otherwise in
/// the list of contacts of moving bodies (touches) of the lane. Clearances are lower bounds of
/// distances; they delay the next distance query of two bodies.
#pragma once

#include "sim/contacts/shape_pairs.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Contact detection margin, in addition to the motion of the bodies in a step [m].
inline constexpr double kContactMarginM = 1e-5;

/// Distance queries search up to the approach in this number of steps at the current velocity.
inline constexpr double kLookAheadSteps = 16.0;

/// Detected contact with the world, per lane.
template <class W>
struct Found {
  W key, frame, gap, radius, static_friction, kinetic_friction, restitution;
  V3<W> n, t1, t2, arm;
  bool upright;
};

template <class W, class M>
TAUT_INLINE void PutContact(Contact<W, 1>& slot, const Found<W>& found, M lanes) noexcept {
  const auto put = [lanes](W& to, W from) { to = Select(lanes, from, to); };
  const auto put3 = [lanes](V3<W>& to, const V3<W>& from) { to = Select3(lanes, from, to); };
  V3<W>* const d = slot.links[0].lin;
  put3(d[0], found.n), put3(d[1], found.t1), put3(d[2], found.t2);
  put3(slot.arm[0], found.arm);
  put(slot.key, found.key), put(slot.frame, found.frame), put(slot.gap, found.gap);
  put(slot.radius, found.radius);
  put(slot.static_friction, found.static_friction);
  put(slot.kinetic_friction, found.kinetic_friction);
  put(slot.restitution, found.restitution);
}

/// Stores the contacts of one body with the world in its slots.
template <class W>
class SlotFiller {
 public:
  SlotFiller(const View& m, Scratch<W>& work, int body) noexcept
      : slots_(work.contacts + m.first_slot[body]),
        capacity_(m.first_slot[body + 1] - m.first_slot[body]),
        one_direction_(m.along_slip) {}

  /// Stores `found` in the next free slot of each of `lanes`. There is room for all points on all
  /// planes.
  template <class M>
  TAUT_INLINE void Add(const Found<W>& found, M lanes) noexcept {
    const int last = count_;
    for (int k = W::kLanes == 1 ? last : 0; k <= last; ++k) {
      const auto here = lanes & (used_ == W::Splat(k));
      if (Any(here)) Put(k, found, here);
    }
    used_ += Select(lanes, W::Splat(1.0), W::Splat(0.0));
  }
  /// Same as above for one lane. Returns false if the lane has no free slot.
  bool Add(const Found<W>& found, int lane) noexcept {
    const int k = static_cast<int>(used_[lane]);
    if (k == capacity_) return false;
    auto here = MaskOf<W>::Splat(false);
    here.Set(lane, true);
    Put(k, found, here);
    used_.Set(lane, k + 1);
    return true;
  }
  int count() const noexcept { return count_; }

 private:
  template <class M>
  TAUT_INLINE void Put(int k, const Found<W>& found, M here) noexcept {
    Contact<W, 1>& slot = slots_[k];
    if (k == count_) {
      // Lanes without this contact get valid numbers and `live` = 0.
      ++count_;
      slot.one_direction = one_direction_;
      slot.directed = false;
      slot.upright = found.upright;
      slot.live = W::Splat(0.0);
      PutContact(slot, found, MaskOf<W>::Splat(true));
      slot.key = Select(here, found.key, W::Splat(kNoKey));
    } else {
      slot.upright = slot.upright && found.upright;
      PutContact(slot, found, here);
    }
    slot.live = Select(here, W::Splat(1.0), slot.live);
  }

  Contact<W, 1>* slots_;
  int capacity_, count_ = 0;
  W used_ = W::Splat(0.0);
  bool one_direction_;
};

/// Converts a contact point between a body and a static shape, for one lane of a slot.
template <class W>
Found<W> FoundTouch(const View& m, const Rows<W>& s, const Scratch<W>& work,
                    const ShapePairTable& pair, const TouchPoint& t, int body, int lane) noexcept {
  const V3<W>& x = s.pos[body];
  Found<W> found;
  found.key = W::Splat(pair.id + static_cast<uint32_t>(t.feature));
  found.frame = W::Splat(-1.0) - found.key;  // a unique frame
  found.gap = W::Splat(t.gap_m);
  found.radius = W::Splat(RadiusOf(m.shapes[pair.a].shape_P));
  found.static_friction = W::Splat(pair.static_friction);
  found.kinetic_friction = W::Splat(pair.kinetic_friction);
  found.restitution = W::Splat(pair.restitution);
  found.upright = false;
  found.n = simd::Splat3<W>(t.normal);
  found.t1 = found.t2 = found.n;  // computed later
  const V3<W>& v = work.bodies[body].v;
  found.arm = {W::Splat(t.point[0] - (x.x[lane] + t.when_s * v.x[lane])),
               W::Splat(t.point[1] - (x.y[lane] + t.when_s * v.y[lane])),
               W::Splat(t.point[2] - (x.z[lane] + t.when_s * v.z[lane]))};
  return found;
}

/// Stores the contact points of one pair of shapes in one lane, sorted by feature, except points
/// that only pass by (swept_test.h). The storage is a slot of a body if the other body is static,
/// otherwise the list of contacts of moving bodies.
template <class W>
TAUT_INLINE void PutPoints(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                           const ShapePairTable& pair, int lane, double step_s, NearParts* kept,
                           TouchPoint* points, int found, SlotFiller<W>* slots,
                           uint32_t* overflow) noexcept {
  const int body = m.shapes[pair.a].body;
  const int count = slots != nullptr
                        ? KeepTouching(m, s, work, pair, lane, step_s, m.first_slot[body],
                                       g.slots_used[body], kept, points, found)
                        : KeepTouching(m, s, work, pair, lane, step_s, m.slot_count, g.touches_used,
                                       kept, points, found);
  for (int feature = 0, left = count; left > 0; ++feature) {
    for (int i = 0; i < count; ++i) {
      if (points[i].feature != feature) continue;
      --left;
      const bool room = slots != nullptr
                            ? slots->Add(FoundTouch(m, s, work, pair, points[i], body, lane), lane)
                            : work.AddTouch(m, lane, pair, points[i]);
      if (!room) *overflow |= 1u << lane;
    }
  }
}

/// Finds and stores all points of a pair. Returns false if no point is within the margin.
template <class W>
bool PutTouches(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                const ShapePairTable& pair, int lane, double margin, double step_s,
                SlotFiller<W>* slots, uint32_t* overflow) noexcept {
  TouchPoint points[kMaxPointsPerPair];
  const int found = TouchLane(m, s, work, pair, lane, margin, points);
  PutPoints(m, s, g, work, pair, lane, step_s, nullptr, points, found, slots, overflow);
  return found > 0;
}

/// Returns an upper bound of the approach of two bodies in this step, plus the margin [m].
template <class W>
TAUT_INLINE W Reach(const BodyWork<W>& a, const BodyWork<W>& b, W h) noexcept {
  return h * Norm1(a.v - b.v) + (a.turns + b.turns) + W::Splat(kContactMarginM);
}
/// Returns an upper bound of the approach of two bodies since the previous step [m].
template <class W>
TAUT_INLINE W Used(const BodyWork<W>& a, const BodyWork<W>& b, W since_last) noexcept {
  return since_last * Norm1(a.v0 - b.v0) + (a.turned + b.turned);
}

/// Returns the lanes in which two bodies may touch according to the last distance query. Sets
/// `margin` to `Reach` of the bodies.
template <class W>
MaskOf<W> ClearanceUsedUp(const Scratch<W>& work, int body_a, int body_b, W& clearance, W h,
                          W since_last, W& margin) noexcept {
  const BodyWork<W>&a = work.bodies[body_a], &b = work.bodies[body_b];
  margin = Reach(a, b, h);
  clearance -= Used(a, b, since_last);
  return clearance < margin;
}

/// Resets the clearances of a lane after its bodies moved other than with their velocities, so that
/// the next step computes the distances again.
template <class W>
void LookAgain(const View& m, const Rows<W>& s, const Scratch<W>& work, int lane) noexcept {
  const int pairs = m.world_pair_count + work.moving_count;
  for (int pair = 0; pair < pairs; ++pair) s.clearance[pair].Set(lane, 0.0);
}

}  // namespace taut::sim
