/// A body's contacts with planes are solved together, by Newton's method (docs/theory/contact.md,
/// eq. 14-18).
///
/// The equations (C1), (C2) in the form of Alart and Curnier are piecewise smooth; Newton's method
/// solves them in two or three iterations where going from contact to contact crawls: when they
/// hand friction to each other. With soft cables a body that touches only the ground is an island,
/// and one sweep is all. A lane in which a body has more contacts than a block holds, or Newton
/// does not help, goes from contact to contact.

namespace taut::sim {

inline constexpr int kMaxBlockContacts = 4;

template <class W, int kContacts>
class ContactBlock {
  static constexpr int kSize = 3 * kContacts;
  static constexpr int kMaxIterations = 6;
  /// Redundant friction (two contacts on one rod, along the rod) leaves the system singular; this
  /// much compliance chooses the change that is smallest, and is iterated away.
  static constexpr double kCompliance = 1e-9;

 public:
  ContactBlock(Scratch<W>& work, ContactRow<W>* rows, bool along_slip) noexcept
      : work_(work), rows_(rows), along_slip_(along_slip) {}

  /// Solves the block in `lanes`. Returns how far it was from solved before, as other rows may
  /// disturb it again; in lanes where none can, how far it is now [m/s].
  template <class M>
  W Solve(W tolerance, M lanes, M coupled) noexcept {
    const W zero = W::Splat(0.0);
    Start();
    const W first_residual = Residual();
    W residual = first_residual;
    auto busy = lanes & (residual > tolerance);
    if (!Any(busy)) return first_residual;
    BuildMatrix();
    W start[kSize];
    for (int i = 0; i < kSize; ++i) start[i] = lambda_[i];
    for (int iteration = 0; iteration < kMaxIterations && Any(busy); ++iteration) {
      SolveLinear(busy);
      for (int i = 0; i < kSize; ++i) delta_[i] = Select(busy, delta_[i], zero);
      for (int i = 0; i < kSize; ++i) {
        lambda_[i] += delta_[i];
        W change = zero;
        for (int j = 0; j < kSize; ++j) change += w_[i][j] * delta_[j];
        u_[i] += change;
      }
      residual = Select(busy, Residual(), residual);
      busy = busy & (residual > tolerance);
    }
    const auto better = lanes & (residual < first_residual);
    for (int c = 0; c < kContacts; ++c) {
      ContactRow<W>& row = rows_[c];
      const int n = 3 * c;
      // A contact that Newton leaves a rounding below zero is open.
      const W ln = Max(lambda_[n], zero);
      const W dn = Select(better, ln - start[n], zero);
      const W d1 = Select(better, lambda_[n + 1] - start[n + 1], zero);
      const W d2 = Select(better, lambda_[n + 2] - start[n + 2], zero);
      row.ln += dn;
      row.l1 += d1;
      row.l2 += d2;
      ApplyImpulse(work_.bodies[row.a], row.im_a, row, row.ga, dn, d1, d2);
    }
    const auto stuck = lanes & (first_residual > tolerance) & !better;
    if (Any(stuck)) {
      for (int c = 0; c < kContacts; ++c) RelaxContact<W, false>(work_, rows_[c], stuck);
    }
    return Select(coupled | !better, first_residual, residual);
  }

 private:
  void Start() noexcept {
    for (int c = 0; c < kContacts; ++c) {
      const ContactRow<W>& row = rows_[c];
      const BodyWork<W>& body = work_.bodies[row.a];
      u_[3 * c] = Dot(row.n, body.v) + Dot(row.ja.n, body.w);
      u_[3 * c + 1] = Dot(row.t1, body.v) + Dot(row.ja.t1, body.w);
      u_[3 * c + 2] = Dot(row.t2, body.v) + Dot(row.ja.t2, body.w);
      lambda_[3 * c] = row.ln;
      lambda_[3 * c + 1] = row.l1;
      lambda_[3 * c + 2] = row.l2;
    }
  }

