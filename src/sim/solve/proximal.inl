/// Third stage of an island's solve: proximal rounds. Each round is a Newton solve with line search
/// of regularized laws, centered at the impulses of the previous round (docs/theory/contact.md, eq.
/// 24-28).
///
/// In a round, every law has a compliance: a fraction `e` of its inverse mass. Its impulses are
/// then a function of the body velocities: l(v) = Project(u, center, e). The round solves
///   F(v) = M (v - v_free) - J^T l(v) = 0.
/// With fixed friction radii, F is the gradient of a convex function, which controls the step
/// length. As the centers converge, the effect of the compliance vanishes.
#pragma once

#include "math/angle.h"
#include "sim/constraint/links.h"
#include "sim/data/island.h"
#include "sim/solve/body_matrix.inl"
#include "sim/solve/deadlock.inl"
#include "sim/solve/gauss_seidel.inl"

namespace taut::sim {

template <class Num, class P>
class Proximal {
  static constexpr int kMaxRounds = 40, kMaxIterations = 40, kSweepsAfterFailure = 10;
  static constexpr double kLeastSoftness = 1e-8, kStays = 1e-3;
  static constexpr int kMaxStays = 4;
  /// Criteria for inconsistent contacts. A round counts if its compliance is at most the compliance
  /// of the last round that reduced the best residual by the factor kFalls. After kRounds such
  /// rounds (kRoundsIfSmall below kSmallMPerS), the laws are relaxed if the round failed, the
  /// residual stays the same, or the compliance is at most kStiff.
  static constexpr double kFalls = 0.5, kSmallMPerS = 1e-8, kStiff = 1e-8;
  static constexpr int kRoundsIfSmall = 4, kRounds = 6;

 public:
  Proximal(Island<Num, P>& island, Target target, SolverWork& work) noexcept
      : island_(island),
        m_(island.m),
        matrix_(island.pattern, island.m.blocks),
        tolerance_(target.tolerance),
        work_(work),
        size_(kDofs * island.body_count) {}

  /// Improves m.l. On entry and return, m.v and m.u are the velocities of m.l. Returns the residual
  /// [m/s].
  double Solve(double first_softness) noexcept {
    double e = first_softness, failed_at = 0, best_at_failure = 0;
    double residual = island_.Judge(), best = residual;
    Keep(m_.best, m_.l, island_.rows);
    bool carried = false;  // m.trial_v is the result of the last round
    int stayed = 0;
    int stale = 0;         // rounds at this compliance or less since the residual was last halved
    double e_at_fall = e;  // compliance in that round
    for (int round = 0; round < kMaxRounds && residual > tolerance_ && !Exhausted(); ++round) {
      Keep(m_.center, m_.l, island_.rows);
      if (!carried) Keep(m_.trial_v, m_.v, size_);
      const bool ended_well = Round(e);
      const double before = residual;
      residual = island_.Judge();
      // Counts rounds that show inconsistent contacts (deadlock.inl).
      stayed = ended_well && Stays(residual, before, kStays * residual) ? stayed + 1 : 0;
      if (residual < kFalls * best) {
        stale = 0, e_at_fall = e;
      } else if (ended_well && e <= e_at_fall) {
        ++stale;
      }
      KeepIfBest(residual, best);
      const bool stays = stayed == kMaxStays && best < kDisagreementMPerS;
      if (stays || !ended_well || e <= kStiff) {
        const int enough = best <= kSmallMPerS ? kRoundsIfSmall : kRounds;
        if (stale >= enough && RelaxBest(best)) return island_.Judge();
      }
      if (stays) break;
      carried = ended_well && residual - residual == 0;
      if (ended_well) {
        // Approaches, in smaller steps, a compliance at which an earlier round failed.
        const bool near_failure = failed_at > 0 && 0.1 * e <= 1.01 * failed_at;
        e *= near_failure ? 0.3 : 0.1;
        if (e < kLeastSoftness) e = kLeastSoftness;
        if (e < 0.5 * failed_at) failed_at = 0;
        continue;
      }
      // Further rounds would repeat the same result.
      if (failed_at > 0 && best > kFalls * best_at_failure) {
        if (RelaxBest(best)) return island_.Judge();
        break;
      }
      best_at_failure = best;
      failed_at = e;
      e = 30 * e < 1 ? 30 * e : 1;
      residual = Sweep(island_, kSweepsAfterFailure);
      KeepIfBest(residual, best);
      if (!(residual <= 1e3 * best)) residual = island_.Return(m_.best);
    }
    return residual > best || !(residual - residual == 0) ? island_.Return(m_.best) : residual;
  }

