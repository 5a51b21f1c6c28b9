/// One contact: its equations, how it starts a step, how a sweep solves it by itself
/// (docs/theory/contact.md).
///
/// Every contact has an impulse (ln, l1, l2) along its normal and two tangents, and must satisfy
///   (C1)  ln >= 0,  un + bias >= 0,  ln (un + bias) = 0              no penetration
///   (C2)  |lt| <= mu ln,  and ut = 0 or lt = -mu ln ut / |ut|         Coulomb's exact cone
/// with u the contact's velocity after the step. A nonlinear Gauss-Seidel iteration goes through
/// the contacts in order, solves each by itself, and stops a lane when no impulse changed a
/// contact's velocity by more than the tolerance. A lane that is done freezes: its neighbours
/// cannot change it.

namespace taut::sim {

/// Penetration is pushed out by this share a step, and at most this fast.
inline constexpr double kPushOut = 0.2;
inline constexpr double kMaxPushOutMPerS = 0.5;
/// Slower impacts do not rebound [m/s].
inline constexpr double kLeastImpactMPerS = 1e-3;

template <class W>
TAUT_INLINE Lever<W> LeverOf(const V3<W>& arm, const ContactRow<W>& row) noexcept {
  return {Cross(arm, row.n), Cross(arm, row.t1), Cross(arm, row.t2)};
}
template <class W>
TAUT_INLINE Lever<W> operator*(const S3<W>& inv_inertia, const Lever<W>& j) noexcept {
  return {inv_inertia * j.n, inv_inertia * j.t1, inv_inertia * j.t2};
}

template <class W>
TAUT_INLINE V3<W> PointVelocity(const V3<W>& v, const V3<W>& w, const V3<W>& arm) noexcept {
  return v + Cross(w, arm);
}

/// Two unit tangents. With one friction direction the first lies along the sliding velocity that
/// would result without contact, as Bullet chooses it.
template <class W>
TAUT_INLINE void MakeTangents(ContactRow<W>& row, const V3<W>& velocity, bool along_slip) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  // Start from the axis of W that is certainly not along the normal.
  const auto steep = Abs(row.n.x) < W::Splat(0.6);
  V3<W> t = Select3(steep, V3<W>{one, zero, zero}, V3<W>{zero, one, zero});
  t -= Dot(t, row.n) * row.n;
  if (along_slip) {
    const V3<W> slide = velocity - Dot(velocity, row.n) * row.n;
    t = Select3(Dot(slide, slide) > W::Splat(1e-20), slide, t);
  }
  row.t1 = (one / Sqrt(Dot(t, t))) * t;
  row.t2 = Cross(row.n, row.t1);
}

template <class W>
TAUT_INLINE void AddInverseMass(ContactRow<W>& row, W im, const Lever<W>& j,
                                const Lever<W>& g) noexcept {
  row.wnn += im + Dot(j.n, g.n);
  row.w11 += im + Dot(j.t1, g.t1);
  row.w22 += im + Dot(j.t2, g.t2);
  row.w1n += Dot(j.t1, g.n);
  row.w2n += Dot(j.t2, g.n);
  row.w12 += Dot(j.t1, g.t2);
}

template <class W>
TAUT_INLINE void ApplyImpulse(BodyWork<W>& body, W im, const ContactRow<W>& row, const Lever<W>& g,
                              W ln, W l1, W l2) noexcept {
  const W an = im * ln, a1 = im * l1, a2 = im * l2;
  body.v += an * row.n + a1 * row.t1 + a2 * row.t2;
  body.w += ln * g.n + l1 * g.t1 + l2 * g.t2;
}

/// A contact that moves faster than this along its surface slides, a slower one sticks [m/s].
inline constexpr double kSlidingMPerS = 1e-6;

/// What a contact remembers of the step before; a new contact does not rebound.
template <class W>
struct ContactMemory {
  V3<W> force;
  W slip, bounce;
};

