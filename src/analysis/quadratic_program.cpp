// Dual active-set method for strictly convex quadratic programs: D. Goldfarb, A. Idnani, "A
// numerically stable dual method for solving strictly convex quadratic programs", Mathematical
// Programming 27 (1983) 1-33. It starts at the unconstrained minimum and adds the most violated
// constraint in each step. Constraints whose multipliers would become negative are removed. Every
// step ends at the minimum for its active constraints. The method needs no feasible start and does
// not cycle, even for degenerate programs. Differences here: rows are scaled to length one,
// redundant equations are omitted, and the result is refined with the final active set.
//
// Proximal point method for other programs: R. T. Rockafellar, "Monotone operators and the proximal
// point algorithm", SIAM J. Control Optim. 14 (1976) 877-898. It ends after finitely many steps for
// linear programs.
#include "analysis/quadratic_program.h"

#include <Eigen/Cholesky>
#include <Eigen/Jacobi>
#include <cmath>
#include <limits>
#include <vector>

namespace taut::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A row counts as linearly dependent if less than this share of it is independent of the active
/// rows.
constexpr double kIndependent = 1e-10;
/// Reciprocal condition number above which a Hessian counts as strictly convex.
constexpr double kWellConditioned = 1e-11;

/// Equations first, then inequalities, each scaled to length one.
struct Rows {
  MatrixXd normals;  ///< Normals of the constraints, one column per row
  VectorXd offsets, lengths;
  int equations = 0;

  explicit Rows(const QuadraticProgram& p) : equations(static_cast<int>(p.equalities.rows())) {
    const Eigen::Index n = p.gradient.size(), inequalities = p.inequalities.rows();
    const Eigen::Index count = equations + inequalities;
    normals.resize(n, count), offsets.resize(count), lengths.resize(count);
    if (equations > 0) {
      normals.leftCols(equations) = p.equalities.transpose();
      offsets.head(equations) = p.equal_to;
    }
    if (inequalities > 0) {
      normals.rightCols(inequalities) = p.inequalities.transpose();
      offsets.tail(inequalities) = p.at_least;
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      const double length = normals.col(i).norm();
      lengths[i] = length > 0 ? length : 1;
      normals.col(i) /= lengths[i];
      offsets[i] /= lengths[i];
    }
  }
  int count() const { return static_cast<int>(offsets.size()); }
};

class DualActiveSet {
 public:
  /// `factor`: Cholesky factor of the Hessian.
  DualActiveSet(const MatrixXd& hessian, const Eigen::LLT<MatrixXd>& factor,
                const VectorXd& gradient, const Rows& rows)
      : hessian_(hessian),
        gradient_(gradient),
        rows_(rows),
        is_active_(rows.count(), false),
        implied_(rows.count(), false) {
    const Eigen::Index n = gradient.size();
    j_ = factor.matrixU().solve(MatrixXd::Identity(n, n));
    r_ = MatrixXd::Zero(n, n);
    x_ = VectorXd::Zero(n);
    Move(-factor.solve(gradient));
    most_steps_ = 100 + 50 * (static_cast<int>(n) + rows.count());
  }

  QuadraticOutcome Run() {
    if (!x_.allFinite()) return QuadraticOutcome::kFailed;
    for (int i = 0; i < rows_.equations; ++i) {
      if (!Equation(i)) return QuadraticOutcome::kInfeasible;
    }
    while (steps < most_steps_) {
      int worst = MostViolated();
      if (worst < 0) {
        Refine();
        worst = MostViolated();
        if (worst < 0)
          return x_.allFinite() ? QuadraticOutcome::kSolved : QuadraticOutcome::kFailed;
      }
      if (!Include(worst)) {
        return steps < most_steps_ ? QuadraticOutcome::kInfeasible : QuadraticOutcome::kFailed;
      }
    }
    return QuadraticOutcome::kFailed;
  }