 private:
  bool Exhausted() const noexcept { return work_.linear_solves >= work_.limit; }
  static void Keep(Num* to, const Num* from, int count) noexcept {
    for (int i = 0; i < count; ++i) to[i] = from[i];
  }
  void KeepIfBest(double residual, double& best) noexcept {
    if (!(residual < best)) return;
    best = residual;
    Keep(m_.best, m_.l, island_.rows);
  }

  /// Relaxes the laws that the impulses m.l violate: the next step then starts from the impulses
  /// accumulated along the loop, until a contact slides. If this fails, tries the best impulses. If
  /// that fails, too, restores m.l and returns false.
  bool RelaxBest(double best) noexcept {
    if (!(best > tolerance_ && best <= kDisagreementMPerS)) return false;
    if (Relax(island_, tolerance_, work_)) return true;
    Keep(m_.du, m_.l, island_.rows);
    island_.Return(m_.best);
    if (Relax(island_, tolerance_, work_)) return true;
    Keep(m_.l, m_.du, island_.rows);
    island_.Judge();
    return false;
  }

  /// Runs one round with compliance e from m.trial_v. Results: impulses in m.l, velocities in
  /// m.trial_v. Returns true if the round converged. The impulses of a converged round come from
  /// the linear equations of the last step, which are free of the noise that a small e amplifies.
  bool Round(double softness) noexcept {
    const Num e = Num::Splat(softness);
    island_.Measure(m_.trial_v, m_.u);
    double theta = 1;  // fraction of the true curvature along the sliding direction, see Stiffen
    for (int iteration = 0; iteration < kMaxIterations && !Exhausted(); ++iteration) {
      Evaluate(e, theta);
      bool symmetric = false;
      double slope = Direction(false);
      if (!(slope < 0)) {
        symmetric = true;
        DropCoupling();
        slope = Direction(true);
        if (!(slope < 0)) break;
      }
      island_.Measure(m_.direction, m_.du);
      // If all branches are the same at the end of the step, the step solves the equations without
      // a line search.
      StepTo(1);
      if (theta == 1 && !symmetric && SameBranches(e)) {
        TakeLinear();
        for (int i = 0; i < size_; ++i) m_.trial_v[i] += m_.direction[i];
        return true;
      }
      const double alpha = LineSearch(e, slope);
      theta = alpha < 0.5 ? theta - 0.3 : theta + 0.3;
      theta = theta < 0 ? 0 : theta > 1 ? 1 : theta;
      StepTo(alpha);
      const Num step = Num::Splat(alpha);
      for (int i = 0; i < size_; ++i) m_.trial_v[i] += step * m_.direction[i];
      Keep(m_.u, m_.u2, island_.rows);
    }
    island_.pools.ForEach([&](auto& law, auto&, int row, int) {
      law.Project(m_.u + row, m_.center + row, e, m_.l + row);
    });
    island_.Clamp(m_.l);
    return false;
  }

  /// Moves along the step: u2 <- u + alpha du.
  void StepTo(double alpha) noexcept {
    const Num step = Num::Splat(alpha);
    for (int i = 0; i < island_.rows; ++i) m_.u2[i] = m_.u[i] + step * m_.du[i];
  }

  /// Computes impulses, their derivatives and F at m.u, m.trial_v.
  void Evaluate(Num e, double theta) noexcept {
    Gradient();
    island_.pools.ForEach([&](auto& law, auto& branch, int row, int cell) {
      branch = law.Project(m_.u + row, m_.center + row, e, m_.projected + row);
      law.Derivative(branch, e, m_.g + cell);
      if (theta < 1) law.Stiffen(branch, Num::Splat(1 - theta), m_.g + cell);
      Num minus[LawOf<decltype(law)>::kRows];
      for (int r = 0; r < RowsOf(law); ++r) minus[r] = -m_.projected[row + r];
      island_.AddForce(law, minus, m_.rhs);
    });
  }
  /// Computes rhs <- M (v - v_free).
  void Gradient() noexcept {
    for (int b = 0; b < island_.body_count; ++b) {
      Num free[kDofs], x[kDofs];
      island_.Store(island_.bodies[b].free, free);
      for (int i = 0; i < kDofs; ++i) x[i] = m_.trial_v[kDofs * b + i] - free[i];
      island_.TimesMass(island_.bodies[b], x, m_.rhs + kDofs * b);
    }
  }