template <class W>
TAUT_INLINE ContactMemory<W> Recall(const Rows<W>& s, const Group& g, uint32_t id,
                                    int& cursor) noexcept {
  while (cursor < g.contact_count && g.contact_ids[cursor] < id) ++cursor;
  if (cursor < g.contact_count && g.contact_ids[cursor] == id) {
    return {s.cache_force[cursor], s.cache_slip[cursor], s.cache_bounce[cursor]};
  }
  const W zero = W::Splat(0.0);
  return {{zero, zero, zero}, W::Splat(kSlipUnknown), zero};
}

/// Rebounding: as fast as due. An impact in this step: remember how fast to rebound in the next,
/// when the surfaces touch. The approach speed is that of the moment of contact, and the rebound
/// starts half a step before its own middle (docs/theory/contact.md, eq. 9-10).
///   vn      normal velocity that would result without contact [m/s]
///   before  normal velocity before the step [m/s]
template <class W>
void PrepareRebound(ContactRow<W>& row, const ContactMemory<W>& memory, W h, W inv_h, W vn,
                    W before) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0), dv = vn - before;
  row.bias = Select(memory.bounce > zero, -memory.bounce, row.bias);
  const W share = Min(Max(row.gap, zero) * inv_h / Max(-vn, W::Splat(1e-12)), one);
  const W impact = vn - dv * (W::Splat(0.5) - share);
  const auto hits = (row.gap + h * vn < zero) & (memory.bounce == zero) &
                    (Dot(memory.force, row.n) == zero) &
                    (-impact > Max(W::Splat(kLeastImpactMPerS), Abs(dv + dv))) & (row.live > zero);
  row.bounce = Select(hits, Max(W::Splat(0.5) * dv - row.restitution * impact, zero), zero);
}

template <class W, bool kPair>
TAUT_INLINE void PrepareContact(const View& m, const Rows<W>& s, const Scratch<W>& work,
                                ContactRow<W>& row, const ContactMemory<W>& memory,
                                double step_s) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  const W h = W::Splat(step_s), inv_h = W::Splat(1.0 / step_s);
  const BodyWork<W>&a = work.bodies[row.a], &b = work.bodies[row.b];
  V3<W> free = PointVelocity(a.v, a.w, row.arm_a);
  V3<W> before = PointVelocity(a.v0, a.w0, row.arm_a);
  if (kPair) {
    free -= PointVelocity(b.v, b.w, row.arm_b);
    before -= PointVelocity(b.v0, b.w0, row.arm_b);
  }
  if (kPair || m.along_slip || row.id >= m.first_pair_id) MakeTangents(row, free, m.along_slip);

  row.wnn = row.w1n = row.w2n = row.w11 = row.w12 = row.w22 = zero;
  row.im_a = s.inv_mass[row.a];
  row.ja = LeverOf(row.arm_a, row);
  row.ga = a.inv_inertia * row.ja;
  AddInverseMass(row, row.im_a, row.ja, row.ga);
  if (kPair) {
    row.im_b = s.inv_mass[row.b];
    row.jb = LeverOf(row.arm_b, row);
    row.gb = b.inv_inertia * row.jb;
    AddInverseMass(row, row.im_b, row.jb, row.gb);
  }
  row.inv_nn = one / row.wnn;
  if (m.along_slip) {
    row.p11 = row.rho1 = one / row.w11;
    row.p12 = row.p22 = row.rho2 = zero;
  } else {
    const W inv_det = one / (row.w11 * row.w22 - row.w12 * row.w12);
    row.p11 = row.w22 * inv_det;
    row.p12 = -(row.w12 * inv_det);
    row.p22 = row.w11 * inv_det;
    row.rho1 = row.rho2 = one / (Max(row.w11, row.w22) + Abs(row.w12));
  }

  // Approaching: no further than to touch. Inside: out again, gently.
  const W out = Max(W::Splat(kPushOut) * row.gap * inv_h, W::Splat(-kMaxPushOutMPerS));
  row.bias = Select(row.gap > zero, row.gap * inv_h, out);

  row.bounce = zero;
  if (row.rebounds) PrepareRebound(row, memory, h, inv_h, Dot(free, row.n), Dot(before, row.n));
  row.slip = zero;
  W mu = row.kinetic_friction;
  if (row.breaks_away) {
    const V3<W> along = before - Dot(before, row.n) * row.n;
    const auto moving = Dot(along, along) > W::Splat(kSlidingMPerS * kSlidingMPerS);
    row.slip = Select(memory.slip < zero, Select(moving, one, zero), memory.slip);
    mu = Select(row.slip > zero, row.kinetic_friction, row.static_friction);
  }
  row.mu = s.friction_scale[0] * mu;
  row.ln = Max(h * Dot(memory.force, row.n), zero) * row.live;
  row.l1 = h * Dot(memory.force, row.t1) * row.live;
  row.l2 = m.along_slip ? zero : h * Dot(memory.force, row.t2) * row.live;
}

