/// Newton's method in the impulses of a body with up to four contacts with the world, in all lanes
/// at once, on its Delassus operator (docs/theory/contact.md, eq. 20). These contacts are an
/// island, for example of a spine segment on its feet.
#pragma once

#include "math/scalar.h"
#include "sim/constraint/contact_point.h"
#include "sim/constraint/links.h"
#include "sim/data/contacts.h"
#include "sim/data/elimination.h"
#include "sim/data/island.h"
#include "sim/data/rows.h"
#include "sim/solve/impacts.inl"
#include "simd/vec3.h"

namespace taut::sim {

inline constexpr int kMaxDualContacts = 4;

template <class W, int kContacts>
class BodyDual {
  static constexpr int kSize = 3 * kContacts;
  static constexpr int kMaxIterations = 8;
  /// Redundant friction (two contacts along one rod) makes the system singular. This compliance
  /// selects the smallest change. The compliance does not affect the converged result.
  static constexpr double kCompliance = 1e-9;
  using Law = ContactPoint<W, 1>;

 public:
  BodyDual(BodyWork<W>& body, Contact<W, 1>* rows) noexcept : body_(body), rows_(rows) {}

  /// Solves the contacts in `lanes` and stores their impulses and velocities. Returns the lanes
  /// that did not converge, which stay unchanged.
  template <class M>
  M Solve(Target target, M lanes, W& residual, W& solves) noexcept {
    const W zero = W::Splat(0.0);
    BuildMatrix();
    for (int i = 0; i < kSize; ++i) l_[i] = rows_[i / 3].l[i % 3];
    Measure(body_.v, body_.w, u_);
    AddChange(l_);
    target_ = target;
    now_ = Residual();
    solves_ = W::Splat(0.0);
    const bool impacts = ExpectImpacts(*this);
    Iterate(lanes);
    if (impacts) SolveImpacts<W>(*this, kSize, lanes & Solved());
    const auto solved = lanes & Solved();
    residual = Max(Select(solved, now_, zero), residual);
    solves += solves_;
    for (int c = 0; c < kContacts; ++c) {
      Contact<W, 1>& row = rows_[c];
      W l[3] = {l_[3 * c], l_[3 * c + 1], l_[3 * c + 2]};
      l[0] = Max(l[0], zero);  // a contact that Newton's method leaves slightly below zero is open
      for (int k = 0; k < 3; ++k) {
        row.l[k] = Select(solved, l[k], row.l[k]);
        l[k] = Select(solved, l[k], zero);
      }
      Push(row.links[0], l, body_.v, body_.w);
      if (impacts) row.ForgetRebound(lanes & !solved);
    }
    return lanes & !solved;
  }

  // Interface for impacts.inl.
  template <class F>
  TAUT_INLINE void ForEach(F&& f) noexcept {
    for (int c = 0; c < kContacts; ++c) f(rows_[c], 3 * c);
  }
  W* u() noexcept { return u_; }
  W* l() noexcept { return l_; }
  ImpactRows<W> impacts() noexcept { return {before_, kept_u_, kept_l_}; }
  void MeasureBefore() noexcept { Measure(body_.v0, body_.w0, before_); }
  template <class M>
  void SolveAgain(M lanes) noexcept {
    now_ = Select(lanes, Residual(), now_);
    Iterate(lanes);
  }
  void Update() noexcept {}

 private:
  auto Solved() const noexcept { return now_ < W::Splat(target_.tolerance); }

  template <class M>
  void Iterate(M lanes) noexcept {
    const W zero = W::Splat(0.0), one = W::Splat(1.0);
    const W tolerance = W::Splat(target_.tolerance), goal = W::Splat(target_.goal()),
            pays = W::Splat(Target::kPays);
    auto busy = lanes & !(now_ < goal);
    for (int iteration = 0; iteration < kMaxIterations && Any(busy); ++iteration) {
      Linearize();
      Eliminate();
      for (int i = 0; i < kSize; ++i) delta_[i] = Select(busy, delta_[i], zero);
      for (int i = 0; i < kSize; ++i) l_[i] += delta_[i];
      AddChange(delta_);
      solves_ += Select(busy, one, zero);
      const W before = now_;
      now_ = Select(busy, Residual(), now_);
      const auto done = (now_ < goal) | ((now_ < tolerance) & (now_ > pays * before));
      busy = busy & !done;  // lanes with a NaN residual remain
    }
  }

  void Measure(const V3<W>& v, const V3<W>& w, W* u) const noexcept {
    for (int i = 0; i < kSize; ++i) u[i] = W::Splat(0.0);
    for (int c = 0; c < kContacts; ++c) AddVelocity(rows_[c].links[0], v, w, u + 3 * c);
  }

  /// Updates velocities: u += W dl.
  void AddChange(const W* dl) noexcept {
    for (int i = 0; i < kSize; ++i) {
      W change = w_[i][0] * dl[0];
      for (int j = 1; j < kSize; ++j) change += w_[i][j] * dl[j];
      u_[i] += change;
    }
  }

