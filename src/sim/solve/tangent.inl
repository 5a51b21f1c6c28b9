/// How an island's solution changes with what it was solved for: the linear system of Newton's
/// method at the solution, and its transpose for gradients (docs/theory/contact.md, eq. 29-31).
/// Nothing in a step needs it; it is for who wants derivatives of one.
#pragma once

#include "sim/constraint/links.h"
#include "sim/data/island.h"
#include "sim/solve/body_matrix.inl"
#include "sim/solve/plain_newton.inl"

namespace taut::sim {

/// Of an island after its solve. Borrows the memory of the stages; velocities and impulses stay.
///
/// What changes, and what of it follows:
///   p   6 an unknown: momentum that it gets, M times a change of its free velocity [N s; N m s];
///       of one that is prescribed, the change of its velocity [m/s; rad/s]
///   b   one a row: what is added to the velocity that the row's law sees, as a bias is [m/s]
///   dv, dl   of the velocities and impulses; of one that is prescribed dv is p
/// Laws are followed on the branches that they are on. Where two meet (a contact that just touches,
/// that just slips) this is the slope to one side. Where the impulses have been drawn back for the
/// energy's sake (impacts.inl) they satisfy no law, and this says nothing.
template <class Num, class P>
class IslandTangent {
 public:
  explicit IslandTangent(Island<Num, P>& island) noexcept
      : island_(island), m_(island.m), matrix_(island.pattern, island.m.blocks) {}

  /// False if the system is singular, or the island has no room for it. All else is as exact as
  /// the compliance, by which loads that may be shared in many ways are shared, is small.
  bool Factor(double compliance = 1e-7) noexcept {
    if (!island_.has_matrix) return false;
    bool symmetric = true;
    island_.pools.ForEach([&](auto& law, auto& branch, int row, int cell) {
      branch = law.BranchOf(m_.u + row, m_.l + row);
      const bool even = StepOf(law, branch, m_.u + row, m_.l + row, Num::Splat(compliance),
                               m_.g + cell, m_.f + row);
      symmetric = symmetric && even;
    });
    matrix_.Start(island_.bodies, symmetric);
    island_.pools.ForEach([&](auto& law, auto&, int, int cell) { matrix_.Add(law, m_.g + cell); });
    return matrix_.Factor();
  }

  /// M + J^T G J of what is not prescribed, factored.
  const BodyMatrix<Num>& matrix() const noexcept { return matrix_; }

  /// dv, dl <- what p and b bring about (eq. 29). dv may be p.
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

  /// Of a number that depends on velocities and impulses with the derivatives `by_v`, `by_l`: those
  /// by p and b (eq. 31). by_p may be by_v.
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

  /// out <- -G x, or -G^T x; not in place.
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
