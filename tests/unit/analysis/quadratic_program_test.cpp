// Quadratic and linear programs against the Karush-Kuhn-Tucker conditions, against certificates of
// infeasibility and unboundedness, and against enumeration of all active sets
#include "analysis/quadratic_program.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

namespace taut::analysis {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

double Value(const QuadraticProgram& p, const VectorXd& x) {
  return 0.5 * x.dot(p.hessian * x) + p.gradient.dot(x);
}

double Size(const QuadraticProgram& p, const VectorXd& x) {
  return 1 + x.norm() + p.gradient.norm() + p.hessian.norm() * x.norm();
}

/// Returns the largest violation of a constraint at x.
double Violation(const QuadraticProgram& p, const VectorXd& x) {
  double most = 0;
  if (p.equalities.rows() > 0) {
    most = (p.equalities * x - p.equal_to).lpNorm<Eigen::Infinity>();
  }
  if (p.inequalities.rows() > 0) {
    most = std::fmax(most, -(p.inequalities * x - p.at_least).minCoeff());
  }
  return most;
}

VectorXd Combined(const QuadraticProgram& p, const QuadraticAnswer& a) {
  VectorXd sum = VectorXd::Zero(p.gradient.size());
  if (p.equalities.rows() > 0) sum += p.equalities.transpose() * a.equality;
  if (p.inequalities.rows() > 0) sum += p.inequalities.transpose() * a.inequality;
  return sum;
}

void ExpectLeast(const QuadraticProgram& p, const QuadraticAnswer& a, double tolerance = 1e-9) {
  ASSERT_EQ(a.outcome, QuadraticOutcome::kSolved);
  const double size = Size(p, a.x);
  EXPECT_LT(Violation(p, a.x), tolerance * size);
  EXPECT_LT((p.hessian * a.x + p.gradient - Combined(p, a)).norm(), tolerance * size);
  if (p.inequalities.rows() == 0) return;
  EXPECT_GE(a.inequality.minCoeff(), 0);
  const VectorXd slack = p.inequalities * a.x - p.at_least;
  EXPECT_LT(slack.cwiseProduct(a.inequality).lpNorm<Eigen::Infinity>(),
            tolerance * size * (1 + a.inequality.norm()));
}

void ExpectProof(const QuadraticProgram& p, const QuadraticAnswer& a) {
  ASSERT_EQ(a.outcome, QuadraticOutcome::kInfeasible);
  double gain = 0, weight = 0;
  if (p.equalities.rows() > 0) gain += p.equal_to.dot(a.equality), weight += a.equality.norm();
  if (p.inequalities.rows() > 0) {
    EXPECT_GE(a.inequality.minCoeff(), 0);
    gain += p.at_least.dot(a.inequality), weight += a.inequality.norm();
  }
  ASSERT_GT(gain, 0);
  EXPECT_LT(Combined(p, a).norm(), 1e-9 * weight);
}

void ExpectRay(const QuadraticProgram& p, const QuadraticAnswer& a) {
  ASSERT_EQ(a.outcome, QuadraticOutcome::kUnbounded);
  EXPECT_LT(p.gradient.dot(a.ray), 0);
  EXPECT_LT((p.hessian * a.ray).norm(), 1e-7 * p.hessian.norm() + 1e-12);
  if (p.equalities.rows() > 0) {
    EXPECT_LT((p.equalities * a.ray).norm(), 1e-7);
  }
  if (p.inequalities.rows() > 0) {
    EXPECT_GT((p.inequalities * a.ray).minCoeff(), -1e-7);
  }
}

/// Returns the best feasible point over all active sets, or nothing if none is feasible. For
/// programs that are strictly convex, or linear with a vertex at the minimum.
std::optional<VectorXd> ByTryingAll(const QuadraticProgram& p) {
  const Eigen::Index n = p.gradient.size(), m = p.inequalities.rows(), e = p.equalities.rows();
  std::optional<VectorXd> best;
  for (unsigned set = 0; set < 1U << m; ++set) {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = 0; i < m; ++i) {
      if (set >> i & 1U) rows.push_back(i);
    }
    const Eigen::Index active = e + static_cast<Eigen::Index>(rows.size());
    if (active > n) continue;
    MatrixXd kkt = MatrixXd::Zero(n + active, n + active);
    VectorXd right(n + active);
    kkt.topLeftCorner(n, n) = p.hessian;
    right.head(n) = -p.gradient;
    for (Eigen::Index k = 0; k < active; ++k) {
      const bool equation = k < e;
      const Eigen::Index row = equation ? k : rows[static_cast<std::size_t>(k - e)];
      const VectorXd normal = equation ? p.equalities.row(row) : p.inequalities.row(row);
      kkt.col(n + k).head(n) = normal;
      kkt.row(n + k).head(n) = normal.transpose();
      right[n + k] = equation ? p.equal_to[row] : p.at_least[row];
    }
    const Eigen::FullPivLU<MatrixXd> factors(kkt);
    if (!factors.isInvertible()) continue;
    const VectorXd x = factors.solve(right).head(n);
    if (Violation(p, x) > 1e-8 * (1 + x.norm())) continue;
    if (!best || Value(p, x) < Value(p, *best)) best = x;
  }
  return best;
}

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double Normal() { return std::normal_distribution<double>()(random_); }
  int Upto(int most) { return std::uniform_int_distribution<int>(0, most)(random_); }
  MatrixXd Matrix(int rows, int columns) {
    MatrixXd m(rows, columns);
    for (double& x : m.reshaped()) x = Normal();
    return m;
  }
  /// Small integers, so that constraints intersect in common points, repeat and contradict each
  /// other.
  MatrixXd Whole(int rows, int columns) {
    MatrixXd m(rows, columns);
    for (double& x : m.reshaped()) x = Upto(4) - 2;
    return m;
  }

 private:
  std::mt19937 random_;
};