  /// What one sweep would change, in contact velocity; each contact by itself [m/s].
  W Residual() noexcept {
    const W zero = W::Splat(0.0), one = W::Splat(1.0);
    W worst = zero;
    for (int c = 0; c < kContacts; ++c) {
      const ContactRow<W>& row = rows_[c];
      const auto live = row.live > zero;
      const W *u = u_ + 3 * c, *l = lambda_ + 3 * c;
      const W ln = Max(l[0] - row.inv_nn * (u[0] + row.bias), zero);
      closed_[c] = live & (ln > zero);
      W s1 = l[1] - (row.p11 * u[1] + row.p12 * u[2]);
      W s2 = l[2] - (row.p12 * u[1] + row.p22 * u[2]);
      const W edge = row.mu * Max(l[0], zero);
      // Sliding is decided by the short step rho: a long one may reach across the cone and out at
      // its far side, where an impulse that drives the contact backwards looks like a solution.
      const W g1 = l[1] - row.rho1 * u[1], g2 = l[2] - row.rho2 * u[2];
      const W g_squared = g1 * g1 + g2 * g2;
      slides_[c] = closed_[c] & (g_squared > edge * edge);
      if (Any(slides_[c])) {
        const W inverse = one / Sqrt(Max(g_squared, W::Splat(1e-300)));
        slide_[c] = {g1 * inverse, g2 * inverse, edge * inverse};
        s1 = Select(slides_[c], edge * slide_[c].x, s1);
        s2 = Select(slides_[c], edge * slide_[c].y, s2);
      }
      s1 = Select(closed_[c], s1, zero);
      s2 = Select(closed_[c], s2, zero);
      const W change =
          Max(Abs(ln - l[0]) * row.wnn, Max(Abs(s1 - l[1]) * row.w11, Abs(s2 - l[2]) * row.w22));
      worst = Max(Select(live, change, zero), worst);
    }
    return worst;
  }

  /// W = J M^-1 J^T. Contacts with one plane share their directions, whose products are 0 and 1.
  void BuildMatrix() noexcept {
    const W zero = W::Splat(0.0), one = W::Splat(1.0);
    for (int i = 0; i < kContacts; ++i) {
      const ContactRow<W>& a = rows_[i];
      SetBlock(i, i, a.wnn, a.w1n, a.w2n, a.w1n, a.w11, a.w12, a.w2n, a.w12, a.w22);
      for (int j = i + 1; j < kContacts; ++j) {
        const ContactRow<W>& b = rows_[j];
        const Lever<W>&l = a.ja, &g = b.ga;
        W nn = Dot(l.n, g.n), n1 = Dot(l.n, g.t1), n2 = Dot(l.n, g.t2);
        W t1n = Dot(l.t1, g.n), t11 = Dot(l.t1, g.t1), t12 = Dot(l.t1, g.t2);
        W t2n = Dot(l.t2, g.n), t21 = Dot(l.t2, g.t1), t22 = Dot(l.t2, g.t2);
        const auto same = a.frame == b.frame;
        nn += a.im_a * Product(same, a.n, b.n, one);
        t11 += a.im_a * Product(same, a.t1, b.t1, one);
        t22 += a.im_a * Product(same, a.t2, b.t2, one);
        if (Any(!same)) {
          n1 += a.im_a * Product(same, a.n, b.t1, zero);
          n2 += a.im_a * Product(same, a.n, b.t2, zero);
          t1n += a.im_a * Product(same, a.t1, b.n, zero);
          t12 += a.im_a * Product(same, a.t1, b.t2, zero);
          t2n += a.im_a * Product(same, a.t2, b.n, zero);
          t21 += a.im_a * Product(same, a.t2, b.t1, zero);
        }
        SetBlock(i, j, nn, n1, n2, t1n, t11, t12, t2n, t21, t22);
        SetBlock(j, i, nn, t1n, t2n, n1, t11, t21, n2, t12, t22);
      }
    }
  }

