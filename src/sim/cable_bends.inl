/// Cables that come to lie against edges of the terrain (cable_edges.h, docs/theory/cables.md,
/// section 6). Such an edge is a wheel of the cable's radius that does not turn, and that the cable
/// has only while it lies there.

namespace taut::sim {

/// How many places of a cable's room for bends are in use, in some lane.
template <class W>
TAUT_INLINE int BendsInUse(const Rows<W>& s, const TouchTable& touch) noexcept {
  int used = 0;
  while (used < kMostBends && Any(!(s.bend[touch.first_bend + used].key == W::Splat(kNoKey)))) {
    ++used;
  }
  return used;
}

/// A path from ends[0] over bends to ends[2 used + 1], on work.wheels. What a lane does not have is
/// passed by.
template <class W>
void LayOverEdges(const Rows<W>& s, const TouchTable& touch, int used, AttachmentWork<W>* ends,
                  Wheel<V3<W>>* wheels) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  for (int k = 0; k < used; ++k) {
    const BendNumbers<W>& bend = s.bend[touch.first_bend + k];
    const auto none = bend.key == W::Splat(kNoKey);
    Wheel<V3<W>>& wheel = wheels[k];
    // With no radius and no turn it is never touched.
    wheel.center = Pick(none, ends[0].p, V3<W>{bend.center[0], bend.center[1], bend.center[2]});
    wheel.axis =
        Pick(none, V3<W>{zero, zero, one}, V3<W>{bend.axis[0], bend.axis[1], bend.axis[2]});
    wheel.radius = Select(none, zero, W::Splat(touch.radius_m));
    wheel.before = Select(none, zero, bend.angle);
    wheel.at = 1 + 2 * k;
  }
  LayOnWheels(ends, used, wheels);
}