QuadraticProgram Random(Draw& draw, int n, int equations, int inequalities, bool whole) {
  QuadraticProgram p;
  const auto matrix = [&](int r, int c) { return whole ? draw.Whole(r, c) : draw.Matrix(r, c); };
  const MatrixXd root = draw.Matrix(n, n);
  p.hessian = root.transpose() * root + 0.1 * MatrixXd::Identity(n, n);
  if (whole) p.hessian = MatrixXd::Identity(n, n) * (1 + draw.Upto(3));
  p.gradient = matrix(n, 1);
  p.equalities = matrix(equations, n);
  p.equal_to = matrix(equations, 1);
  p.inequalities = matrix(inequalities, n);
  p.at_least = matrix(inequalities, 1);
  return p;
}

TEST(QuadraticProgram, ThousandsOfRandomOnesAreOptimalOrProvablyInfeasible) {
  Draw draw(1);
  int solved = 0, infeasible = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const int n = 1 + draw.Upto(11);
    const QuadraticProgram p =
        Random(draw, n, draw.Upto(n / 2), draw.Upto(2 * n + 4), trial % 2 == 1);
    const QuadraticAnswer a = Solve(p);
    if (a.outcome == QuadraticOutcome::kInfeasible) {
      ExpectProof(p, a);
      ++infeasible;
    } else {
      ExpectLeast(p, a);
      ++solved;
    }
    if (HasFailure()) FAIL() << "trial " << trial;
  }
  EXPECT_GT(solved, 1000);
  EXPECT_GT(infeasible, 500);
}

TEST(QuadraticProgram, SmallOnesAreWhatTryingAllActiveSetsFinds) {
  Draw draw(2);
  for (int trial = 0; trial < 1500; ++trial) {
    const int n = 1 + draw.Upto(3);
    const QuadraticProgram p = Random(draw, n, draw.Upto(1), draw.Upto(7), trial % 2 == 1);
    if (p.equalities.norm() == 0 && p.equalities.rows() > 0) continue;
    const std::optional<VectorXd> best = ByTryingAll(p);
    const QuadraticAnswer a = Solve(p);
    ASSERT_EQ(best.has_value(), a.outcome == QuadraticOutcome::kSolved) << "trial " << trial;
    if (!best) continue;
    ASSERT_LT((*best - a.x).norm(), 1e-8 * (1 + best->norm())) << "trial " << trial;
  }
}