  /// a . b, which is known where both belong to the same frame.
  template <class M>
  static W Product(M same, const V3<W>& a, const V3<W>& b, W known) noexcept {
    return Any(!same) ? Select(same, known, Dot(a, b)) : known;
  }

  void SetBlock(int i, int j, W nn, W n1, W n2, W t1n, W t11, W t12, W t2n, W t21, W t22) noexcept {
    W* const n = w_[3 * i] + 3 * j;
    W* const t1 = w_[3 * i + 1] + 3 * j;
    W* const t2 = w_[3 * i + 2] + 3 * j;
    n[0] = nn, n[1] = n1, n[2] = n2;
    t1[0] = t1n, t1[1] = t11, t1[2] = t12;
    t2[0] = t2n, t2[1] = t21, t2[2] = t22;
  }

  /// Newton's step in every lane, by the way that fits the lane: the other lanes have no say in it.
  template <class M>
  void SolveLinear(M lanes) noexcept {
    auto sliding = along_slip_ ? M::Splat(true) : slides_[0];
    for (int c = 1; c < kContacts; ++c) sliding = sliding | slides_[c];
    const bool some_stick = Any(lanes & (!sliding)), some_slide = Any(lanes & sliding);
    if (some_stick) SolveSticking();
    if (!some_slide) return;
    W sticking[kSize];
    for (int i = 0; i < kSize; ++i) sticking[i] = delta_[i];
    Linearize();
    Eliminate();
    if (!some_stick) return;
    for (int i = 0; i < kSize; ++i) delta_[i] = Select(sliding, delta_[i], sticking[i]);
  }

  /// Newton's step where every contact sticks or is open: a symmetric system, a third of the work.
  void SolveSticking() noexcept {
    const W zero = W::Splat(0.0), one = W::Splat(1.0);
    const W soft = W::Splat(1.0 + kCompliance);
    for (int c = 0; c < kContacts; ++c) {
      const auto closed = closed_[c];
      delta_[3 * c] = Select(closed, -(u_[3 * c] + rows_[c].bias), -lambda_[3 * c]);
      for (int k = 3 * c + 1; k < 3 * c + 3; ++k) delta_[k] = Select(closed, -u_[k], -lambda_[k]);
    }
    for (int i = 0; i < kSize; ++i) {
      const auto closed = closed_[i / 3];
      for (int j = 0; j < i; ++j) {
        const auto other = closed_[j / 3];
        a_[i][j] = Select(closed & other, w_[i][j], zero);
        // What opens lets go of its impulse, and the others feel that.
        if (i / 3 == j / 3) continue;
        delta_[i] += Select(closed & (!other), w_[i][j] * lambda_[j], zero);
        delta_[j] += Select(other & (!closed), w_[i][j] * lambda_[i], zero);
      }
      a_[i][i] = Select(closed, soft * w_[i][i], one);
    }
    // a = L D L^T, then forward, through D, and back.
    for (int k = 0; k < kSize; ++k) {
      const W inverse = one / a_[k][k];
      for (int i = k + 1; i < kSize; ++i) {
        const W factor = a_[i][k] * inverse;
        for (int j = k + 1; j <= i; ++j) a_[i][j] -= factor * a_[j][k];
        delta_[i] -= factor * delta_[k];
      }
      a_[k][k] = inverse;
    }
    for (int k = kSize - 1; k >= 0; --k) {
      for (int j = k + 1; j < kSize; ++j) delta_[k] -= a_[j][k] * delta_[j];
      delta_[k] = delta_[k] * a_[k][k];
    }
  }

