/// Stage: where bodies touch the world and each other, at the middle of the step
/// (docs/theory/contact.md).
///
/// Points against planes are tested in all lanes at once. Everything else hides behind bounds:
/// a pair of bodies is looked at only when the motion since the last look may have used up the
/// distance found then, a pair of shapes only when their bounding spheres meet, and then each
/// lane by itself in scalar code (shape_pairs.inl).

namespace taut::sim {

/// How close a contact must be to get a row: what its body may travel in this step, and a bit.
inline constexpr double kContactMarginM = 1e-5;

template <class W>
TAUT_INLINE W TravelBound(const View& m, const Scratch<W>& work, int body, W h) noexcept {
  const BodyWork<W>& b = work.bodies[body];
  return h * (Norm1(b.v) + W::Splat(m.bound_m[body]) * Norm1(b.w));
}

/// How far any point of a body may have come since the middle of the step before.
template <class W>
TAUT_INLINE W TravelSinceLast(const View& m, const Scratch<W>& work, int body,
                              W since_last) noexcept {
  const BodyWork<W>& b = work.bodies[body];
  return since_last * (Norm1(b.v0) + W::Splat(m.bound_m[body]) * Norm1(b.w0));
}

/// Starts a row; the solver fills in the rest.
template <class W>
TAUT_INLINE ContactRow<W>& AddContact(Scratch<W>& work, int a, int b, uint32_t id,
                                      double static_friction, double kinetic_friction,
                                      double restitution) noexcept {
  ContactRow<W>& row = work.contacts[work.contact_count++];
  row.a = a;
  row.b = b;
  row.id = id;
  row.frame = W::Splat(-work.contact_count);  // like no other
  row.static_friction = W::Splat(static_friction);
  row.kinetic_friction = W::Splat(kinetic_friction);
  row.restitution = W::Splat(restitution);
  row.breaks_away = static_friction > kinetic_friction;
  row.rebounds = restitution > 0;
  return row;
}

template <class W>
void CollidePlanes(const View& m, const Rows<W>& s, Scratch<W>& work, W h) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  V3<W> normal_P[kMaxPlanes];
  W height[kMaxPlanes];
  bool near_plane[kMaxPlanes];
  for (int body = 0; body < m.body_count; ++body) {
    const int first = m.first_point[body], last = m.first_point[body + 1];
    if (first == last) continue;
    const BodyWork<W>& b = work.bodies[body];
    const W margin = TravelBound(m, work, body, h) + W::Splat(kContactMarginM);
    bool any = false;
    for (int k = 0; k < m.plane_count; ++k) {
      const V3<W> n = simd::Splat3<W>(m.planes[k].normal);
      height[k] = Dot(n, s.pos[body]) - W::Splat(m.planes[k].offset_m);
      near_plane[k] = Any(height[k] - W::Splat(m.bound_m[body]) < margin);
      any = any || near_plane[k];
      normal_P[k] = TransposeTimes(b.R, n);
    }
    if (!any) continue;
    for (int i = first; i < last; ++i) {
      const PointTable& point = m.points[i];
      const V3<W> p_P = simd::Splat3<W>(point.p_P);
      for (int k = 0; k < m.plane_count; ++k) {
        if (!near_plane[k]) continue;
        const W gap = height[k] + Dot(normal_P[k], p_P) - W::Splat(point.radius_m);
        const auto touching = gap < margin;
        if (!Any(touching)) continue;
        const PlaneTable& plane = m.planes[k];
        ContactRow<W>& row =
            AddContact(work, body, m.body_count, static_cast<uint32_t>(i * m.plane_count + k),
                       point.static_friction[k], point.kinetic_friction[k], point.restitution[k]);
        if (!m.along_slip) row.frame = W::Splat(k);
        row.n = simd::Splat3<W>(plane.normal);
        row.t1 = simd::Splat3<W>(plane.tangent1);
        row.t2 = simd::Splat3<W>(plane.tangent2);
        row.arm_a = b.R * p_P - W::Splat(point.radius_m) * row.n;
        row.live = Select(touching, one, zero);
        row.gap = gap;
      }
    }
  }
}

template <class W>
V3<W> ShapeCenter(const View& m, const Rows<W>& s, const Scratch<W>& work, int shape) noexcept {
  const ShapeTable& t = m.shapes[shape];
  const V3<W> p = work.bodies[t.body].R * simd::Splat3<W>(t.center_P);
  return t.body < m.body_count ? s.pos[t.body] + p : p;
}

