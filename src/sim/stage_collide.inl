/// Stage: where bodies touch the world and each other, at the middle of the step
/// (docs/theory/contact.md, section 7).
///
/// Points against planes are tested in all lanes at once. Everything else hides behind bounds:
/// a pair of bodies is looked at only when the motion since the last look may have used up the
/// distance found then, a pair of shapes only when their bounding spheres meet, and then each
/// lane by itself in scalar code (shape_pairs.inl).

namespace taut::sim {

/// How close a contact must be to get a row: what its body may travel in this step, and a bit.
inline constexpr double kContactMarginM = 1e-5;

/// A look is for so many steps like this one, if nothing is nearer.
inline constexpr double kLookAheadSteps = 16.0;

/// How far turning may take any point of each body in this step, and may have taken it since the
/// middle of the step before.
template <class W>
void BoundTurns(const View& m, Scratch<W>& work, W h, W since_last) noexcept {
  for (int body = 0; body <= m.body_count; ++body) {
    BodyWork<W>& b = work.bodies[body];
    const W bound = W::Splat(m.bound_m[body]);
    b.turns = h * (bound * Norm1(b.w));
    b.turned = since_last * (bound * Norm1(b.w0));
  }
}

/// What the finding of a contact with the world says about it.
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

/// The contacts of one body with the world that were found so far.
template <class W>
class SlotFiller {
 public:
  SlotFiller(const View& m, Scratch<W>& work, int body) noexcept
      : slots_(work.contacts + m.first_slot[body]),
        capacity_(m.first_slot[body + 1] - m.first_slot[body]),
        one_direction_(m.along_slip) {}

  /// Puts it into the next slot of each of `lanes`; there is room for all points on all planes.
  template <class M>
  TAUT_INLINE void Add(const Found<W>& found, M lanes) noexcept {
    const int last = count_;
    for (int k = W::kLanes == 1 ? last : 0; k <= last; ++k) {
      const auto here = lanes & (used_ == W::Splat(k));
      if (Any(here)) Put(k, found, here);
    }
    used_ += Select(lanes, W::Splat(1.0), W::Splat(0.0));
  }
  /// The same for one lane. False if it has no room.
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
      // Lanes that have no such contact keep a harmless one.
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

template <class W>
void CollidePlanes(const View& m, const Rows<W>& s, Scratch<W>& work, W h, int body,
                   SlotFiller<W>& slots) noexcept {
  V3<W> normal_P[kMaxPlanes];
  W height[kMaxPlanes];
  bool near_plane[kMaxPlanes];
  const int first = m.first_point[body], last = m.first_point[body + 1];
  if (first == last) return;
  const BodyWork<W>& b = work.bodies[body];
  const W margin = h * Norm1(b.v) + b.turns + W::Splat(kContactMarginM);
  bool any = false;
  for (int k = 0; k < m.plane_count; ++k) {
    const V3<W> n = simd::Splat3<W>(m.planes[k].normal);
    height[k] = Dot(n, s.pos[body]) - W::Splat(m.planes[k].offset_m);
    near_plane[k] = Any(height[k] - W::Splat(m.bound_m[body]) < margin);
    any = any || near_plane[k];
    normal_P[k] = TransposeTimes(b.R, n);
  }
  if (!any) return;
  for (int i = first; i < last; ++i) {
    const PointTable& point = m.points[i];
    const V3<W> p_P = simd::Splat3<W>(point.p_P);
    for (int k = 0; k < m.plane_count; ++k) {
      if (!near_plane[k]) continue;
      const W gap = height[k] + Dot(normal_P[k], p_P) - W::Splat(point.radius_m);
      const auto touching = gap < margin;
      if (!Any(touching)) continue;
      const PlaneTable& plane = m.planes[k];
      Found<W> found;
      found.key = W::Splat(i * m.plane_count + k);
      found.frame = m.along_slip ? W::Splat(-1.0) - found.key : W::Splat(k);
      found.gap = gap;
      found.radius = W::Splat(point.radius_m);
      found.static_friction = W::Splat(point.static_friction[k]);
      found.kinetic_friction = W::Splat(point.kinetic_friction[k]);
      found.restitution = W::Splat(point.restitution[k]);
      found.upright = plane.upright && !m.along_slip;
      found.n = simd::Splat3<W>(plane.normal);
      found.t1 = simd::Splat3<W>(plane.tangent1);
      found.t2 = simd::Splat3<W>(plane.tangent2);
      found.arm = b.R * p_P - W::Splat(point.radius_m) * found.n;
      slots.Add(found, touching);
    }
  }
}

/// A lower bound of the distance between all shapes of two bodies, in `lanes`.
template <class W, class M>
W DistanceOfBodies(const View& m, const Rows<W>& s, const Scratch<W>& work,
                   const BodyPairTable& bodies, M lanes) noexcept {
  W least = W::Splat(1e300);
  for (int i = 0; i < bodies.pair_count; ++i) {
    const ShapePairTable& pair = m.shape_pairs[bodies.first_pair + i];
    const ShapeTable &a = m.shapes[pair.a], &b = m.shapes[pair.b];
    if (a.shape_P.kind == ShapeKind::kRound && b.shape_P.kind == ShapeKind::kRound) {
      const W radii = W::Splat(a.shape_P.round.radius_m + b.shape_P.round.radius_m);
      const W lines =
          LineDistance(CenterLineOf(m, s, work, pair.a), CenterLineOf(m, s, work, pair.b));
      least = Min(lines - radii, least);
      continue;
    }
    const V3<W> d = ShapeCenter(m, s, work, pair.a) - ShapeCenter(m, s, work, pair.b);
    W bound = Sqrt(Dot(d, d)) - W::Splat(m.shapes[pair.a].bound_m + m.shapes[pair.b].bound_m);
    const auto closer = lanes & (bound < least);
    if (!Any(closer)) continue;
    for (int lane = 0; lane < W::kLanes; ++lane) {
      if (!closer[lane]) continue;
      const double exact = DistanceLane(m, s, work, pair, lane);
      if (exact > bound[lane]) bound.Set(lane, exact);
    }
    least = Min(bound, least);
  }
  return least;
}

/// A touching point of a body and a shape that does not move, for one lane of a slot.
template <class W>
Found<W> FoundTouch(const View& m, const Rows<W>& s, const Scratch<W>& work,
                    const ShapePairTable& pair, const TouchPoint& t, int body, int lane) noexcept {
  const V3<W>& x = s.pos[body];
  Found<W> found;
  found.key = W::Splat(pair.id + static_cast<uint32_t>(t.feature));
  found.frame = W::Splat(-1.0) - found.key;  // like no other
  found.gap = W::Splat(t.gap_m);
  found.radius = W::Splat(RadiusOf(m.shapes[pair.a].shape_P));
  found.static_friction = W::Splat(pair.static_friction);
  found.kinetic_friction = W::Splat(pair.kinetic_friction);
  found.restitution = W::Splat(pair.restitution);
  found.upright = false;
  found.n = simd::Splat3<W>(t.normal);
  found.t1 = found.t2 = found.n;  // to be made
  const V3<W>& v = work.bodies[body].v;
  found.arm = {W::Splat(t.point[0] - (x.x[lane] + t.when_s * v.x[lane])),
               W::Splat(t.point[1] - (x.y[lane] + t.when_s * v.y[lane])),
               W::Splat(t.point[2] - (x.z[lane] + t.when_s * v.z[lane]))};
  return found;
}

/// Of the points that one pair of shapes has in one lane those that do not only pass by, in the
/// order of their features: into the slots of a body if the other does not move, else into the
/// lists of touches.
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
      const bool room =
          slots != nullptr
              ? slots->Add(FoundTouch(m, s, work, pair, points[i], body, lane), lane)
              : work.AddTouch(m, lane, static_cast<int>(&pair - m.shape_pairs), points[i]);
      if (!room) *overflow |= 1u << lane;
    }
  }
}

