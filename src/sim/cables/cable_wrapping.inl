/// Cable wrapping around terrain edges (cable_edges.h) and rods (cable_rods.inl;
/// docs/theory/cables.md, section 6). A bend is a wheel that exists only while the cable touches
/// the edge or rod.
#pragma once

#include "sim/bodies/stage_bodies.inl"
#include "sim/cables/cable_edges.h"
#include "sim/cables/lane_spans.inl"
#include "sim/cables/wrap_unchanged.inl"
#include "sim/data/rows.h"

namespace taut::sim {

template <class W>
TAUT_INLINE void SetPlace(V3<W>& to, const Vec3& p, int lane) noexcept {
  to.x.Set(lane, p.x);
  to.y.Set(lane, p.y);
  to.z.Set(lane, p.z);
}

/// Returns the body of a bend in one lane; the world if there is no bend.
template <class W>
TAUT_INLINE int BodyOfBend(const View& m, const WrapPointNumbers<W>& bend, int lane) noexcept {
  return bend.key[lane] == kNoKey ? m.body_count : static_cast<int>(bend.body[lane]);
}

/// Calls `use(body, lanes)` for each body with a rod at this bend. `lanes`: the lanes with this
/// body.
template <class W, class Use>
TAUT_INLINE void EachBody(const View& m, const WrapPointNumbers<W>& bend, const Use& use) noexcept {
  auto left = IsOnRod(m, bend);
  for (int lane = 0; lane < W::kLanes && Any(left); ++lane) {
    if (!left[lane]) continue;
    const double body = bend.body[lane];
    const auto lanes = left & (bend.body == W::Splat(body));
    use(static_cast<int>(body), lanes);
    left = left & !lanes;
  }
}

/// Returns the largest number of bends in any lane.
template <class W>
TAUT_INLINE int BendsInUse(const Rows<W>& s, const TouchTable& touch) noexcept {
  int used = 0;
  while (used < kMostBends && Any(!(s.bend[touch.first_bend + used].key == W::Splat(kNoKey)))) {
    ++used;
  }
  return used;
}

/// Computes a path from ends[0] over bends to ends[2 used + 1] on work.wheels. Bends that do not
/// exist in a lane are skipped. `pose(body)`: pose of a body. Friction may hold the path along the
/// axes.
template <class W, class Pose>
void LayOverBends(const View& m, const Rows<W>& s, const TouchTable& touch, int used,
                  AttachmentWork<W>* ends, Wheel<V3<W>>* wheels, const Pose& pose) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  for (int k = 0; k < used; ++k) {
    const WrapPointNumbers<W>& bend = s.bend[touch.first_bend + k];
    const auto none = bend.key == W::Splat(kNoKey);
    Wheel<V3<W>>& wheel = wheels[k];
    // A wheel with zero radius and angle is never touched.
    wheel.center = Pick(none, ends[0].p, V3<W>{bend.center[0], bend.center[1], bend.center[2]});
    wheel.axis =
        Pick(none, V3<W>{zero, zero, one}, V3<W>{bend.axis[0], bend.axis[1], bend.axis[2]});
    wheel.radius = Select(none, zero, bend.radius);
    wheel.before = Select(none, zero, bend.angle);
    wheel.at = 1 + 2 * k;
    if (touch.rod_count == 0) continue;
    const V3<W> center = wheel.center, axis = wheel.axis;
    EachBody(m, bend, [&](int body, auto lanes) {
      const Spot<W> at = pose(body, center, axis);
      wheel.center = Pick(lanes, at.p, wheel.center);
      wheel.axis = Pick(lanes, at.arm, wheel.axis);
    });
  }
  if (used > 1) {
    W half[kMostBends], has[kMostBends];
    for (int k = 0; k < used; ++k) {
      const WrapPointNumbers<W>& bend = s.bend[touch.first_bend + k];
      half[k] = bend.half;
      has[k] = Select(bend.key == W::Splat(kNoKey), zero, one);
    }
    BeginOnWheels(ends, used, wheels, half, has);
  }
  LayOnWheels(ends, used, wheels, touch.friction > 0 ? &s.slip_along[FirstSlip(m, touch)] : nullptr,
              used > 1);
}

/// Returns the pose function for LayOverBends at the middle of the step.
template <class W>
auto PoseNow(const Rows<W>& s, const Scratch<W>& work) noexcept {
  return [&](int body, const V3<W>& center, const V3<W>& axis) {
    const M3<W>& R = work.bodies[body].R;
    return Spot<W>{s.pos[body] + R * center, R * axis};
  };
}

/// Sets velocities and lever arms of path points on terrain edges to zero.
template <class W>
TAUT_INLINE void StandOnEdges(int used, AttachmentWork<W>* ends) noexcept {
  const W zero = W::Splat(0.0);
  for (int i = 1; i <= 2 * used; ++i) ends[i].v = ends[i].arm = {zero, zero, zero};
}

