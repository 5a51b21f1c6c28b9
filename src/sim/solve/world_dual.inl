/// Solver for a world of bodies connected by stiff cables that touch only static geometry: Newton's
/// method in all impulses on the Delassus operator, in all lanes at once (docs/theory/contact.md,
/// section 5).
///
/// Cables are eliminated first by a symmetric factorization. The factorization stays valid while
/// the set of taut cables is the same and no cable becomes slack or taut in the step. The remaining
/// system contains only the contacts; it is as small as for one body and has its own Newton
/// iterations. The rows are the union of the rows of all lanes; in lanes without a row, its
/// equation is 1 x = 0. The result of a lane does not depend on other lanes, because the order of
/// its rows is always the same.
#pragma once

#include "sim/data/rows.h"
#include "sim/solve/impacts.inl"

namespace taut::sim {

/// `Contacts`: contacts with the world (packed_contacts.inl).
template <class W, class Contacts>
class WorldDual {
  static constexpr int kMaxIterations = 10, kMaxContactIterations = 8;
  /// Newton's method for contacts in many directions may cycle, and all lanes would wait. Worlds
  /// with this number of cycles are left to the lane-by-lane solver.
  static constexpr int kMaxCircles = Contacts::kPacked ? 3 : kMaxIterations;
  static constexpr double kCompliance = 1e-9;
  using M = MaskOf<W>;
  using Column = typename DualMemory<W>::Column;

 public:
  WorldDual(const View& m, const Rows<W>& s, Scratch<W>& work, Contacts contacts) noexcept
      : m_(m), s_(s), work_(work), contacts_(contacts), mem_(work.dual) {}

  /// Solves `lanes`. Returns the lanes that did not converge, which stay unchanged.
  M Solve(Target target, M lanes, W& residual, W& solves) noexcept {
    target_ = target;
    solves_ = now_ = W::Splat(0.0);
    Start();
    SortColumns();
    const bool impacts = ExpectImpacts(*this);
    Iterate(lanes, true);
    if (impacts) SolveImpacts<W>(*this, rows_, lanes & Solved());
    const M solved = lanes & Solved();
    residual = Max(Select(solved, now_, W::Splat(0.0)), residual);
    solves += solves_;
    if (impacts) ForEachContact([&](auto& law, int) { law.ForgetRebound(lanes & !solved); });
    Finish(solved);
    return lanes & !solved;
  }

  // Interface for impacts.inl.
  template <class F>
  TAUT_INLINE void ForEach(F&& f) noexcept {
    ForEachCable(f);
    ForEachContact(f);
  }
  W* u() noexcept { return mem_.u; }
  W* l() noexcept { return mem_.l; }
  ImpactRows<W> impacts() noexcept { return mem_.impacts; }
  void MeasureBefore() noexcept {
    ForEachContact([&](auto& law, int row) {
      for (int r = 0; r < 3; ++r) mem_.impacts.before[row + r] = W::Splat(0.0);
      for (int i = 0; i < law.link_count; ++i) {
        const BodyWork<W>& body = work_.bodies[law.links[i].body];
        AddVelocity(law.links[i], body.v0, body.w0, mem_.impacts.before + row);
      }
    });
  }
  void SolveAgain(M lanes) noexcept { Iterate(lanes, false); }
  void Update() noexcept { Velocities(); }

 private:
  M Solved() const noexcept { return now_ < W::Splat(target_.tolerance); }

  void Iterate(M lanes, bool first) noexcept {
    const W one = W::Splat(1.0);
    const W tolerance = W::Splat(target_.tolerance), goal = W::Splat(target_.goal()),
            pays = W::Splat(Target::kPays);
    now_ = Select(lanes, Residual(), now_);
    // Takes at least one Newton step: residuals of cables would otherwise persist as oscillations
    // and accumulate.
    M busy = lanes;
    [[maybe_unused]] W circles = W::Splat(0.0);
    for (int iteration = 0; iteration < kMaxIterations && Any(busy); ++iteration) {
      if (LinearizeCables(first && iteration == 0)) Factor();
      Forward();
      [[maybe_unused]] const M circling = SolveContacts(busy, goal);
      Back();
      Take(busy);
      Velocities();
      Measure();
      solves_ += Select(busy, one, W::Splat(0.0));
      const W before = now_;
      now_ = Select(busy, Residual(), now_);
      const auto done = (now_ < goal) | ((now_ < tolerance) & (now_ > pays * before));
      busy = busy & !done;  // lanes with a NaN residual remain
      if constexpr (Contacts::kPacked) {
        circles += Select(circling, one, W::Splat(0.0));
        busy = busy & (circles < W::Splat(kMaxCircles));
      }
    }
  }