  /// The rows of Newton's linear system, each scaled so that its diagonal is about one.
  void Linearize() noexcept {
    const W zero = W::Splat(0.0), one = W::Splat(1.0);
    const W soft = W::Splat(1.0 + kCompliance);
    for (int c = 0; c < kContacts; ++c) {
      const ContactRow<W>& row = rows_[c];
      const int n = 3 * c, t1 = n + 1, t2 = n + 2;
      const auto closed = closed_[c], slides = slides_[c];
      const auto sticks = closed & !slides;
      const W un = row.inv_nn * (u_[n] + row.bias);
      const W scale1 = one / row.w11, scale2 = one / row.w22;
      const V3<W> s = slide_[c];
      const W m11 = s.z * (one - s.x * s.x), m12 = -(s.z * s.x * s.y),
              m22 = s.z * (one - s.y * s.y);
      for (int j = 0; j < kSize; ++j) {
        a_[n][j] = Select(closed, row.inv_nn * w_[n][j], zero);
        const W r1 = row.rho1 * w_[t1][j], r2 = row.rho2 * w_[t2][j];
        a_[t1][j] = Select(sticks, scale1 * w_[t1][j], Select(slides, m11 * r1 + m12 * r2, zero));
        a_[t2][j] = Select(sticks, scale2 * w_[t2][j], Select(slides, m12 * r1 + m22 * r2, zero));
      }
      a_[n][n] = Select(closed, soft * a_[n][n], one);
      a_[t1][n] -= Select(slides, row.mu * s.x, zero);
      a_[t2][n] -= Select(slides, row.mu * s.y, zero);
      a_[t1][t1] = Select(slides, a_[t1][t1] + one - m11, Select(sticks, soft * a_[t1][t1], one));
      a_[t1][t2] -= Select(slides, m12, zero);
      a_[t2][t1] -= Select(slides, m12, zero);
      a_[t2][t2] = Select(slides, a_[t2][t2] + one - m22, Select(sticks, soft * a_[t2][t2], one));
      const W edge = row.mu * Max(lambda_[n], zero);
      delta_[n] = Select(closed, -un, -lambda_[n]);
      delta_[t1] = Select(slides, edge * s.x - lambda_[t1],
                          Select(sticks, -(scale1 * u_[t1]), -lambda_[t1]));
      delta_[t2] = Select(slides, edge * s.y - lambda_[t2],
                          Select(sticks, -(scale2 * u_[t2]), -lambda_[t2]));
      if (!along_slip_) continue;
      for (int j = 0; j < kSize; ++j) a_[t2][j] = zero;  // no friction in this direction
      a_[t2][t2] = one;
      delta_[t2] = -lambda_[t2];
    }
  }

  /// Gaussian elimination; the diagonal dominates enough to go without pivots, and a lane for
  /// which that is not so is sorted out by the comparison of residuals.
  void Eliminate() noexcept {
    for (int k = 0; k < kSize; ++k) {
      const W inverse = W::Splat(1.0) / a_[k][k];
      for (int i = k + 1; i < kSize; ++i) {
        const W factor = a_[i][k] * inverse;
        for (int j = k + 1; j < kSize; ++j) a_[i][j] -= factor * a_[k][j];
        delta_[i] -= factor * delta_[k];
      }
      a_[k][k] = inverse;
    }
    for (int k = kSize - 1; k >= 0; --k) {
      for (int j = k + 1; j < kSize; ++j) delta_[k] -= a_[k][j] * delta_[j];
      delta_[k] = delta_[k] * a_[k][k];
    }
  }