/// Returns length and rate, and sets the directions. Points of bends without contact get the
/// direction of the straight part between the neighbors, so that they exert no force.
template <class W>
PathLength<V3<W>> MeasureOverBends(int used, AttachmentWork<W>* ends,
                                   const Wheel<V3<W>>* wheels) noexcept {
  const W zero = W::Splat(0.0);
  const V3<W> none{zero, zero, zero};
  PathLength<V3<W>> path;
  AttachmentWork<W> from = ends[0];
  for (int k = 0; k < used; ++k) {
    const auto on = wheels[k].theta > zero;
    AttachmentWork<W>&a = ends[1 + 2 * k], &b = ends[2 + 2 * k];
    PathLength<V3<W>> span;
    AddSpan(from, a, span);
    path.l = path.l + Select(on, span.l + wheels[k].arc, zero);
    path.dl = path.dl + Select(on, span.dl, zero);
    from.p = Pick(on, b.p, from.p);
    from.v = Pick(on, b.v, from.v);
  }
  AddSpan(from, ends[2 * used + 1], path);
  V3<W> next = ends[2 * used + 1].u;
  for (int k = used - 1; k >= 0; --k) {
    const auto on = wheels[k].theta > zero;
    ends[2 + 2 * k].u = Pick(on, none, next);
    ends[1 + 2 * k].u = next = Pick(on, ends[1 + 2 * k].u, next);
  }
  return path;
}

/// Insertion and removal of the bends of a cable in one lane.
template <class W>
class LaneBends {
 public:
  LaneBends(const View& m, const Rows<W>& s, const TouchTable& touch, int lane) noexcept
      : s_(s),
        spans_(m, s, touch, lane),
        first_(touch.first_bend),
        first_rod_(touch.first_rod),
        rod_count_(touch.rod_count),
        lane_(lane) {
    while (count_ < kMostBends && s.bend[first_ + count_].key[lane] != kNoKey) ++count_;
  }
  int count() const noexcept { return count_; }
  double Key(int k) const noexcept { return s_.bend[first_ + k].key[lane_]; }
  double Half(int k) const noexcept { return s_.bend[first_ + k].half[lane_]; }
  double Most(int k) const noexcept { return s_.bend[first_ + k].most[lane_]; }

  void Remove(int k) noexcept {
    spans_.Merge(k, count_);
    MoveSides(k, -1.0);
    for (; k + 1 < count_; ++k) Copy(s_.bend[first_ + k + 1], s_.bend[first_ + k]);
    Put(s_.bend[first_ + --count_], kNoWrapPoint);
  }
  /// Adds a bend. Returns false if the cable already has kMostBends bends. `share`: fraction of the
  /// span before the bend.
  bool Insert(int k, const BendFound& found, double share) noexcept {
    if (count_ == kMostBends) return false;
    spans_.Split(k, count_, share);
    MoveSides(k, 1.0);
    for (int i = count_++; i > k; --i) Copy(s_.bend[first_ + i - 1], s_.bend[first_ + i]);
    const BendPlace& place = found.place;
    const Vec3 &c = place.center, &u = place.axis;
    Put(s_.bend[first_ + k], {place.key,
                              static_cast<double>(place.body),
                              found.side * kPi,
                              place.most_rad,
                              place.half_m,
                              place.radius_m,
                              {c.x, c.y, c.z},
                              {u.x, u.y, u.z}});
    return true;
  }

 private:
  static constexpr int kWidth = kWidthWrapPoint;

  /// Adds `by` (1 or -1) to the stored part numbers after part `k`.
  void MoveSides(int k, double by) const noexcept {
    for (int i = first_rod_; i < first_rod_ + rod_count_; ++i) {
      const double side = s_.touch_side[i][lane_];
      if (Abs(side) > k + 1.5) s_.touch_side[i].Set(lane_, side + (side < 0.0 ? -by : by));
    }
  }
  void Copy(const WrapPointNumbers<W>& from, WrapPointNumbers<W>& to) const noexcept {
    for (int i = 0; i < kWidth; ++i) Numbers(to)[i].Set(lane_, Numbers(from)[i][lane_]);
  }
  void Put(WrapPointNumbers<W>& bend, const WrapPointNumbers<double>& x) const noexcept {
    for (int i = 0; i < kWidth; ++i) {
      Numbers(bend)[i].Set(lane_, reinterpret_cast<const double*>(&x)[i]);
    }
  }
  static W* Numbers(WrapPointNumbers<W>& bend) noexcept { return reinterpret_cast<W*>(&bend); }
  static const W* Numbers(const WrapPointNumbers<W>& bend) noexcept {
    return reinterpret_cast<const W*>(&bend);
  }

  const Rows<W>& s_;
  const LaneSpans<W> spans_;
  int first_, first_rod_, rod_count_, lane_, count_ = 0;
};

/// Returns the lanes in which a cable without bends may touch something since its last check.
template <class W>
TAUT_INLINE MaskOf<W> MayTouch(const Rows<W>& s, int touch, const V3<W>& p,
                               const V3<W>& q) noexcept {
  const V3<W> dp = p - s.touch_from[touch], dq = q - s.touch_to[touch];
  const W moved2 = Max(Dot(dp, dp), Dot(dq, dq)), free = s.touch_free[touch];
  return !(moved2 < free * free);
}