  /// Calls f(law, first row) for all stiff cables.
  template <class F>
  TAUT_INLINE void ForEachCable(F&& f) noexcept {
    for (int i = 0; i < work_.stiff_count; ++i) f(work_.stiff[i], i);
  }
  /// Calls f(law, first row) for all contacts with the world.
  template <class F>
  TAUT_INLINE void ForEachContact(F&& f) noexcept {
    int row = work_.stiff_count;
    contacts_.ForEach([&](auto& law) {
      f(law, row);
      row += 3;
    });
    rows_ = row;
    TAUT_ASSERT(rows_ <= mem_.capacity);
  }

  /// Loads the impulses and computes the velocities.
  void Start() noexcept {
    cables_ = work_.stiff_count;
    ForEach([&](auto& law, int row) {
      for (int r = 0; r < LawOf<decltype(law)>::kRows; ++r) mem_.l[row + r] = law.l[r];
    });
    Velocities();
    Measure();
  }
  /// Computes velocities: v <- v_free + M^-1 J^T l.
  void Velocities() noexcept {
    for (int b = 0; b < m_.body_count; ++b) mem_.v[b] = {work_.bodies[b].v, work_.bodies[b].w};
    ForEach([&](auto& law, int row) {
      for (int i = 0; i < law.link_count; ++i) {
        Twist<W>& t = mem_.v[law.links[i].body];
        Push(law.links[i], mem_.l + row, t.v, t.w);
      }
    });
  }
  /// Computes constraint velocities: u <- J v.
  void Measure() noexcept {
    ForEach([&](auto& law, int row) {
      constexpr int R = LawOf<decltype(law)>::kRows;
      for (int r = 0; r < R; ++r) mem_.u[row + r] = W::Splat(0.0);
      for (int i = 0; i < law.link_count; ++i) {
        const Twist<W>& t = mem_.v[law.links[i].body];
        AddVelocity(law.links[i], t.v, t.w, mem_.u + row);
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

  /// Returns row i of the upper triangle: Row(i)[j], j >= i.
  TAUT_INLINE W* Row(int i) const noexcept { return mem_.a + i * (2 * rows_ - i - 1) / 2; }

  /// Sets `a` to the upper triangle of the Delassus operator W = J M^-1 J^T, assembled body by body
  /// from the rows on the same body.
  void BuildMatrix() noexcept {
    const int n = rows_;
    for (int i = 0; i < n; ++i) {
      W* const row = Row(i);
      for (int j = i; j < n; ++j) row[j] = W::Splat(0.0);
    }
    for (int b = 0; b < m_.body_count; ++b) {
      const Column* const columns = mem_.columns + mem_.first_column[b];
      const int count = mem_.first_column[b + 1] - mem_.first_column[b];
      const W inv_mass = s_.inv_mass[b];
      for (int i = 0; i < count; ++i) {
        const auto& x = columns[i];
        const V3<W> lin = inv_mass * *x.lin, turn = *x.turn;
        W* const row = Row(x.row);
        for (int j = i; j < count; ++j) {
          const auto& y = columns[j];
          row[y.row] += Dot(lin, *y.lin) + Dot(turn, *y.ang);
        }
      }
    }
  }

  /// Lists the rows that act on each body.
  void SortColumns() noexcept {
    const sim::Row<int> next =
        mem_.first_column;  // entries are shifted by one until they are complete
    for (int b = 0; b <= m_.body_count; ++b) next[b] = 0;
    ForEach([&](auto& law, int) {
      for (int i = 0; i < law.link_count; ++i) {
        next[law.links[i].body + 1] += LawOf<decltype(law)>::kRows;
      }
    });
    for (int b = 0; b < m_.body_count; ++b) next[b + 1] += next[b];
    ForEach([&](auto& law, int row) {
      for (int i = 0; i < law.link_count; ++i) {
        const auto& link = law.links[i];
        for (int r = 0; r < LawOf<decltype(law)>::kRows; ++r) {
          mem_.columns[next[link.body]++] = {row + r, &link.lin[r], &link.ang[r], &link.turn[r]};
        }
      }
    });
    for (int b = m_.body_count; b > 0; --b) next[b] = next[b - 1];
    next[0] = 0;
  }

  /// Computes Newton's equations of the cables. Returns true if a coefficient has changed: another
  /// cable is taut, or a cable that becomes slack or taut in this step has another stiffness.
  bool LinearizeCables(bool first) noexcept {
    bool changed = first;
    ForEachCable([&](auto& law, int row) {
      const auto branch = law.BranchOf(mem_.u + row, mem_.l + row);
      LinearLaw<W, 1> linear;
      law.Linearize(branch, mem_.u + row, mem_.l + row, W::Splat(0.0), linear);
      mem_.r[row] = linear.r[0];
      changed = changed || Any(!(linear.S[0][0] == mem_.active[row]) |
                               !(linear.A[0][0] == mem_.diagonal[row]));
      mem_.diagonal[row] = linear.A[0][0];
      mem_.active[row] = linear.S[0][0];
    });
    return changed;
  }

  /// a: eliminated rows of the cables (D L^T, with the inverse of D on the diagonal), followed by
  /// the remaining matrix W' for the contacts.
  void Factor() noexcept {
    BuildMatrix();
    const W one = W::Splat(1.0), zero = W::Splat(0.0);
    auto idle = M::Splat(false);
    for (int i = 0; i < cables_; ++i) idle = idle | (mem_.active[i] == zero);
    const bool some_idle = Any(idle);
    for (int i = 0; i < cables_; ++i) {
      W* const a = Row(i);
      const W in = mem_.active[i];
      a[i] = Select(in > zero, a[i] + mem_.diagonal[i], one);
      if (!some_idle) continue;
      for (int j = i + 1; j < cables_; ++j) a[j] = in * mem_.active[j] * a[j];
      for (int j = cables_; j < rows_; ++j) a[j] = in * a[j];
    }
    constexpr int kPivots = 4;
    int k = 0;
    for (; k + kPivots <= cables_; k += kPivots) EliminatePivots<kPivots>(k);
    for (; k < cables_; ++k) EliminatePivots<1>(k);
  }

  /// Eliminates the pivots k to k + P - 1: first among themselves, then from all rows below at
  /// once. Each entry receives one pivot after the other.
  template <int P>
  void EliminatePivots(int k) noexcept {
    const int n = rows_;
    const W* x[P];
    W inverse[P], f[P];
    for (int p = 0; p < P; ++p) {
      W* const row = Row(k + p);
      for (int q = 0; q < p; ++q) {
        f[0] = -(x[q][k + p] * inverse[q]);
        AddMultiple(row + k + p, x[q] + k + p, f[0], n - k - p);
      }
      x[p] = row;
      inverse[p] = W::Splat(1.0) / row[k + p];
    }
    for (int i = k + P; i < n; ++i) {
      W* const row = Row(i);
      for (int p = 0; p < P; ++p) f[p] = -(x[p][i] * inverse[p]);
      TAUT_NO_OVERLAP for (int j = i; j < n; ++j) {
        W sum = row[j];
        for (int p = 0; p < P; ++p) sum += f[p] * x[p][j];
        row[j] = sum;
      }
    }
    for (int p = 0; p < P; ++p) Row(k + p)[k + p] = inverse[p];
  }

  /// Computes y += f x. x and y must not overlap.
  TAUT_INLINE static void AddMultiple(W* y, const W* x, W f, int count) noexcept {
    TAUT_NO_OVERLAP for (int i = 0; i < count; ++i) y[i] += f * x[i];
  }

  /// Forward substitution of the right sides through the cables. Adds their effect on the contact
  /// velocities to q.
  void Forward() noexcept {
    const W zero = W::Splat(0.0);
    for (int i = cables_; i < rows_; ++i) mem_.q[i] = zero;
    PassOnKnown();
    for (int k = 0; k < cables_; ++k) {
      const W* const a = Row(k);
      const W f = a[k] * mem_.r[k];
      AddMultiple(mem_.r + k + 1, a + k + 1, -f, cables_ - k - 1);
      AddMultiple(mem_.q + cables_, a + cables_, f, rows_ - cables_);
    }
  }
  /// Applies the known changes dl = r of cables that are not taut to all other rows, through the
  /// bodies.
  void PassOnKnown() noexcept {
    const W zero = W::Splat(0.0);
    bool any = false;
    ForEachCable([&](auto&, int row) {
      any = any || Any(!(Select(mem_.active[row] > zero, zero, mem_.r[row]) == zero));
    });
    if (!any) return;
    const V3<W> none{zero, zero, zero};
    for (int b = 0; b < m_.body_count; ++b) mem_.v[b] = {none, none};
    ForEachCable([&](auto& law, int row) {
      const W known = Select(mem_.active[row] > zero, zero, mem_.r[row]);
      for (int i = 0; i < law.link_count; ++i) {
        Twist<W>& t = mem_.v[law.links[i].body];
        Push(law.links[i], &known, t.v, t.w);
      }
    });
    ForEachCable([&](auto& law, int row) {
      W u = zero;
      for (int i = 0; i < law.link_count; ++i) {
        const Twist<W>& t = mem_.v[law.links[i].body];
        AddVelocity(law.links[i], t.v, t.w, &u);
      }
      mem_.r[row] -= mem_.active[row] * u;
    });
    ForEachContact([&](auto& law, int row) {
      for (int i = 0; i < law.link_count; ++i) {
        const Twist<W>& t = mem_.v[law.links[i].body];
        AddVelocity(law.links[i], t.v, t.w, mem_.q + row);
      }
    });
  }

  M SolveContacts(M lanes, W goal) noexcept;
  void LinearizeContacts(int size) noexcept;
  void EliminateContacts(int size) noexcept;
  /// Returns an element of W'; a contains the upper triangle.
  TAUT_INLINE W Left(int i, int j) const noexcept { return i < j ? Row(i)[j] : Row(j)[i]; }

  /// Back substitution: computes the changes of the cables from the changes of the contacts.
  void Back() noexcept {
    for (int k = cables_ - 1; k >= 0; --k) {
      const W* const a = Row(k);
      W sum = mem_.r[k];
      for (int j = k + 1; j < rows_; ++j) sum -= a[j] * mem_.r[j];
      mem_.r[k] = a[k] * sum;
    }
  }

  /// Adds the step to the impulses and makes them admissible.
  void Take(M lanes) noexcept {
    ForEach([&](auto& law, int row) {
      constexpr int R = LawOf<decltype(law)>::kRows;
      W l[R];
      for (int r = 0; r < R; ++r) l[r] = mem_.l[row + r] + mem_.r[row + r];
      law.Clamp(l);
      for (int r = 0; r < R; ++r) mem_.l[row + r] = Select(lanes, l[r], mem_.l[row + r]);
    });
  }

  /// Copies the results to the laws and bodies in the lanes `solved`.
  void Finish(M solved) noexcept {
    if (!Any(solved)) return;
    ForEach([&](auto& law, int row) {
      for (int r = 0; r < LawOf<decltype(law)>::kRows; ++r) {
        law.l[r] = Select(solved, mem_.l[row + r], law.l[r]);
      }
    });
    contacts_.Finish(solved);
    for (int b = 0; b < m_.body_count; ++b) {
      BodyWork<W>& body = work_.bodies[b];
      body.v = Select3(solved, mem_.v[b].v, body.v);
      body.w = Select3(solved, mem_.v[b].w, body.w);
    }
  }

  const View& m_;
  const Rows<W>& s_;
  Scratch<W>& work_;
  Contacts contacts_;
  DualMemory<W>& mem_;
  int rows_ = 0, cables_ = 0;
  W now_, solves_;
  Target target_;
};

}  // namespace taut::sim

#include "sim/solve/world_dual_contacts.inl"