  using MaskType = decltype(W() < W());
  Scratch<W>& work_;
  ContactRow<W>* rows_;
  bool along_slip_;
  MaskType closed_[kContacts], slides_[kContacts];
  V3<W> slide_[kContacts] = {};  ///< Sliding direction, and edge / |s|.
  W u_[kSize], lambda_[kSize], delta_[kSize] = {};
  W w_[kSize][kSize], a_[kSize][kSize];
};

template <class W, class M>
W SolveBlock(Scratch<W>& work, ContactRow<W>* rows, int count, bool along_slip, W tolerance,
             M lanes, M coupled) noexcept {
  switch (count) {
    case 1:
      return ContactBlock<W, 1>(work, rows, along_slip).Solve(tolerance, lanes, coupled);
    case 2:
      return ContactBlock<W, 2>(work, rows, along_slip).Solve(tolerance, lanes, coupled);
    case 3:
      return ContactBlock<W, 3>(work, rows, along_slip).Solve(tolerance, lanes, coupled);
    default:
      return ContactBlock<W, 4>(work, rows, along_slip).Solve(tolerance, lanes, coupled);
  }
}

/// The wide numbers of a row, without its indices: one lane of them can be copied.
template <class W>
void CopyLane(const ContactRow<W>& from, ContactRow<W>& to, int lane) noexcept {
  const auto* source = reinterpret_cast<const double*>(&from.n) + lane;
  auto* target = reinterpret_cast<double*>(&to.n) + lane;
  const auto* end = reinterpret_cast<const double*>(&from + 1);
  for (; source < end; source += W::kLanes, target += W::kLanes) *target = *source;
}

/// A block in which the lanes together have more contacts than fit. Each lane's own contacts are
/// packed, so that a lane gets what it would get alone; one with too many goes one by one.
template <class W, class M>
W SolveCrowdedBlock(Scratch<W>& work, ContactRow<W>* rows, int count, bool along_slip, W tolerance,
                    M lanes, M coupled) noexcept {
  const W zero = W::Splat(0.0);
  ContactRow<W> packed[kMaxBlockContacts];
  int place[W::kLanes][kMaxBlockContacts];
  int packed_count[W::kLanes];
  auto fits = lanes;
  for (ContactRow<W>& row : packed) {
    row = rows[0];
    row.live = row.ln = row.l1 = row.l2 = zero;
  }
  int largest = 1;
  for (int lane = 0; lane < W::kLanes; ++lane) {
    int n = 0;
    for (int i = 0; i < count; ++i) {
      if (!(rows[i].live[lane] > 0)) continue;
      if (n < kMaxBlockContacts) {
        CopyLane(rows[i], packed[n], lane);
        place[lane][n] = i;
      }
      ++n;
    }
    if (n > kMaxBlockContacts) {
      fits.Set(lane, false);
      for (ContactRow<W>& row : packed) row.live.Set(lane, 0.0);
      n = 0;
    }
    packed_count[lane] = n;
    if (n > largest) largest = n;
  }
  W change = SolveBlock(work, packed, largest, along_slip, tolerance, fits, coupled);
  for (int lane = 0; lane < W::kLanes; ++lane) {
    for (int i = 0; i < packed_count[lane]; ++i) CopyLane(packed[i], rows[place[lane][i]], lane);
  }
  const auto crowded = lanes & !fits;
  if (!Any(crowded)) return change;
  change = Select(crowded, zero, change);
  for (int i = 0; i < count; ++i) {
    const W c = RelaxContact<W, false>(work, rows[i], crowded);
    change = Max(Select(crowded, c, zero), change);
  }
  return change;
}

/// One sweep over the contacts with planes, a body at a time. Returns the largest residual before.
template <class W, class M>
W RelaxBlocks(const View& m, Scratch<W>& work, W tolerance, M lanes, M coupled) noexcept {
  W change = W::Splat(0.0);
  int first = 0;
  while (first < work.plane_count) {
    ContactRow<W>* const rows = work.contacts + first;
    int count = 1;
    while (first + count < work.plane_count && rows[count].a == rows[0].a) ++count;
    const W c = count <= kMaxBlockContacts
                    ? SolveBlock(work, rows, count, m.along_slip, tolerance, lanes, coupled)
                    : SolveCrowdedBlock(work, rows, count, m.along_slip, tolerance, lanes, coupled);
    change = Max(c, change);
    first += count;
  }
  return change;
}

}  // namespace taut::sim