  /// Computes direction <- -(M + J^T G J)^-1 F. Returns the slope direction . F, or 0 if the matrix
  /// is singular.
  double Direction(bool symmetric) noexcept {
    matrix_.Start(island_.bodies, symmetric);
    island_.pools.ForEach([&](auto& law, auto&, int, int cell) { matrix_.Add(law, m_.g + cell); });
    ++work_.linear_solves;
    if (!matrix_.Factor()) return 0;
    for (int i = 0; i < size_; ++i) m_.direction[i] = -m_.rhs[i];
    matrix_.Solve(m_.direction);
    Num slope = Num::Splat(0.0);
    for (int i = 0; i < size_; ++i) slope += m_.direction[i] * m_.rhs[i];
    return slope[0];
  }

  /// Removes the dependence of friction on the normal impulse, so that the matrix is positive
  /// definite.
  void DropCoupling() noexcept {
    island_.pools.ForEach([&](auto& law, auto&, int, int cell) {
      const int R = RowsOf(law);
      for (int i = 0; i < R; ++i) {
        for (int j = 0; j < i; ++j) {
          const Num upper = m_.g[cell + R * j + i];
          m_.g[cell + R * i + j] = upper;
        }
      }
    });
  }

  /// Returns the slope of the convex function along the direction at `alpha`. `at_zero` and
  /// `per_alpha`: contribution of M.
  double SlopeAt(Num e, double alpha, double at_zero, double per_alpha) noexcept {
    Num sum = Num::Splat(at_zero + per_alpha * alpha);
    const Num step = Num::Splat(alpha);
    island_.pools.ForEach([&](auto& law, auto&, int row, int) {
      constexpr int R = LawOf<decltype(law)>::kRows;
      const int rows = RowsOf(law);
      Num u[R], l[R];
      for (int r = 0; r < rows; ++r) u[r] = m_.u[row + r] + step * m_.du[row + r];
      law.ProjectFrozen(u, m_.center + row, e, m_.projected + row, l);
      for (int r = 0; r < rows; ++r) sum -= l[r] * m_.du[row + r];
    });
    return sum[0];
  }

  /// Returns the step length: 1 unless the slope at the end of the step is clearly positive,
  /// otherwise the point at which the slope is a tenth of its initial value.
  double LineSearch(Num e, double slope) noexcept {
    Num straight = Num::Splat(0.0), bent = Num::Splat(0.0);  // d . M (v - v_free), d . M d
    Num x[kDofs], md[kDofs], free[kDofs];
    for (int b = 0; b < island_.body_count; ++b) {
      const Num* const d = m_.direction + kDofs * b;
      island_.TimesMass(island_.bodies[b], d, md);
      island_.Store(island_.bodies[b].free, free);
      for (int i = 0; i < kDofs; ++i) {
        x[i] = m_.trial_v[kDofs * b + i] - free[i];
        straight += md[i] * x[i];
        bent += md[i] * d[i];
      }
    }
    const double steep = -slope;
    double low = 0, at_low = slope, high = 1;
    double at_high = SlopeAt(e, 1, straight[0], bent[0]);
    if (!(at_high > 0.25 * steep)) return 1;
    double alpha = 1;
    for (int i = 0; i < 25; ++i) {
      double share = -at_low / (at_high - at_low);
      share = share < 0.05 ? 0.05 : share > 0.95 ? 0.95 : share;
      alpha = i % 3 == 2 ? 0.5 * (low + high) : low + (high - low) * share;
      const double at = SlopeAt(e, alpha, straight[0], bent[0]);
      if ((at < 0 ? -at : at) < 0.1 * steep) break;
      if (at > 0) {
        high = alpha, at_high = at;
      } else {
        low = alpha, at_low = at;
      }
    }
    return alpha;
  }

  /// Returns whether every law has the same branch at m.u2 and m.u.
  bool SameBranches(Num e) noexcept {
    bool same = true;
    island_.pools.ForEach([&](auto& law, auto& branch, int row, int) {
      using Law = LawOf<decltype(law)>;
      Num l[Law::kRows];
      same = same && Law::Same(branch, law.Project(m_.u2 + row, m_.center + row, e, l));
    });
    return same;
  }

  /// Computes the impulses of the linear equations: l <- l(v) - G J d.
  void TakeLinear() noexcept {
    island_.pools.ForEach([&](auto& law, auto&, int row, int cell) {
      const int R = RowsOf(law);
      for (int i = 0; i < R; ++i) {
        Num l = m_.projected[row + i];
        for (int j = 0; j < R; ++j) l -= m_.g[cell + R * i + j] * m_.du[row + j];
        m_.l[row + i] = l;
      }
    });
    island_.Clamp(m_.l);
  }

  Island<Num, P>& island_;
  IslandMemory<Num>& m_;
  BodyMatrix<Num> matrix_;
  double tolerance_;
  SolverWork& work_;
  int size_;
};

}  // namespace taut::sim