  /// Updates the branches and returns the residual.
  W Residual() noexcept {
    W worst = W::Splat(0.0);
    for (int c = 0; c < kContacts; ++c) {
      branches_[c] = rows_[c].BranchOf(u_ + 3 * c, l_ + 3 * c);
      worst = Max(rows_[c].Residual(branches_[c], u_ + 3 * c, l_ + 3 * c), worst);
    }
    return worst;
  }

  /// Assembles the Delassus operator W = J M^-1 J^T. Contacts with the same plane have common
  /// directions, whose products are 0 and 1.
  void BuildMatrix() noexcept {
    for (int i = 0; i < kContacts; ++i) {
      const Law& a = rows_[i];
      const W own[9] = {a.wnn, a.w1n, a.w2n, a.w1n, a.w11, a.w12, a.w2n, a.w12, a.w22};
      SetBlock(i, i, own);
      for (int j = i + 1; j < kContacts; ++j) {
        W block[9];
        Couple(rows_[i], rows_[j], block);
        SetBlock(i, j, block);
        const W transposed[9] = {block[0], block[3], block[6], block[1], block[4],
                                 block[7], block[2], block[5], block[8]};
        SetBlock(j, i, transposed);
      }
    }
  }
  static void Couple(const Contact<W, 1>& x, const Contact<W, 1>& y, W* block) noexcept {
    const W zero = W::Splat(0.0), one = W::Splat(1.0);
    const Link<W, 3>&a = x.links[0], &b = y.links[0];
    const auto same = x.frame == y.frame;
    const bool all_same = !Any(!same);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        W sum = Dot(a.ang[r], b.turn[c]);
        const W known = r == c ? one : zero;
        if (all_same) {
          if (r == c) sum += a.inv_mass;
        } else {
          sum += a.inv_mass * Select(same, known, Dot(a.lin[r], b.lin[c]));
        }
        block[3 * r + c] = sum;
      }
    }
  }
  void SetBlock(int i, int j, const W* block) noexcept {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) w_[3 * i + r][3 * j + c] = block[3 * r + c];
    }
  }

  /// Assembles Newton's linear system: (A + S W) dl = r.
  void Linearize() noexcept {
    for (int c = 0; c < kContacts; ++c) {
      const int n = 3 * c, t1 = n + 1, t2 = n + 2;
      LinearLaw<W, 3> law;
      rows_[c].Linearize(branches_[c], u_ + n, l_ + n, W::Splat(kCompliance), law);
      for (int j = 0; j < kSize; ++j) {
        a_[n][j] = law.S[0][0] * w_[n][j];
        a_[t1][j] = law.S[1][1] * w_[t1][j] + law.S[1][2] * w_[t2][j];
        a_[t2][j] = law.S[2][1] * w_[t1][j] + law.S[2][2] * w_[t2][j];
      }
      a_[n][n] += law.A[0][0];
      a_[t1][n] += law.A[1][0];
      a_[t2][n] += law.A[2][0];
      for (int r = 1; r < 3; ++r) {
        for (int k = 1; k < 3; ++k) a_[n + r][n + k] += law.A[r][k];
      }
      for (int r = 0; r < 3; ++r) delta_[n + r] = law.r[r];
    }
  }

  /// Gaussian elimination without pivots, which the dominant diagonal makes unnecessary. Lanes
  /// where it fails do not converge.
  void Eliminate() noexcept {
    TAUT_UNROLL for (int k = 0; k < kSize; ++k) {
      const W inverse = W::Splat(1.0) / a_[k][k];
      TAUT_UNROLL for (int i = k + 1; i < kSize; ++i) {
        const W factor = a_[i][k] * inverse;
        TAUT_UNROLL for (int j = k + 1; j < kSize; ++j) a_[i][j] -= factor * a_[k][j];
        delta_[i] -= factor * delta_[k];
      }
      a_[k][k] = inverse;
    }
    TAUT_UNROLL for (int k = kSize - 1; k >= 0; --k) {
      TAUT_UNROLL for (int j = k + 1; j < kSize; ++j) delta_[k] -= a_[k][j] * delta_[j];
      delta_[k] = delta_[k] * a_[k][k];
    }
  }

  BodyWork<W>& body_;
  Contact<W, 1>* rows_;
  typename Law::Branch branches_[kContacts];
  W u_[kSize], l_[kSize], delta_[kSize];
  W w_[kSize][kSize], a_[kSize][kSize];
  W before_[kSize], kept_u_[kSize], kept_l_[kSize];
  W now_, solves_;
  Target target_;
};

template <class W, class M>
M SolveBody(BodyWork<W>& body, Contact<W, 1>* rows, int count, Target target, M lanes, W& residual,
            W& solves) noexcept {
  switch (count) {
    case 1:
      return BodyDual<W, 1>(body, rows).Solve(target, lanes, residual, solves);
    case 2:
      return BodyDual<W, 2>(body, rows).Solve(target, lanes, residual, solves);
    case 3:
      return BodyDual<W, 3>(body, rows).Solve(target, lanes, residual, solves);
    default:
      return BodyDual<W, 4>(body, rows).Solve(target, lanes, residual, solves);
  }
}

}  // namespace taut::sim