  /// Returns the multipliers of the solution, or of the proof of infeasibility. They refer to the
  /// rows before scaling.
  VectorXd Multipliers() const {
    VectorXd all = VectorXd::Zero(rows_.count());
    for (std::size_t k = 0; k < active_.size(); ++k) {
      const double u = multipliers_[k];
      all[active_[k]] = active_[k] < rows_.equations ? u : std::fmax(0.0, u);
    }
    if (refuted_ >= 0) all[refuted_] = refuted_sign_;
    return all.cwiseQuotient(rows_.lengths);
  }
  const VectorXd& x() const { return x_; }
  int steps = 0;

 private:
  int size() const { return static_cast<int>(active_.size()); }
  double Slack(int row) const { return rows_.normals.col(row).dot(x_) - rows_.offsets[row]; }
  /// Returns the rounding error of a slack, proportional to the largest component of x in all
  /// steps.
  double Tolerance(int row) const {
    return 1e-11 * (rows_.normals.col(row).cwiseAbs().dot(x_.cwiseAbs()) +
                    std::fabs(rows_.offsets[row])) +
           1e-15 * farthest_;
  }
  void Move(const VectorXd& by) {
    x_ += by;
    farthest_ = std::fmax(farthest_, x_.lpNorm<Eigen::Infinity>());
  }

  int MostViolated() const {
    int worst = -1;
    double depth = 0;
    for (int i = rows_.equations; i < rows_.count(); ++i) {
      if (is_active_[static_cast<std::size_t>(i)] || implied_[static_cast<std::size_t>(i)])
        continue;
      const double slack = Slack(i);
      if (slack < depth && slack < -Tolerance(i)) worst = i, depth = slack;
    }
    return worst;
  }

  /// Change of x and of the active multipliers per unit of the multiplier of the row to be added.
  struct Direction {
    VectorXd d, z, r;
    bool independent = false;
  };
  Direction Toward(int row) const {
    const int q = size();
    const Eigen::Index n = x_.size();
    Direction to;
    to.d = j_.transpose() * rows_.normals.col(row);
    const auto rest = to.d.tail(n - q);
    to.z = j_.rightCols(n - q) * rest;
    to.r = r_.topLeftCorner(q, q).triangularView<Eigen::Upper>().solve(to.d.head(q));
    to.independent = rest.norm() > kIndependent * to.d.norm();
    return to;
  }

  bool Equation(int row) {
    const Direction to = Toward(row);
    const double slack = Slack(row);
    if (!to.independent) {
      if (std::fabs(slack) <= 100 * Tolerance(row)) return true;  // redundant with the active rows
      Refute(row, slack < 0 ? 1.0 : -1.0, to.r);
      return false;
    }
    const double t = -slack / to.z.dot(rows_.normals.col(row));
    Move(t * to.z);
    for (int k = 0; k < size(); ++k) multipliers_[static_cast<std::size_t>(k)] -= t * to.r[k];
    Activate(row, to.d, t);
    return true;
  }

  /// Adds a violated inequality to the active set. Returns false if the program is infeasible.
  bool Include(int row) {
    double own = 0;
    while (steps < most_steps_) {
      const Direction to = Toward(row);
      double longest = kInfinity;
      int first = -1;  // index of the constraint to remove
      for (int k = 0; k < size(); ++k) {
        if (active_[static_cast<std::size_t>(k)] < rows_.equations || to.r[k] <= 0) continue;
        const double t = std::fmax(0.0, multipliers_[static_cast<std::size_t>(k)]) / to.r[k];
        if (t < longest) longest = t, first = k;
      }
      const double full =
          to.independent ? -Slack(row) / to.z.dot(rows_.normals.col(row)) : kInfinity;
      if (first < 0 && !to.independent) {
        if (!Contradicts(row, to.r)) {
          implied_[static_cast<std::size_t>(row)] = true;  // the violation is a rounding error
          return true;
        }
        Refute(row, 1.0, to.r);
        return false;
      }
      const double t = std::fmin(longest, full);
      if (to.independent) Move(t * to.z);
      for (int k = 0; k < size(); ++k) multipliers_[static_cast<std::size_t>(k)] -= t * to.r[k];
      own += t;
      if (full <= longest) {
        Activate(row, to.d, own);
        return true;
      }
      Drop(first);
    }
    return false;
  }