/// Sets velocities and lever arms of path points on rods.
template <class W>
void MoveWithRods(const View& m, const Rows<W>& s, const Scratch<W>& work, const TouchTable& touch,
                  int used, AttachmentWork<W>* ends) noexcept {
  for (int i = 1; i <= 2 * used; ++i) {
    const WrapPointNumbers<W>& bend = s.bend[touch.first_bend + (i - 1) / 2];
    EachBody(m, bend, [&](int body, auto lanes) {
      const BodyWork<W>& b = work.bodies[body];
      const V3<W> arm = ends[i].p - s.pos[body];
      ends[i].arm = Pick(lanes, arm, ends[i].arm);
      ends[i].v = Pick(lanes, b.v_mid + Cross(b.w_mid, arm), ends[i].v);
    });
  }
}

/// Returns length and rate of a computed path.
template <class W>
PathLength<V3<W>> MeasureLaid(const View& m, const Rows<W>& s, const TouchTable& touch, int used,
                              Scratch<W>& work, AttachmentWork<W>* ends) noexcept {
  work.bends_used = used;
  if (used == 0) return MeasurePath(2, ends);
  StandOnEdges(used, ends);
  if (touch.rod_count > 0) MoveWithRods(m, s, work, touch, used, ends);
  return MeasureOverBends(used, ends, work.wheels);
}

/// Returns length and rate of a cable with wrapping. On entry, `ends` contains its two ends; on
/// return, all points of its path. Sets work.bends_used to the number of bends.
template <class W>
[[gnu::noinline]] PathLength<V3<W>> MeasureTouching(const View& m, const Rows<W>& s,
                                                    const CableTable& cable, Scratch<W>& work,
                                                    AttachmentWork<W>* ends) noexcept {
  const TouchTable& touch = m.touches[cable.touch];
  const int used = BendsInUse(s, touch);
  if (used > 0) {
    ends[2 * used + 1] = ends[1];
    LayOverBends(m, s, touch, used, ends, work.wheels, PoseNow(s, work));
  }
  return MeasureLaid(m, s, touch, used, work, ends);
}

/// Links the tension to bodies with rods: one link per body, sorted by body, for the bends of all
/// lanes.
template <class W>
[[gnu::noinline]] void LinkRods(const View& m, const Rows<W>& s, const Scratch<W>& work,
                                const CableTable& cable, const AttachmentWork<W>* ends,
                                CableWork<W>& row) noexcept {
  const TouchTable& touch = m.touches[cable.touch];
  const int used = work.bends_used, own = row.link_count;
  for (int i = 1; i <= 2 * used; ++i) {
    const WrapPointNumbers<W>& bend = s.bend[touch.first_bend + (i - 1) / 2];
    const V3<W> pull = PullAt(2 * used + 2, ends, i), turn = Cross(ends[i].arm, pull);
    EachBody(m, bend, [&](int body, auto lanes) {
      int k = 0;
      while (k < own && row.links[k].body != body) ++k;
      if (k == own) {
        while (k < row.link_count && row.links[k].body < body) ++k;
        if (k == row.link_count || row.links[k].body != body) {
          for (int j = row.link_count++; j > k; --j) row.links[j] = row.links[j - 1];
          Link<W, 1>& link = row.links[k];
          const W zero = W::Splat(0.0);
          link.body = body;
          link.inv_mass = s.inv_mass[body];
          link.lin[0] = link.ang[0] = {zero, zero, zero};
        }
      }
      Link<W, 1>& link = row.links[k];
      link.lin[0] = Pick(lanes, link.lin[0] + pull, link.lin[0]);
      link.ang[0] = Pick(lanes, link.ang[0] + turn, link.ang[0]);
    });
  }
}

/// Returns the length at the start of the step, over the current bends.
template <class W>
[[gnu::noinline]] W StartLengthOverBends(const View& m, const Rows<W>& s, Scratch<W>& work,
                                         const CableTable& cable) noexcept {
  const AttachmentTable* const tables = m.attachments + cable.first_attachment;
  const TouchTable& touch = m.touches[cable.touch];
  const int used = BendsInUse(s, touch);
  AttachmentWork<W>* const ends = work.attachments;
  ends[0].p = work.start_spots[tables[0].spot];
  ends[2 * used + 1].p = work.start_spots[tables[1].spot];
  ends[0].v = ends[2 * used + 1].v = ends[0].p;  // unused
  const auto* const pos = reinterpret_cast<const V3<W>*>(work.start);
  const auto* const quat = reinterpret_cast<const Q4<W>*>(pos + m.body_count);
  LayOverBends(m, s, touch, used, ends, work.wheels,
               [&](int body, const V3<W>& center, const V3<W>& axis) {
                 const M3<W> R = RotationOf(quat[body]);
                 return Spot<W>{pos[body] + R * center, R * axis};
               });
  StandOnEdges(used, ends);
  return MeasureOverBends(used, ends, work.wheels).l;
}

}  // namespace taut::sim