/// All points of a pair. False if none is near.
template <class W>
bool PutTouches(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                const ShapePairTable& pair, int lane, double margin, double step_s,
                SlotFiller<W>* slots, uint32_t* overflow) noexcept {
  TouchPoint points[kMaxPointsPerPair];
  const int found = TouchLane(m, s, work, pair, lane, margin, points);
  PutPoints(m, s, g, work, pair, lane, step_s, nullptr, points, found, slots, overflow);
  return found > 0;
}

/// The same for all lanes in which the bounding spheres meet.
template <class W>
void CollideShapes(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                   const ShapePairTable& pair, W margin, W center_distance2, double step_s,
                   SlotFiller<W>* slots, uint32_t* overflow) noexcept {
  const double reach = m.shapes[pair.a].bound_m + m.shapes[pair.b].bound_m;
  const W limit = W::Splat(reach) + margin;
  const auto close = center_distance2 < limit * limit;
  if (!Any(close)) return;
  for (int lane = 0; lane < W::kLanes; ++lane) {
    if (!close[lane]) continue;
    PutTouches(m, s, g, work, pair, lane, margin[lane], step_s, slots, overflow);
  }
}

/// How far two bodies may reach for each other in this step,
template <class W>
TAUT_INLINE W Reach(const BodyWork<W>& a, const BodyWork<W>& b, W h) noexcept {
  return h * Norm1(a.v - b.v) + (a.turns + b.turns) + W::Splat(kContactMarginM);
}
/// and what they have used up of their clearance since the step before.
template <class W>
TAUT_INLINE W Used(const BodyWork<W>& a, const BodyWork<W>& b, W since_last) noexcept {
  return since_last * Norm1(a.v0 - b.v0) + (a.turned + b.turned);
}

/// Lanes in which two bodies may touch, as far as the last look knows, and how far each may reach.
template <class W>
MaskOf<W> ClearanceUsedUp(const View& m, const Rows<W>& s, const Scratch<W>& work, int pair, W h,
                          W since_last, W& margin) noexcept {
  const BodyPairTable& bodies = m.body_pairs[pair];
  const BodyWork<W>&a = work.bodies[bodies.a], &b = work.bodies[bodies.b];
  margin = Reach(a, b, h);
  s.clearance[pair] -= Used(a, b, since_last);
  return s.clearance[pair] < margin;
}

