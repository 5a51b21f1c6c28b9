/// Derivatives of an island's solution with respect to its inputs: Newton's linear system at the
/// solution, and its transpose for gradients (docs/theory/contact.md, eq. 29-31). Not used in
/// steps.
#pragma once

#include "sim/constraint/links.h"
#include "sim/data/island.h"
#include "sim/solve/body_matrix.inl"
#include "sim/solve/plain_newton.inl"

namespace taut::sim {

/// Tangent of an island after its solve. Uses the memory of the solver stages; velocities and
/// impulses do not change.
///
/// Inputs and results:
///   p   6 per unknown: added momentum, M times the change of its free velocity [N s; N m s];
///       prescribed unknowns: change of the velocity [m/s; rad/s]
///   b   one per row: added to the velocity in the row's law, like a bias [m/s]
///   dv, dl   changes of velocities and impulses; dv = p for prescribed unknowns
/// The laws keep their branches. At the boundary of two branches (a contact that just touches or
/// just slips), the result is a one-sided derivative. It is invalid if impulses were interpolated
/// to limit the energy (impacts.inl), because these satisfy no law.
template <class Num, class P>
class IslandTangent {
 public:
  explicit IslandTangent(Island<Num, P>& island) noexcept
      : island_(island), m_(island.m), matrix_(island.pattern, island.m.blocks) {}

  /// Factors the matrix. Returns false if it is singular or does not fit into memory. The error of
  /// the derivatives is of the order of `compliance`, which determines how indeterminate loads are
  /// distributed.
  bool Factor(double compliance = 1e-7) noexcept {
    if (!island_.has_matrix) return false;
    bool symmetric = true;
    island_.pools.ForEach([&](auto& law, auto& branch, int row, int cell) {
      branch = law.BranchOf(m_.u + row, m_.l + row);
      const bool even = Any(StepOf(law, branch, m_.u + row, m_.l + row, Num::Splat(compliance),
                                   m_.g + cell, m_.f + row));
      symmetric = symmetric && even;
    });
    matrix_.Start(island_.bodies, symmetric);
    island_.pools.ForEach([&](auto& law, auto&, int, int cell) { matrix_.Add(law, m_.g + cell); });
    return matrix_.Factor();
  }

  /// Returns the factored M + J^T G J of the unknowns that are not prescribed.
  const BodyMatrix<Num>& matrix() const noexcept { return matrix_; }

  /// Computes dv and dl, the effect of p and b (eq. 29). dv may be p.
  void Apply(const Num* p, const Num* b, Num* dv, Num* dl) noexcept {
    const Num zero = Num::Splat(0.0);
    for (int i = 0; i < size(); ++i) m_.trial_v[i] = i < solved() ? zero : p[i];
    island_.Measure(m_.trial_v, m_.du);
    for (int i = 0; i < island_.rows; ++i) m_.du[i] += b[i];
    TimesMinusG(m_.du, dl, false);
    for (int i = 0; i < size(); ++i) dv[i] = p[i];
    island_.pools.ForEach([&](auto& law, auto&, int row, int) {  //
      island_.AddForce(law, dl + row, dv);
    });
    matrix_.Solve(dv);
    island_.Measure(dv, m_.du);
    for (int i = 0; i < island_.rows; ++i) m_.du[i] += b[i];
    TimesMinusG(m_.du, dl, false);
  }

  /// Adjoint (eq. 31). From the derivatives `by_v`, `by_l` of a number with respect to velocities
  /// and impulses, computes its derivatives with respect to p and b. by_p may be by_v.
  void ApplyTransposed(const Num* by_v, const Num* by_l, Num* by_p, Num* by_b) noexcept {
    const Num zero = Num::Splat(0.0);
    TimesMinusG(by_l, by_b, true);
    for (int i = 0; i < size(); ++i) by_p[i] = by_v[i];
    island_.pools.ForEach([&](auto& law, auto&, int row, int) {  //
      island_.AddForce(law, by_b + row, by_p);
    });
    matrix_.SolveTransposed(by_p);
    for (int i = 0; i < size(); ++i) m_.trial_v[i] = i < solved() ? by_p[i] : zero;
    island_.Measure(m_.trial_v, m_.du);
    TimesMinusG(m_.du, m_.u2, true);
    for (int i = 0; i < island_.rows; ++i) by_b[i] += m_.u2[i];
    island_.pools.ForEach([&](auto& law, auto&, int row, int) {
      for (int i = 0; i < law.link_count; ++i) {
        const bool given = law.links[i].body >= island_.pattern.count;
        if (given) island_.AddForce(law.links[i], by_b + row, by_p);
      }
    });
  }

 private:
  int size() const noexcept { return kDofs * island_.body_count; }
  int solved() const noexcept { return kDofs * island_.pattern.count; }

  /// Computes out <- -G x, or -G^T x; not in place.
  void TimesMinusG(const Num* x, Num* out, bool transposed) const noexcept {
    island_.pools.ForEach([&](auto& law, auto&, int row, int cell) {
      const int R = RowsOf(law);
      const int along = transposed ? 1 : R, across = transposed ? R : 1;
      for (int i = 0; i < R; ++i) {
        out[row + i] = Num::Splat(0.0);
        for (int j = 0; j < R; ++j) {
          out[row + i] -= m_.g[cell + along * i + across * j] * x[row + j];
        }
      }
    });
  }

  Island<Num, P>& island_;
  IslandMemory<Num>& m_;
  BodyMatrix<Num> matrix_;
};

}  // namespace taut::sim