/// Whether a contact slid in this step: decides its coefficient in the next.
template <class W, bool kPair>
void JudgeSlip(const Scratch<W>& work, ContactRow<W>& row) noexcept {
  if (!row.breaks_away) return;
  const BodyWork<W>&a = work.bodies[row.a], &b = work.bodies[row.b];
  W u1 = Dot(row.t1, a.v) + Dot(row.ja.t1, a.w), u2 = Dot(row.t2, a.v) + Dot(row.ja.t2, a.w);
  if (kPair) {
    u1 -= Dot(row.t1, b.v) + Dot(row.jb.t1, b.w);
    u2 -= Dot(row.t2, b.v) + Dot(row.jb.t2, b.w);
  }
  const auto slides = u1 * u1 + u2 * u2 > W::Splat(kSlidingMPerS * kSlidingMPerS);
  row.slip = Select(slides, W::Splat(1.0), W::Splat(0.0));
}

/// One contact of one sweep. Returns the largest change of its velocity [m/s].
template <class W, bool kPair, class M>
W RelaxContact(Scratch<W>& work, ContactRow<W>& row, M lanes) noexcept {
  const W zero = W::Splat(0.0);
  BodyWork<W>&a = work.bodies[row.a], &b = work.bodies[row.b];
  W un = Dot(row.n, a.v) + Dot(row.ja.n, a.w);
  W u1 = Dot(row.t1, a.v) + Dot(row.ja.t1, a.w);
  W u2 = Dot(row.t2, a.v) + Dot(row.ja.t2, a.w);
  if (kPair) {
    un -= Dot(row.n, b.v) + Dot(row.jb.n, b.w);
    u1 -= Dot(row.t1, b.v) + Dot(row.jb.t1, b.w);
    u2 -= Dot(row.t2, b.v) + Dot(row.jb.t2, b.w);
  }
  const auto on = lanes & (row.live > zero);
  const W ln = Max(row.ln - row.inv_nn * (un + row.bias), zero);
  const W dn = Select(on, ln - row.ln, zero);
  row.ln += dn;
  u1 += row.w1n * dn;
  u2 += row.w2n * dn;

  // Sticking if the impulse that stops both tangential velocities lies in the cone.
  W l1 = row.l1 - (row.p11 * u1 + row.p12 * u2);
  W l2 = row.l2 - (row.p12 * u1 + row.p22 * u2);
  const W edge = row.mu * row.ln;
  const auto slides = l1 * l1 + l2 * l2 > edge * edge;
  if (Any(slides & on)) {
    const W s1 = row.l1 - row.rho1 * u1, s2 = row.l2 - row.rho2 * u2;
    const W norm2 = s1 * s1 + s2 * s2;
    const W scale = edge / Sqrt(Max(norm2, W::Splat(1e-300)));
    const W shrink = Min(scale, W::Splat(1.0));
    l1 = Select(slides, shrink * s1, l1);
    l2 = Select(slides, shrink * s2, l2);
  }
  const W d1 = Select(on, l1 - row.l1, zero), d2 = Select(on, l2 - row.l2, zero);
  row.l1 += d1;
  row.l2 += d2;
  ApplyImpulse(a, row.im_a, row, row.ga, dn, d1, d2);
  if (kPair) ApplyImpulse(b, row.im_b, row, row.gb, -dn, -d1, -d2);
  return Max(Abs(dn) * row.wnn, Max(Abs(d1) * row.w11, Abs(d2) * row.w22));
}

}  // namespace taut::sim
