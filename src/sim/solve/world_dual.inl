/// A world whose bodies hang together by stiff cables, and touch only what does not move: Newton's
/// method in all impulses, in all lanes at once (docs/theory/contact.md, eq. 20).
///
/// Rows are those that some lane has; one that a lane has not stands in its system as 1 x = 0.
/// What a lane gets does not depend on the others: its rows have the same order alone.

namespace taut::sim {

template <class W>
class WorldDual {
  static constexpr int kMaxIterations = 10;
  static constexpr double kCompliance = 1e-9;
  using M = MaskOf<W>;

 public:
  WorldDual(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept
      : m_(m), s_(s), work_(work), mem_(work.dual) {}

  /// Solves `lanes`; returns those in which it did not get there, which stay as they were.
  M Solve(Target target, M lanes, W& residual, W& solves) noexcept {
    const W zero = W::Splat(0.0), one = W::Splat(1.0);
    const W tolerance = W::Splat(target.tolerance), goal = W::Splat(target.goal()),
            pays = W::Splat(Target::kPays);
    Start();
    W now = Residual();
    // At least one step: what cables leave over swings on and adds up.
    M busy = lanes;
    BuildMatrix();
    for (int iteration = 0; iteration < kMaxIterations && Any(busy); ++iteration) {
      SolveLinear(busy);
      for (int i = 0; i < rows_; ++i) {
        mem_.r[i] = Select(busy, mem_.r[i], zero);
        mem_.l[i] += mem_.r[i];
      }
      for (int i = 0; i < rows_; ++i) {
        W change = zero;
        for (int j = 0; j < rows_; ++j) change += mem_.w[i * rows_ + j] * mem_.r[j];
        mem_.u[i] += change;
      }
      solves += Select(busy, one, zero);
      const W before = now;
      now = Select(busy, Residual(), now);
      const auto done = (now < goal) | ((now < tolerance) & (now > pays * before));
      busy = busy & !done;  // a NaN stays busy
    }
    const M solved = lanes & (now < tolerance);
    residual = Max(Select(solved, now, zero), residual);
    Finish(solved);
    return lanes & !solved;
  }

 private:
  /// Calls f(law, first row) for all contacts with the world and all stiff cables.
  template <class F>
  void ForEach(F&& f) noexcept {
    int row = 0;
    for (int b = 0; b < m_.body_count; ++b) {
      for (int k = 0; k < work_.contact_count[b]; ++k, row += 3) {
        f(work_.contacts[m_.first_slot[b] + k], row);
      }
    }
    for (int i = 0; i < work_.stiff_count; ++i) f(work_.stiff[i], row++);
    rows_ = row;
  }

  /// Impulses, and velocities with them.
  void Start() noexcept {
    const W zero = W::Splat(0.0);
    ForEach([&](auto& law, int row) {
      for (int r = 0; r < LawOf<decltype(law)>::kRows; ++r) mem_.l[row + r] = law.l[r];
    });
    for (int b = 0; b < m_.body_count; ++b) {
      mem_.v[b] = {work_.bodies[b].v, work_.bodies[b].w};
    }
    Apply(mem_.l);
    for (int i = 0; i < rows_; ++i) mem_.u[i] = zero;
    ForEach([&](auto& law, int row) {
      for (int i = 0; i < law.link_count; ++i) {
        const Twist<W>& t = mem_.v[law.links[i].body];
        AddVelocity(law.links[i], t.v, t.w, mem_.u + row);
      }
    });
  }
  void Apply(const W* l) noexcept {
    ForEach([&](auto& law, int row) {
      for (int i = 0; i < law.link_count; ++i) {
        Twist<W>& t = mem_.v[law.links[i].body];
        Push(law.links[i], l + row, t.v, t.w);
      }
    });
  }

  W Residual() noexcept {
    W worst = W::Splat(0.0);
    ForEach([&](auto& law, int row) {
      const auto branch = law.BranchOf(mem_.u + row, mem_.l + row);
      worst = Max(law.Residual(branch, mem_.u + row, mem_.l + row), worst);
    });
    return worst;
  }

  /// W = J M^-1 J^T: links that share a body, body by body.
  void BuildMatrix() noexcept {
    for (int i = 0; i < rows_ * rows_; ++i) mem_.w[i] = W::Splat(0.0);
    for (int b = 0; b < m_.body_count; ++b) {
      int count = 0;  // columns that act on the body
      ForEach([&](auto& law, int row) {
        for (int i = 0; i < law.link_count; ++i) {
          if (law.links[i].body != b) continue;
          for (int r = 0; r < LawOf<decltype(law)>::kRows; ++r) {
            mem_.columns[count++] = {row + r, &law.links[i].lin[r], &law.links[i].ang[r],
                                     &law.links[i].turn[r]};
          }
        }
      });
      if (count == 0) continue;
      const W inv_mass = s_.inv_mass[b];
      for (int i = 0; i < count; ++i) {
        const auto& x = mem_.columns[i];
        for (int j = 0; j <= i; ++j) {
          const auto& y = mem_.columns[j];
          mem_.w[x.row * rows_ + y.row] +=
              inv_mass * Dot(*x.lin, *y.lin) + Dot(*x.ang, *y.turn);
        }
      }
    }
    for (int i = 0; i < rows_; ++i) {
      for (int j = 0; j < i; ++j) mem_.w[j * rows_ + i] = mem_.w[i * rows_ + j];
    }
  }

  /// Newton's step: (A + S W) dl = r.
  void SolveLinear(M lanes) noexcept {
    M slides = M::Splat(false);
    ForEach([&](auto& law, int row) {
      constexpr int R = LawOf<decltype(law)>::kRows;
      const auto branch = law.BranchOf(mem_.u + row, mem_.l + row);
      LinearLaw<W, R> linear;
      law.Linearize(branch, mem_.u + row, mem_.l + row, W::Splat(kCompliance), linear);
      if constexpr (R == 3) slides = slides | branch.slides;
      for (int r = 0; r < R; ++r) {
        W* const a = mem_.a + (row + r) * rows_;
        for (int j = 0; j < rows_; ++j) {
          W sum = linear.S[r][0] * mem_.w[row * rows_ + j];
          for (int k = 1; k < R; ++k) sum += linear.S[r][k] * mem_.w[(row + k) * rows_ + j];
          a[j] = sum;
        }
        for (int k = 0; k < R; ++k) a[row + k] += linear.A[r][k];
        mem_.r[row + r] = linear.r[r];
      }
    });
    static_cast<void>(lanes);
    Eliminate();
  }

  /// Gaussian elimination without pivots; a lane that this spoils does not get there.
  void Eliminate() noexcept {
    const int n = rows_;
    W* const a = mem_.a;
    W* const x = mem_.r;
    for (int k = 0; k < n; ++k) {
      const W inverse = W::Splat(1.0) / a[k * n + k];
      for (int i = k + 1; i < n; ++i) {
        const W factor = a[i * n + k] * inverse;
        for (int j = k + 1; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
        x[i] -= factor * x[k];
      }
      a[k * n + k] = inverse;
    }
    for (int k = n - 1; k >= 0; --k) {
      for (int j = k + 1; j < n; ++j) x[k] -= a[k * n + j] * x[j];
      x[k] = x[k] * a[k * n + k];
    }
  }

  /// What was found, made admissible, into the laws and the bodies of `solved`.
  void Finish(M solved) noexcept {
    if (!Any(solved)) return;
    for (int b = 0; b < m_.body_count; ++b) mem_.v[b] = {work_.bodies[b].v, work_.bodies[b].w};
    ForEach([&](auto& law, int row) {
      law.Clamp(mem_.l + row);
      for (int r = 0; r < LawOf<decltype(law)>::kRows; ++r) {
        law.l[r] = Select(solved, mem_.l[row + r], law.l[r]);
      }
    });
    Apply(mem_.l);
    for (int b = 0; b < m_.body_count; ++b) {
      BodyWork<W>& body = work_.bodies[b];
      body.v = Select3(solved, mem_.v[b].v, body.v);
      body.w = Select3(solved, mem_.v[b].w, body.w);
    }
  }

  const View& m_;
  const Rows<W>& s_;
  Scratch<W>& work_;
  DualMemory<W>& mem_;
  int rows_ = 0;
};

}  // namespace taut::sim