  /// Returns whether a row that depends linearly on the active rows contradicts them by more than
  /// rounding.
  bool Contradicts(int row, const VectorXd& r) const {
    double gain = rows_.offsets[row], largest = std::fabs(gain);
    for (int k = 0; k < size(); ++k) {
      const double part = r[k] * rows_.offsets[active_[static_cast<std::size_t>(k)]];
      gain -= part, largest += std::fabs(part);
    }
    return gain > 1e-12 * largest;
  }

  /// Stores the multipliers that prove infeasibility (Farkas): the row is a linear combination of
  /// the active rows and contradicts them.
  void Refute(int row, double sign, const VectorXd& r) {
    refuted_ = row, refuted_sign_ = sign;
    for (int k = 0; k < size(); ++k) multipliers_[static_cast<std::size_t>(k)] = -sign * r[k];
  }

  void Activate(int row, VectorXd d, double multiplier) {
    const int q = size();
    for (Eigen::Index i = x_.size() - 1; i > q; --i) {
      Eigen::JacobiRotation<double> turn;
      turn.makeGivens(d[i - 1], d[i]);
      d.applyOnTheLeft(i - 1, i, turn.adjoint());
      j_.applyOnTheRight(i - 1, i, turn);
    }
    r_.col(q).head(q + 1) = d.head(q + 1);
    active_.push_back(row), multipliers_.push_back(multiplier);
    is_active_[static_cast<std::size_t>(row)] = true;
    ++steps;
  }

  void Drop(int k) {
    const int q = size();
    implied_.assign(implied_.size(), false);
    is_active_[static_cast<std::size_t>(active_[static_cast<std::size_t>(k)])] = false;
    active_.erase(active_.begin() + k), multipliers_.erase(multipliers_.begin() + k);
    for (int c = k; c + 1 < q; ++c) r_.col(c) = r_.col(c + 1).eval();
    for (int c = k; c + 1 < q; ++c) {
      Eigen::JacobiRotation<double> turn;
      turn.makeGivens(r_(c, c), r_(c + 1, c));
      r_.topRows(q).applyOnTheLeft(c, c + 1, turn.adjoint());
      j_.applyOnTheRight(c, c + 1, turn);
    }
    r_.col(q - 1).setZero();
    ++steps;
  }

  /// Recomputes x and the multipliers from the active set to remove accumulated rounding errors.
  void Refine() {
    const int q = size();
    const Eigen::Index n = x_.size();
    const auto r = r_.topLeftCorner(q, q).triangularView<Eigen::Upper>();
    for (int pass = 0; pass < 2; ++pass) {
      VectorXd left(q);
      for (int k = 0; k < q; ++k) left[k] = -Slack(active_[static_cast<std::size_t>(k)]);
      x_ += j_.leftCols(q) * r.transpose().solve(left);
      const VectorXd slope = hessian_ * x_ + gradient_;
      x_ -= j_.rightCols(n - q) * (j_.rightCols(n - q).transpose() * slope);
    }
    const VectorXd u = r.solve(j_.leftCols(q).transpose() * (hessian_ * x_ + gradient_));
    for (int k = 0; k < q; ++k) multipliers_[static_cast<std::size_t>(k)] = u[k];
  }

  const MatrixXd& hessian_;
  const VectorXd& gradient_;
  const Rows& rows_;
  MatrixXd j_, r_;  ///< J' H J = 1 and J' N = (R, 0), with the active normals N.
  VectorXd x_;
  std::vector<int> active_;
  std::vector<double> multipliers_;
  std::vector<bool> is_active_;
  /// Rows implied by the active ones. They are skipped until an active row is removed.
  std::vector<bool> implied_;
  double farthest_ = 0;  ///< Largest component of x in all steps.
  int refuted_ = -1, most_steps_ = 0;
  double refuted_sign_ = 0;
};