/// A lower bound of the distance between all shapes of two bodies, in every lane.
template <class W>
W DistanceOfBodies(const View& m, const Rows<W>& s, const Scratch<W>& work,
                   const BodyPairTable& bodies) noexcept {
  W least = W::Splat(1e300);
  for (int i = 0; i < bodies.pair_count; ++i) {
    const ShapePairTable& pair = m.shape_pairs[bodies.first_pair + i];
    const V3<W> d = ShapeCenter(m, s, work, pair.a) - ShapeCenter(m, s, work, pair.b);
    W bound = Sqrt(Dot(d, d)) - W::Splat(m.shapes[pair.a].bound_m + m.shapes[pair.b].bound_m);
    const auto closer = bound < least;
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

/// Rows of one pair of shapes: the union over the lanes of their points.
template <class W>
void CollideShapes(const View& m, const Rows<W>& s, Scratch<W>& work, const ShapePairTable& pair,
                   W margin, W center_distance2, int* room, uint32_t* overflow) noexcept {
  const double reach = m.shapes[pair.a].bound_m + m.shapes[pair.b].bound_m;
  const W limit = W::Splat(reach) + margin;
  const auto close = center_distance2 < limit * limit;
  if (!Any(close)) return;
  ContactRow<W>* row_of[kMaxPointsPerPair] = {};
  TouchPoint found[W::kLanes][kMaxPointsPerPair];
  int found_count[W::kLanes];
  for (int lane = 0; lane < W::kLanes; ++lane) {
    found_count[lane] =
        close[lane] ? TouchLane(m, s, work, pair, lane, margin[lane], found[lane]) : 0;
    if (found_count[lane] > room[lane]) {
      found_count[lane] = room[lane];
      *overflow |= 1u << lane;
    }
    room[lane] -= found_count[lane];
  }
  const W zero = W::Splat(0.0);
  const int body_a = m.shapes[pair.a].body, body_b = m.shapes[pair.b].body;
  for (int feature = 0; feature < kMaxPointsPerPair; ++feature) {
    for (int lane = 0; lane < W::kLanes; ++lane) {
      for (int i = 0; i < found_count[lane]; ++i) {
        const TouchPoint& t = found[lane][i];
        if (t.feature != feature) continue;
        if (row_of[feature] == nullptr) {
          row_of[feature] =
              &AddContact(work, body_a, body_b, pair.id + static_cast<uint32_t>(feature),
                          pair.static_friction, pair.kinetic_friction, pair.restitution);
          ContactRow<W>& row = *row_of[feature];
          // Lanes without this point keep a harmless one.
          row.n = {zero, zero, W::Splat(1.0)};
          row.arm_a = row.arm_b = {zero, zero, zero};
          row.live = zero;
          row.gap = W::Splat(1.0);
        }
        ContactRow<W>& row = *row_of[feature];
        row.n.x.Set(lane, t.normal[0]);
        row.n.y.Set(lane, t.normal[1]);
        row.n.z.Set(lane, t.normal[2]);
        const V3<W>& xa = s.pos[body_a];
        row.arm_a.x.Set(lane, t.point[0] - xa.x[lane]);
        row.arm_a.y.Set(lane, t.point[1] - xa.y[lane]);
        row.arm_a.z.Set(lane, t.point[2] - xa.z[lane]);
        if (body_b < m.body_count) {
          const V3<W>& xb = s.pos[body_b];
          row.arm_b.x.Set(lane, t.point[0] - xb.x[lane]);
          row.arm_b.y.Set(lane, t.point[1] - xb.y[lane]);
          row.arm_b.z.Set(lane, t.point[2] - xb.z[lane]);
        }
        row.live.Set(lane, 1.0);
        row.gap.Set(lane, t.gap_m);
      }
    }
  }
}

template <class W>
void CollideBodies(const View& m, const Rows<W>& s, Scratch<W>& work, W h, W since_last, int* room,
                   uint32_t* overflow) noexcept {
  for (int i = 0; i < m.body_pair_count; ++i) {
    const BodyPairTable& bodies = m.body_pairs[i];
    const W margin = TravelBound(m, work, bodies.a, h) + TravelBound(m, work, bodies.b, h) +
                     W::Splat(kContactMarginM);
    s.clearance[i] -= TravelSinceLast(m, work, bodies.a, since_last) +
                      TravelSinceLast(m, work, bodies.b, since_last);
    if (!Any(s.clearance[i] < margin)) continue;
    s.clearance[i] = DistanceOfBodies(m, s, work, bodies);
    if (!Any(s.clearance[i] < margin)) continue;
    for (int k = 0; k < bodies.pair_count; ++k) {
      const ShapePairTable& pair = m.shape_pairs[bodies.first_pair + k];
      const V3<W> d = ShapeCenter(m, s, work, pair.a) - ShapeCenter(m, s, work, pair.b);
      CollideShapes(m, s, work, pair, margin, Dot(d, d), room, overflow);
    }
  }
}

/// Stage: collide.
///   reads   pos, bodies[]     writes  contacts[] (geometry and materials), clearance
///   order   ids rising; contacts with the world first
/// Returns a bit for each lane that had more contacts than room.
template <class W>
uint32_t StageCollide(const View& m, const Rows<W>& s, Scratch<W>& work, W h,
                      W since_last) noexcept {
  work.contact_count = 0;
  CollidePlanes(m, s, work, h);
  work.plane_count = work.contact_count;
  int room[W::kLanes];
  for (int lane = 0; lane < W::kLanes; ++lane) room[lane] = m.pair_capacity;
  uint32_t overflow = 0;
  CollideBodies(m, s, work, h, since_last, room, &overflow);
  work.single_count = 0;
  while (work.single_count < work.contact_count &&
         work.contacts[work.single_count].b == m.body_count) {
    ++work.single_count;
  }
  return overflow;
}

}  // namespace taut::sim