/// Length and rate; fills in the directions. On the way past what it does not touch, a path's
/// directions are those of the whole way, so that pulls there are nothing.
template <class W>
PathLength<V3<W>> MeasureOverEdges(int used, AttachmentWork<W>* ends,
                                   const Wheel<V3<W>>* wheels) noexcept {
  const W zero = W::Splat(0.0);
  const V3<W> none{zero, zero, zero};
  PathLength<V3<W>> path;
  AttachmentWork<W> from = ends[0];
  for (int k = 0; k < used; ++k) {
    const auto on = wheels[k].theta > zero;
    AttachmentWork<W>&a = ends[1 + 2 * k], &b = ends[2 + 2 * k];
    a.v = b.v = a.arm = b.arm = none;
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

/// What a lane's cable lies against, while that changes.
template <class W>
class LaneBends {
 public:
  LaneBends(const Rows<W>& s, const TouchTable& touch, int lane) noexcept
      : s_(s), first_(touch.first_bend), lane_(lane) {
    while (count_ < kMostBends && s.bend[first_ + count_].key[lane] != kNoKey) ++count_;
  }
  int count() const noexcept { return count_; }
  double Key(int k) const noexcept { return s_.bend[first_ + k].key[lane_]; }
  double LastTheta(int k) const noexcept { return s_.bend[first_ + k].theta[lane_]; }
  double Half(int k) const noexcept { return s_.bend[first_ + k].half[lane_]; }

  void Remove(int k) noexcept {
    for (; k + 1 < count_; ++k) Copy(s_.bend[first_ + k + 1], s_.bend[first_ + k]);
    Clear(s_.bend[first_ + --count_]);
  }
  /// False if there is no room.
  bool Insert(int k, const EdgeFound& found) noexcept {
    if (count_ == kMostBends) return false;
    for (int i = count_++; i > k; --i) Copy(s_.bend[first_ + i - 1], s_.bend[first_ + i]);
    BendNumbers<W>& bend = s_.bend[first_ + k];
    const TerrainEdge& edge = found.edge;
    bend.key.Set(lane_, edge.key);
    bend.angle.Set(lane_, found.side * kPi);
    bend.theta.Set(lane_, 1.0);  // to be known; not to be dropped at once
    bend.half.Set(lane_, edge.half_m);
    const double center[3] = {edge.center.x, edge.center.y, edge.center.z};
    const double axis[3] = {edge.axis.x, edge.axis.y, edge.axis.z};
    for (int i = 0; i < 3; ++i) bend.center[i].Set(lane_, center[i]);
    for (int i = 0; i < 3; ++i) bend.axis[i].Set(lane_, axis[i]);
    return true;
  }

 private:
  void Copy(const BendNumbers<W>& from, BendNumbers<W>& to) const noexcept {
    to.key.Set(lane_, from.key[lane_]);
    to.angle.Set(lane_, from.angle[lane_]);
    to.theta.Set(lane_, from.theta[lane_]);
    to.half.Set(lane_, from.half[lane_]);
    for (int i = 0; i < 3; ++i) to.center[i].Set(lane_, from.center[i][lane_]);
    for (int i = 0; i < 3; ++i) to.axis[i].Set(lane_, from.axis[i][lane_]);
  }
  void Clear(BendNumbers<W>& bend) const noexcept {
    bend.key.Set(lane_, kNoKey);
    bend.angle.Set(lane_, 0.0);
    bend.theta.Set(lane_, 0.0);
    bend.half.Set(lane_, 0.0);
    for (int i = 0; i < 3; ++i) bend.center[i].Set(lane_, 0.0);
    for (int i = 0; i < 3; ++i) bend.axis[i].Set(lane_, 0.0);
  }

  const Rows<W>& s_;
  int first_, lane_, count_ = 0;
};

template <class W>
TAUT_INLINE Vec3 PlaceOf(const V3<W>& p, int lane) noexcept {
  return {p.x[lane], p.y[lane], p.z[lane]};
}

/// Changes a lane's bends once, if the path as it is laid says so: what it has left is dropped, or
/// where it is longer than its edge; an edge that a straight part is below is added. What it has
/// just left stays for a step, which may have begun with it. Returns whether something has changed.
template <class W>
bool ChangeBends(const View& m, const Rows<W>& s, const TouchTable& touch, int used, int lane,
                 bool first_look, const AttachmentWork<W>* ends, const Wheel<V3<W>>* wheels,
                 uint32_t* no_room) noexcept {
  LaneBends<W> bends(s, touch, lane);
  const int before = bends.count();
  for (int k = before - 1; k >= 0; --k) {
    const bool on = wheels[k].theta[lane] > 0.0;
    const Vec3 middle =
        0.5 * (PlaceOf(ends[1 + 2 * k].p, lane) + PlaceOf(ends[2 + 2 * k].p, lane)) -
        PlaceOf(wheels[k].center, lane);
    const bool beyond = !(Abs(Dot(middle, PlaceOf(wheels[k].axis, lane))) < bends.Half(k));
    if (on ? beyond : first_look && !(bends.LastTheta(k) > 0.0)) bends.Remove(k);
  }
  if (bends.count() < before) return true;
  double taken[kMostBends];
  for (int k = 0; k < bends.count(); ++k) taken[k] = bends.Key(k);
  FreeSpan span{PlaceOf(ends[0].p, lane), {}, true, false};
  EdgeFound deepest, found;
  int place = -1, from = 0;
  for (int k = 0; k <= bends.count(); ++k) {
    const bool end = k == bends.count();
    if (!end && !(wheels[k].theta[lane] > 0.0)) continue;
    span.to = PlaceOf(ends[end ? 2 * used + 1 : 1 + 2 * k].p, lane);
    span.ends = end;
    if (FindEdge(m, span, touch.radius_m, taken, bends.count(), &found) &&
        (place < 0 || found.depth_m > deepest.depth_m)) {
      deepest = found, place = from;
    }
    if (end) break;
    span.from = PlaceOf(ends[2 + 2 * k].p, lane);
    span.starts = false;
    from = k + 1;
  }
  if (place < 0) return false;
  if (bends.Insert(place, deepest)) return true;
  *no_room |= 1u << lane;
  return false;
}

/// Where a cable without bends may have come to touch something since it was looked at.
template <class W>
TAUT_INLINE MaskOf<W> MayTouch(const Rows<W>& s, int touch, const V3<W>& p,
                               const V3<W>& q) noexcept {
  const V3<W> dp = p - s.touch_from[touch], dq = q - s.touch_to[touch];
  const W moved2 = Max(Dot(dp, dp), Dot(dq, dq)), free = s.touch_free[touch];
  return !(moved2 < free * free);
}

/// At the middle of the step: what a cable lies against from here on.
template <class W>
[[gnu::noinline]] void FollowEdges(const View& m, const Rows<W>& s, Scratch<W>& work,
                                   const CableTable& cable) noexcept {
  constexpr int kMostRounds = 4 * kMostBends;
  constexpr double kEnoughM = 0.05;
  const TouchTable& touch = m.touches[cable.touch];
  int used = BendsInUse(s, touch);
  const W zero = W::Splat(0.0);
  AttachmentWork<W>* const ends = work.attachments;
  V3<W> last;
  ends[0].p = work.spots[m.attachments[cable.first_attachment].spot].p;
  last = work.spots[m.attachments[cable.first_attachment + 1].spot].p;
  auto look = MayTouch(s, cable.touch, ends[0].p, last);
  for (int k = 0; k < used; ++k) {
    look = look | !(s.bend[touch.first_bend + k].key == W::Splat(kNoKey));
  }
  look = look & (s.halted[0] == zero);
  if (!Any(look)) return;
  auto busy = look;
  for (int round = 0; round < kMostRounds && Any(busy); ++round) {
    ends[2 * used + 1].p = last;
    LayOverEdges(s, touch, used, ends, work.wheels);
    for (int lane = 0; lane < W::kLanes; ++lane) {
      if (!busy[lane]) continue;
      busy.Set(lane,
               ChangeBends(m, s, touch, used, lane, round == 0, ends, work.wheels, &work.no_room));
    }
    if (Any(busy)) used = BendsInUse(s, touch);
  }
  for (int k = 0; k < used; ++k) {
    BendNumbers<W>& bend = s.bend[touch.first_bend + k];
    const auto live = !(bend.key == W::Splat(kNoKey));
    bend.angle = Select(live, work.wheels[k].angle, bend.angle);
    bend.theta = Select(live, work.wheels[k].theta, bend.theta);
  }
  // Of one that is free, how far it may go before it is looked at again.
  for (int lane = 0; lane < W::kLanes; ++lane) {
    if (!look[lane]) continue;
    double free = 0.0;
    const FreeSpan span{PlaceOf(ends[0].p, lane), PlaceOf(last, lane), true, true};
    if (used == 0 || s.bend[touch.first_bend].key[lane] == kNoKey) {
      free = FreeDistance(m, span, touch.radius_m, kEnoughM);
    }
    s.touch_free[cable.touch].Set(lane, free);
  }
  s.touch_from[cable.touch] = Select3(look, ends[0].p, s.touch_from[cable.touch]);
  s.touch_to[cable.touch] = Select3(look, last, s.touch_to[cable.touch]);
}

/// Length and rate of such a cable. `ends` has its two, and afterwards all points of its path;
/// work.bends_used says how many.
template <class W>
[[gnu::noinline]] PathLength<V3<W>> MeasureTouching(const View& m, const Rows<W>& s,
                                                    const CableTable& cable, Scratch<W>& work,
                                                    AttachmentWork<W>* ends) noexcept {
  const TouchTable& touch = m.touches[cable.touch];
  const int used = work.bends_used = BendsInUse(s, touch);
  if (used == 0) return MeasurePath(2, ends);
  ends[2 * used + 1] = ends[1];
  LayOverEdges(s, touch, used, ends, work.wheels);
  return MeasureOverEdges(used, ends, work.wheels);
}

/// The length at the start of the step, over what it lies against now.
template <class W>
[[gnu::noinline]] W StartLengthOverEdges(const View& m, const Rows<W>& s, Scratch<W>& work,
                                         const CableTable& cable) noexcept {
  const AttachmentTable* const tables = m.attachments + cable.first_attachment;
  for (int i = 0; i < 2; ++i) {
    work.attachments[i].p = work.start_spots[tables[i].spot];
    work.attachments[i].v = work.attachments[i].p;  // nobody needs the rate
  }
  return MeasureTouching(m, s, cable, work, work.attachments).l;
}

}  // namespace taut::sim