/// Solves a program whose Hessian has a Cholesky factor.
QuadraticAnswer SolveStrictly(const MatrixXd& hessian, const Eigen::LLT<MatrixXd>& factor,
                              const VectorXd& gradient, const Rows& rows) {
  DualActiveSet search(hessian, factor, gradient, rows);
  QuadraticAnswer answer;
  answer.outcome = search.Run();
  answer.x = search.x();
  const VectorXd all = search.Multipliers();
  answer.equality = all.head(rows.equations);
  answer.inequality = all.tail(rows.count() - rows.equations);
  answer.steps = search.steps;
  return answer;
}

/// Returns whether the objective decreases without bound along `d` and all constraints remain
/// satisfied.
bool IsRay(const QuadraticProgram& p, const Rows& rows, const VectorXd& d) {
  constexpr double kRounding = 1e-8;
  const double curvature = (p.hessian * d).norm(), largest = p.hessian.norm();
  if (curvature > kRounding * largest || p.gradient.dot(d) > -kRounding * p.gradient.norm()) {
    return false;
  }
  for (int i = 0; i < rows.count(); ++i) {
    const double gain = rows.normals.col(i).dot(d);
    if (gain < -kRounding || (i < rows.equations && gain > kRounding)) return false;
  }
  return true;
}

/// Proximal point method: x_k+1 minimizes the objective plus e |x - x_k|^2 / 2.
QuadraticAnswer SolveByProximity(const QuadraticProgram& p, const Rows& rows) {
  constexpr int kMostRounds = 60;
  constexpr double kFirst = 0.1, kLeast = 1e-6, kCloser = 1e-11;
  const Eigen::Index n = p.gradient.size();
  double scale =
      std::fmax(p.hessian.lpNorm<Eigen::Infinity>(), p.gradient.lpNorm<Eigen::Infinity>());
  if (!(scale > 0)) scale = 1;
  VectorXd x = VectorXd::Zero(n);
  int steps = 0;
  double share = kFirst;
  for (int round = 0; round < kMostRounds; ++round) {
    const double e = share * scale;
    const MatrixXd hessian = p.hessian + e * MatrixXd::Identity(n, n);
    const VectorXd gradient = p.gradient - e * x;
    QuadraticAnswer answer = SolveStrictly(hessian, Eigen::LLT<MatrixXd>(hessian), gradient, rows);
    answer.steps = steps += answer.steps;
    if (answer.outcome != QuadraticOutcome::kSolved) return answer;
    const VectorXd step = answer.x - x;
    const double length = step.norm();
    if (round > 0 && length <= kCloser * (1 + answer.x.norm())) return answer;
    if (length > 0 && IsRay(p, rows, step / length)) {
      answer.outcome = QuadraticOutcome::kUnbounded;
      answer.ray = step / length;
      return answer;
    }
    x = answer.x;
    share = std::fmax(kLeast, 0.1 * share);
  }
  QuadraticAnswer failed;
  failed.x = x, failed.steps = steps;
  failed.equality = VectorXd::Zero(rows.equations);
  failed.inequality = VectorXd::Zero(rows.count() - rows.equations);
  return failed;
}

}  // namespace

QuadraticAnswer Solve(const QuadraticProgram& program) {
  const Rows rows(program);
  if (program.gradient.size() > 0) {
    const Eigen::LLT<MatrixXd> factor(program.hessian);
    if (factor.info() == Eigen::Success && factor.rcond() > kWellConditioned) {
      return SolveStrictly(program.hessian, factor, program.gradient, rows);
    }
  }
  return SolveByProximity(program, rows);
}

}  // namespace taut::analysis
