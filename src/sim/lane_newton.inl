/// Where sweeps crawl, all contacts and stiff cables of one lane are solved together, by Newton's
/// method (docs/theory/contact.md, eq. 19-20).
///
/// Bodies that are wedged between each other hand a little of their loads on at every sweep, and
/// share them among more contacts than are needed to carry them. Newton's method finds in some ten
/// iterations what takes sweeps thousands. It is the way out, not the rule: used after
/// kSweepsBeforeNewton sweeps without success, for a lane at a time, in plain doubles. What it
/// finds counts only if it is better, and the sweeps that follow judge it.

namespace taut::sim {

inline constexpr int kSweepsBeforeNewton = 32;

TAUT_INLINE double Dot3(const double* a, const double* b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class W>
class LaneNewton {
  static constexpr int kMaxRounds = 20;
  static constexpr int kMaxIterations = 12;
  /// Where Newton's method is of no use, it should at least not take long: so many multiplications.
  static constexpr double kMaxWork = 2e7;
  /// Compliance of the first round, as a share of each row's inverse effective mass; the next has
  /// a tenth of it, or, where Newton's method failed, thirty times as much.
  static constexpr double kFirstCompliance = 1e-3;
  /// The sweeps that judge add up what single contacts leave: solve better than they ask.
  static constexpr double kMargin = 0.01;

 public:
  LaneNewton(Scratch<W>& work, int lane, bool along_slip) noexcept
      : work_(work), mem_(work.newton), lane_(lane), along_slip_(along_slip) {}

  /// Improves the lane's impulses and velocities, if it can. False if trying again is no use.
  bool Solve(double tolerance_m_per_s) noexcept {
    const double goal = kMargin * tolerance_m_per_s;
    if (!Gather()) return false;
    BuildMatrix();
    const double first = Residual();
    double best = first;
    compliance_ = kFirstCompliance;
    for (int round = 0; round < kMaxRounds && best > goal && work_done_ < kMaxWork; ++round) {
      for (int i = 0; i < count_; ++i) {
        mem_.center[i] = mem_.lambda[i];
        mem_.center_u[i] = mem_.u[i];
      }
      if (!SolveCompliant(goal)) {
        compliance_ *= 30;
        for (int i = 0; i < count_; ++i) {
          mem_.lambda[i] = mem_.center[i];
          mem_.u[i] = mem_.center_u[i];
        }
        continue;
      }
      for (int i = 0; i < count_; ++i) mem_.u[i] -= Soft(i) * (mem_.lambda[i] - mem_.center[i]);
      const double residual = Residual();
      if (residual < best) {
        best = residual;
        for (int i = 0; i < count_; ++i) mem_.best[i] = mem_.lambda[i];
      }
      compliance_ *= 0.1;
    }
    if (best < first) Scatter();
    return best < 0.9 * first;
  }

 private:
  double Lane(const W& x) const noexcept { return x[lane_]; }
  /// The compliance of row i [1/kg].
  double Soft(int i) const noexcept { return compliance_ * mem_.w[i * count_ + i]; }

  /// Newton's method on the equations with compliance: (19). False if it does not get there.
  bool SolveCompliant(double goal) noexcept {
    for (int iteration = 0;; ++iteration) {
      if (!(Residual() > goal)) return true;
      if (iteration == kMaxIterations || work_done_ > kMaxWork) return false;
      Linearize();
      if (!Eliminate()) return false;
      for (int i = 0; i < count_; ++i) {
        mem_.lambda[i] += mem_.delta[i];
        double change = Soft(i) * mem_.delta[i];
        for (int j = 0; j < count_; ++j) change += mem_.w[i * count_ + j] * mem_.delta[j];
        mem_.u[i] += change;
      }
    }
  }

  void Take(const V3<W>& v, double sign, double* out) const noexcept {
    out[0] = sign * v.x[lane_], out[1] = sign * v.y[lane_], out[2] = sign * v.z[lane_];
  }
  void AddLink(int body, const V3<W>& lin, const V3<W>& ang, const V3<W>& g, const W& im,
               double sign) noexcept {
    NewtonLink& link = mem_.links[link_count_++];
    link.body = body;
    Take(lin, sign, link.lin);
    Take(ang, sign, link.ang);
    Take(g, sign, link.g);
    link.im = im[lane_];
    ++mem_.rows[count_].link_count;
  }
  void BeginRow() noexcept { mem_.rows[count_] = {link_count_, 0}; }
  void EndRow(double lambda) noexcept {
    const NewtonRow& row = mem_.rows[count_];
    double u = 0;
    for (int i = 0; i < row.link_count; ++i) {
      const NewtonLink& link = mem_.links[row.first_link + i];
      double v[3], w[3];
      Take(work_.bodies[link.body].v, 1, v);
      Take(work_.bodies[link.body].w, 1, w);
      u += Dot3(link.lin, v) + Dot3(link.ang, w);
    }
    mem_.u[count_] = u;
    mem_.lambda[count_] = mem_.start[count_] = lambda;
    ++count_;
  }

  /// The lane's equations; false if they do not fit.
  bool Gather() noexcept {
    for (int i = 0; i < work_.contact_count; ++i) {
      const ContactRow<W>& c = work_.contacts[i];
      if (!(c.live[lane_] > 0)) continue;
      if (count_ + 3 > mem_.capacity) return false;
      mem_.contacts[contact_count_++] = i;
      const bool pair = i >= work_.single_count;
      const V3<W>* const directions[3] = {&c.n, &c.t1, &c.t2};
      const V3<W>* const levers[3][4] = {{&c.ja.n, &c.ga.n, &c.jb.n, &c.gb.n},
                                         {&c.ja.t1, &c.ga.t1, &c.jb.t1, &c.gb.t1},
                                         {&c.ja.t2, &c.ga.t2, &c.jb.t2, &c.gb.t2}};
      const double lambda[3] = {c.ln[lane_], c.l1[lane_], c.l2[lane_]};
      for (int k = 0; k < 3; ++k) {
        BeginRow();
        AddLink(c.a, *directions[k], *levers[k][0], *levers[k][1], c.im_a, 1);
        if (pair) AddLink(c.b, *directions[k], *levers[k][2], *levers[k][3], c.im_b, -1);
        EndRow(lambda[k]);
      }
    }
    for (int i = 0; i < work_.stiff_count; ++i) {
      const StiffCable<W>& cable = work_.stiff[i];
      if (!(cable.on[lane_] > 0)) continue;
      if (count_ == mem_.capacity) return false;
      mem_.cables[cable_count_++] = i;
      BeginRow();
      for (int k = 0; k < cable.link_count; ++k) {
        const CableLink<W>& link = work_.links[cable.first_link + k];
        AddLink(link.body, link.F, link.Q, link.GQ, link.im, 1);
      }
      EndRow(cable.lambda[lane_]);
    }
    return true;
  }

  void BuildMatrix() noexcept {
    for (int i = 0; i < count_; ++i) {
      for (int j = 0; j <= i; ++j) {
        const NewtonRow &r = mem_.rows[i], &s = mem_.rows[j];
        double sum = 0;
        for (int k = 0; k < r.link_count; ++k) {
          const NewtonLink& x = mem_.links[r.first_link + k];
          for (int l = 0; l < s.link_count; ++l) {
            const NewtonLink& y = mem_.links[s.first_link + l];
            if (x.body == y.body) sum += x.im * Dot3(x.lin, y.lin) + Dot3(x.ang, y.g);
          }
        }
        mem_.w[i * count_ + j] = mem_.w[j * count_ + i] = sum;
      }
    }
  }

  struct ContactState {
    bool closed, slides;
    double s1, s2, shrink;  ///< Sliding direction; edge / |s|.
    double change;          ///< What one sweep would change [m/s].
  };
  ContactState StateOf(int c) const noexcept {
    const ContactRow<W>& row = work_.contacts[mem_.contacts[c]];
    const double *u = mem_.u + 3 * c, *l = mem_.lambda + 3 * c;
    ContactState state{};
    const double ln = MaxOf(l[0] - Lane(row.inv_nn) * (u[0] + Lane(row.bias)), 0);
    state.closed = ln > 0;
    double l1 = 0, l2 = 0;
    if (state.closed) {
      l1 = l[1] - (Lane(row.p11) * u[1] + Lane(row.p12) * u[2]);
      l2 = l[2] - (Lane(row.p12) * u[1] + Lane(row.p22) * u[2]);
      const double edge = Lane(row.mu) * MaxOf(l[0], 0);
      const double g1 = l[1] - Lane(row.rho1) * u[1], g2 = l[2] - Lane(row.rho2) * u[2];
      const double norm2 = g1 * g1 + g2 * g2;
      state.slides = norm2 > edge * edge;
      if (state.slides) {
        const double inverse = 1 / __builtin_sqrt(MaxOf(norm2, 1e-300));
        state.s1 = g1 * inverse;
        state.s2 = g2 * inverse;
        state.shrink = edge * inverse;
        l1 = edge * state.s1;
        l2 = edge * state.s2;
      }
    }
    state.change = AbsOf(ln - l[0]) * Lane(row.wnn);
    state.change = MaxOf(state.change, AbsOf(l1 - l[1]) * Lane(row.w11));
    state.change = MaxOf(state.change, AbsOf(l2 - l[2]) * Lane(row.w22));
    return state;
  }
  static double AbsOf(double x) noexcept { return x < 0 ? -x : x; }
  static double MaxOf(double a, double b) noexcept { return a > b ? a : b; }

  double Residual() const noexcept {
    double worst = 0;
    for (int c = 0; c < contact_count_; ++c) worst = MaxOf(worst, StateOf(c).change);
    for (int k = 0; k < cable_count_; ++k) {
      const StiffCable<W>& cable = work_.stiff[mem_.cables[k]];
      const int i = 3 * contact_count_ + k;
      const double change = AbsOf(CableWish(cable, i) - mem_.lambda[i]);
      worst = MaxOf(worst, change * Lane(cable.A));
    }
    return worst;
  }
  double CableWish(const StiffCable<W>& cable, int i) const noexcept {
    const double l = mem_.lambda[i];
    const double wish =
        MaxOf(l + Lane(cable.inverse) * (Lane(cable.base) - Lane(cable.gain) * mem_.u[i] - l), 0);
    return wish < Lane(cable.upper) ? wish : Lane(cable.upper);
  }

  /// The rows of Newton's linear system, each scaled so that its diagonal is about one.
  void Linearize() noexcept {
    for (int i = 0; i < count_ * count_; ++i) mem_.a[i] = 0;
    for (int c = 0; c < contact_count_; ++c) LinearizeContact(c);
    for (int k = 0; k < cable_count_; ++k) LinearizeCable(k);
  }

  void LinearizeContact(int c) noexcept {
    const ContactRow<W>& row = work_.contacts[mem_.contacts[c]];
    const ContactState state = StateOf(c);
    const int n = count_, i = 3 * c;
    const double* const l = mem_.lambda + i;
    double *const a0 = mem_.a + i * n, *const a1 = a0 + n, *const a2 = a1 + n;
    const double *const w0 = mem_.w + i * n, *const w1 = w0 + n, *const w2 = w1 + n;
    if (!state.closed) {
      for (int k = 0; k < 3; ++k) {
        a0[k * n + i + k] = 1;
        mem_.delta[i + k] = -l[k];
      }
      return;
    }
    const double scale = Lane(row.inv_nn);
    for (int j = 0; j < n; ++j) a0[j] = scale * w0[j];
    a0[i] += scale * Soft(i);
    mem_.delta[i] = -scale * (mem_.u[i] + Lane(row.bias));
    if (state.slides) {
      const double q = state.shrink, r1 = Lane(row.rho1), r2 = Lane(row.rho2);
      const double m11 = q * (1 - state.s1 * state.s1), m12 = -q * state.s1 * state.s2,
                   m22 = q * (1 - state.s2 * state.s2);
      for (int j = 0; j < n; ++j) {
        a1[j] = m11 * r1 * w1[j] + m12 * r2 * w2[j];
        a2[j] = m12 * r1 * w1[j] + m22 * r2 * w2[j];
      }
      const double e1 = r1 * Soft(i + 1), e2 = r2 * Soft(i + 2);
      const double mu = Lane(row.mu), edge = mu * MaxOf(l[0], 0);
      a1[i] -= mu * state.s1;
      a2[i] -= mu * state.s2;
      a1[i + 1] += 1 - m11 + m11 * e1;
      a1[i + 2] += m12 * e2 - m12;
      a2[i + 1] += m12 * e1 - m12;
      a2[i + 2] += 1 - m22 + m22 * e2;
      mem_.delta[i + 1] = edge * state.s1 - l[1];
      mem_.delta[i + 2] = edge * state.s2 - l[2];
    } else {
      const double scale1 = 1 / Lane(row.w11), scale2 = 1 / Lane(row.w22);
      for (int j = 0; j < n; ++j) {
        a1[j] = scale1 * w1[j];
        a2[j] = scale2 * w2[j];
      }
      a1[i + 1] += scale1 * Soft(i + 1);
      a2[i + 2] += scale2 * Soft(i + 2);
      mem_.delta[i + 1] = -scale1 * mem_.u[i + 1];
      mem_.delta[i + 2] = -scale2 * mem_.u[i + 2];
    }
    if (!along_slip_) return;
    for (int j = 0; j < n; ++j) a2[j] = 0;  // no friction in this direction
    a2[i + 2] = 1;
    mem_.delta[i + 2] = -l[2];
  }

  void LinearizeCable(int k) noexcept {
    const StiffCable<W>& cable = work_.stiff[mem_.cables[k]];
    const int n = count_, i = 3 * contact_count_ + k;
    const double wish = CableWish(cable, i);
    double* const a = mem_.a + i * n;
    mem_.delta[i] = wish - mem_.lambda[i];
    if (wish > 0 && wish < Lane(cable.upper)) {
      const double scale = Lane(cable.inverse) * Lane(cable.gain);
      for (int j = 0; j < n; ++j) a[j] = scale * mem_.w[i * n + j];
      a[i] += Lane(cable.inverse) + scale * Soft(i);
    } else {
      a[i] = 1;
    }
  }

  /// Gaussian elimination with row pivots; false if the matrix is singular.
  bool Eliminate() noexcept {
    const int n = count_;
    double* const a = mem_.a;
    double* const x = mem_.delta;
    for (int k = 0; k < n; ++k) {
      int pivot = k;
      for (int i = k + 1; i < n; ++i) {
        if (AbsOf(a[i * n + k]) > AbsOf(a[pivot * n + k])) pivot = i;
      }
      if (!(AbsOf(a[pivot * n + k]) > 1e-14)) return false;
      if (pivot != k) {
        for (int j = k; j < n; ++j) {
          const double t = a[k * n + j];
          a[k * n + j] = a[pivot * n + j];
          a[pivot * n + j] = t;
        }
        const double t = x[k];
        x[k] = x[pivot];
        x[pivot] = t;
      }
      const double inverse = 1 / a[k * n + k];
      for (int i = k + 1; i < n; ++i) {
        const double factor = a[i * n + k] * inverse;
        if (factor == 0) continue;
        work_done_ += n - k;
        for (int j = k + 1; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
        x[i] -= factor * x[k];
      }
    }
    for (int k = n - 1; k >= 0; --k) {
      for (int j = k + 1; j < n; ++j) x[k] -= a[k * n + j] * x[j];
      x[k] /= a[k * n + k];
    }
    return true;
  }

  /// Impulses and velocities back into the lane.
  void Scatter() noexcept {
    for (int c = 0; c < contact_count_; ++c) {
      ContactRow<W>& row = work_.contacts[mem_.contacts[c]];
      double* const l = mem_.best + 3 * c;
      l[0] = MaxOf(l[0], 0);
      row.ln.Set(lane_, l[0]);
      row.l1.Set(lane_, l[1]);
      row.l2.Set(lane_, l[2]);
    }
    for (int k = 0; k < cable_count_; ++k) {
      work_.stiff[mem_.cables[k]].lambda.Set(lane_, mem_.best[3 * contact_count_ + k]);
    }
    for (int i = 0; i < count_; ++i) {
      const double d = mem_.best[i] - mem_.start[i];
      for (int k = 0; k < mem_.rows[i].link_count; ++k) {
        const NewtonLink& link = mem_.links[mem_.rows[i].first_link + k];
        BodyWork<W>& body = work_.bodies[link.body];
        Add(body.v, link.im * d, link.lin);
        Add(body.w, d, link.g);
      }
    }
  }
  void Add(V3<W>& v, double d, const double* direction) noexcept {
    v.x.Set(lane_, v.x[lane_] + d * direction[0]);
    v.y.Set(lane_, v.y[lane_] + d * direction[1]);
    v.z.Set(lane_, v.z[lane_] + d * direction[2]);
  }

  Scratch<W>& work_;
  NewtonMemory& mem_;
  int lane_;
  bool along_slip_;
  double compliance_ = 0;
  double work_done_ = 0;
  int count_ = 0, contact_count_ = 0, cable_count_ = 0, link_count_ = 0;
};

}  // namespace taut::sim