// Degenerate point with far more constraints than dimensions: no cycling, the same solution.
TEST(QuadraticProgram, ManyConstraintsThroughOnePoint) {
  Draw draw(3);
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 2 + draw.Upto(6), m = 6 * n;
    QuadraticProgram p = Random(draw, n, 0, m, false);
    const VectorXd apex = draw.Matrix(n, 1);
    // All constraints are active at the apex, and the last ones repeat the first.
    for (int i = 0; i < m / 3; ++i) p.inequalities.row(m - 1 - i) = 3 * p.inequalities.row(i);
    p.at_least = p.inequalities * apex;
    ExpectLeast(p, Solve(p));
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

TEST(QuadraticProgram, EquationsThatFollowFromOthersAreLeftOutAndThoseThatContradictProveIt) {
  Draw draw(4);
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 3 + draw.Upto(5);
    QuadraticProgram p = Random(draw, n, 4, 3, false);
    p.at_least.setConstant(-100);
    p.equalities.row(3) = 2 * p.equalities.row(0) - p.equalities.row(1);
    p.equal_to[3] = 2 * p.equal_to[0] - p.equal_to[1];
    if (n == 3) p.equal_to = p.equalities * draw.Matrix(n, 1);
    ExpectLeast(p, Solve(p));
    p.equal_to[3] += 1e-3;
    ExpectProof(p, Solve(p));
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

QuadraticProgram Linear(Draw& draw, int n, int inequalities, double box) {
  QuadraticProgram p;
  p.hessian = MatrixXd::Zero(n, n);
  p.gradient = draw.Whole(n, 1);
  p.inequalities.resize(inequalities + 2 * n, n);
  p.inequalities << draw.Whole(inequalities, n), MatrixXd::Identity(n, n),
      -MatrixXd::Identity(n, n);
  p.at_least.resize(inequalities + 2 * n);
  p.at_least << draw.Whole(inequalities, 1), VectorXd::Constant(2 * n, -box);
  return p;
}

TEST(QuadraticProgram, LinearOnesEndInTheVertexThatTryingAllFinds) {
  Draw draw(5);
  int solved = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const int n = 1 + draw.Upto(2);
    const QuadraticProgram p = Linear(draw, n, draw.Upto(5), trial % 3 == 0 ? 1000 : 3);
    const std::optional<VectorXd> best = ByTryingAll(p);
    const QuadraticAnswer a = Solve(p);
    ASSERT_EQ(best.has_value(), a.outcome == QuadraticOutcome::kSolved) << "trial " << trial;
    if (!best) {
      ExpectProof(p, a);
      continue;
    }
    ++solved;
    ExpectLeast(p, a);
    ASSERT_NEAR(Value(p, *best), Value(p, a.x), 1e-9 * (1 + std::fabs(Value(p, *best))))
        << "trial " << trial;
  }
  EXPECT_GT(solved, 200);
}

TEST(QuadraticProgram, LargerLinearOnesAreOptimalByTheirDuals) {
  Draw draw(6);
  for (int trial = 0; trial < 40; ++trial) {
    const int n = 10 + draw.Upto(30);
    QuadraticProgram p = Linear(draw, n, 0, 5);
    p.equalities = draw.Matrix(n / 3, n);
    p.equal_to = p.equalities * VectorXd::Constant(n, 0.5);
    const QuadraticAnswer a = Solve(p);
    ExpectLeast(p, a);
    const double dual = p.equal_to.dot(a.equality) + p.at_least.dot(a.inequality);
    EXPECT_NEAR(Value(p, a.x), dual, 1e-8 * (1 + std::fabs(dual)));
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

TEST(QuadraticProgram, WithoutALeastItSaysAlongWhichRay) {
  Draw draw(7);
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 2 + draw.Upto(4);
    QuadraticProgram p = Random(draw, n, 0, 2 * n, false);
    if (trial % 2 == 0) p.hessian.setZero();
    VectorXd ray = draw.Matrix(n, 1);
    ray.normalize();
    p.hessian -= p.hessian * ray * ray.transpose();  // flat along the ray
    p.hessian = p.hessian.transpose() * p.hessian;
    for (int i = 0; i < 2 * n; ++i) {
      if (p.inequalities.row(i).dot(ray) < 0) p.inequalities.row(i) *= -1;
    }
    p.gradient -= (p.gradient.dot(ray) + 1) * ray;
    ExpectRay(p, Solve(p));
    if (HasFailure()) FAIL() << "trial " << trial;
  }
}

TEST(QuadraticProgram, FlatDirectionsThatCostNothing) {
  // x + y = 2 with the least x^2: x = 0; z is arbitrary within its bounds.
  QuadraticProgram p;
  p.hessian = Eigen::Vector3d(2, 0, 0).asDiagonal();
  p.gradient = VectorXd::Zero(3);
  p.equalities = Eigen::RowVector3d(1, 1, 0);
  p.equal_to = VectorXd::Constant(1, 2);
  p.inequalities = Eigen::RowVector3d(0, 0, 1);
  p.at_least = VectorXd::Constant(1, 4);
  const QuadraticAnswer a = Solve(p);
  ExpectLeast(p, a);
  EXPECT_NEAR(a.x[0], 0, 1e-9);
  EXPECT_NEAR(a.x[1], 2, 1e-9);
}

TEST(QuadraticProgram, NothingToChooseAndEmptyRows) {
  QuadraticProgram p;
  p.hessian.resize(0, 0), p.gradient.resize(0);
  EXPECT_EQ(Solve(p).outcome, QuadraticOutcome::kSolved);
  p.inequalities.resize(1, 0);
  p.at_least = VectorXd::Constant(1, 1);
  EXPECT_EQ(Solve(p).outcome, QuadraticOutcome::kInfeasible);
  p.hessian = MatrixXd::Identity(1, 1), p.gradient = VectorXd::Constant(1, 1);
  p.inequalities = MatrixXd::Zero(1, 1);
  ExpectProof(p, Solve(p));
  p.at_least[0] = -1;
  ExpectLeast(p, Solve(p));
  p.gradient[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Solve(p).outcome, QuadraticOutcome::kFailed);
}

}  // namespace
}  // namespace taut::analysis