/// Whether two bodies may touch in some lane, and if so how far each may reach.
template <class W>
bool MayTouch(const View& m, const Rows<W>& s, const Scratch<W>& work, int pair, W h, W since_last,
              W& margin) noexcept {
  const BodyPairTable& bodies = m.body_pairs[pair];
  auto near = ClearanceUsedUp(m, s, work, pair, h, since_last, margin);
  if (!Any(near)) return false;
  if (bodies.b < m.body_count) {
    const V3<W> d = s.pos[bodies.a] - s.pos[bodies.b];
    const W reach = W::Splat(m.bound_m[bodies.a] + m.bound_m[bodies.b]);
    s.clearance[pair] = Max(s.clearance[pair], Sqrt(Dot(d, d)) - reach);
    near = s.clearance[pair] < margin;
    if (!Any(near)) return false;
  }
  const W exact = DistanceOfBodies(m, s, work, bodies, near);
  s.clearance[pair] = Select(near, exact, s.clearance[pair]);
  return Any(s.clearance[pair] < margin);
}

// Of a body and a world some of whose boxes touch each other (joined_boxes.inl).
template <class W>
void CollideJoined(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                   const BodyPairTable& bodies, W margin, double step_s, SlotFiller<W>* slots,
                   uint32_t* overflow) noexcept;

// Of a body and a world with many shapes (many_shapes.inl).
template <class W>
void CollideManyShapes(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work, int pair,
                       double step_s, W since_last, SlotFiller<W>* slots,
                       uint32_t* overflow) noexcept;

// Of a body's shapes and ground (ground.inl).
template <class W>
void CollideGround(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work, int first,
                   int end, double step_s, W since_last, SlotFiller<W>* slots,
                   uint32_t* overflow) noexcept;

template <class W>
void CollideBodies(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work, int pair,
                   double step_s, W since_last, SlotFiller<W>* slots, uint32_t* overflow) noexcept {
  const BodyPairTable& bodies = m.body_pairs[pair];
  if (bodies.by_tree) {
    CollideManyShapes(m, s, g, work, pair, step_s, since_last, slots, overflow);
    return;
  }
  W margin;
  if (!MayTouch(m, s, work, pair, W::Splat(step_s), since_last, margin)) return;
  if (bodies.joined) {
    CollideJoined(m, s, g, work, bodies, margin, step_s, slots, overflow);
    return;
  }
  for (int k = 0; k < bodies.pair_count; ++k) {
    const ShapePairTable& shapes = m.shape_pairs[bodies.first_pair + k];
    const V3<W> d = ShapeCenter(m, s, work, shapes.a) - ShapeCenter(m, s, work, shapes.b);
    CollideShapes(m, s, g, work, shapes, margin, Dot(d, d), step_s, slots, overflow);
  }
}

/// After bodies of a lane have been moved otherwise than by their velocities: how far they are from
/// each other is to be looked up again.
template <class W>
void LookAgain(const View& m, const Rows<W>& s, int lane) noexcept {
  for (int pair = 0; pair < m.body_pair_count; ++pair) s.clearance[pair].Set(lane, 0.0);
}

/// Stage: collide.
///   reads   pos, bodies[]     writes  contacts[], touches[] (geometry and materials), clearance
///   order   keys rising, in each body's slots and in each lane's list
/// Returns a bit for each lane that had more contacts than room.
template <class W>
uint32_t StageCollide(const View& m, const Rows<W>& s, const Group& g, Scratch<W>& work,
                      double step_s, W since_last) noexcept {
  const W h = W::Splat(step_s);
  BoundTurns(m, work, h, since_last);
  if (m.motion_count > 0) BoundMotions(m, s, work, h, since_last);
  uint32_t overflow = 0;
  int pair = 0;
  for (int body = 0; body < m.body_count; ++body) {
    SlotFiller<W> slots(m, work, body);
    CollidePlanes(m, s, work, h, body, slots);
    const auto is_mine = [&] { return pair < m.world_pair_count && m.body_pairs[pair].a == body; };
    for (; is_mine() && !m.body_pairs[pair].on_ground; ++pair) {
      CollideBodies(m, s, g, work, pair, step_s, since_last, &slots, &overflow);
    }
    if (const int first = pair; is_mine()) {  // ground comes last
      while (is_mine()) ++pair;
      CollideGround(m, s, g, work, first, pair, step_s, since_last, &slots, &overflow);
    }
    work.contact_count[body] = slots.count();
  }
  for (int lane = 0; lane < W::kLanes; ++lane) work.touch_count[lane] = 0;
  for (; pair < m.body_pair_count; ++pair) {
    CollideBodies<W>(m, s, g, work, pair, step_s, since_last, nullptr, &overflow);
  }
  return overflow;
}

}  // namespace taut::sim
