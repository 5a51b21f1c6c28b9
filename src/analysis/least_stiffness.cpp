// Least stiffness of a structure (docs/theory/statics.md, eq. 16).
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "analysis/point_metric.h"
#include "analysis/structure_members.h"
#include "analysis/tangent.h"
#include "analysis/whole_motions.h"
#include "taut/analysis.h"

namespace taut {
namespace analysis {
namespace {

constexpr double kUnmeasured = 1e-9;  ///< Eigenvalues below this share of the largest count as 0.

/// Returns the columns of `effective` that move body `b`, restricted to its six motions.
Eigen::MatrixXd MotionsOfBody(const Eigen::MatrixXd& effective, Eigen::Index b) {
  const Eigen::MatrixXd rows = effective.middleRows(6 * b, 6);
  Eigen::MatrixXd own(6, 0);
  for (Eigen::Index i = 0; i < rows.cols(); ++i) {
    if (rows.col(i).norm() == 0) continue;
    own.conservativeResize(Eigen::NoChange, own.cols() + 1);
    own.rightCols(1) = rows.col(i);
  }
  return own;
}

/// Returns the combinations of the columns of `own` with a negligible eigenvalue of `metric`.
Eigen::MatrixXd Unmeasured(const Eigen::MatrixXd& metric, const Eigen::MatrixXd& own) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(own.transpose() * metric * own);
  const Eigen::VectorXd& values = solver.eigenvalues();
  const double least = kUnmeasured * std::max(1.0, values.maxCoeff());
  Eigen::Index count = 0;
  while (count < values.size() && values[count] <= least) ++count;
  return solver.eigenvectors().leftCols(count);
}

}  // namespace

Eigen::MatrixXd PointMetric(const ModelDef& def, const Structure& s) {
  Eigen::MatrixXd metric = Eigen::MatrixXd::Zero(s.motions(), s.motions());
  for (const Anchor& place : PlacesOf(def, s)) {
    const Eigen::MatrixXd moves = MovesOf(s, place);
    metric += moves.transpose() * moves;
  }
  const Eigen::MatrixXd effective = s.Effective(s.start, true);
  for (Eigen::Index b = 0; 6 * b < s.motions(); ++b) {
    const Eigen::MatrixXd own = MotionsOfBody(effective, b);
    auto block = metric.block(6 * b, 6 * b, 6, 6);
    if (Unmeasured(block, own).cols() == 0) continue;
    block.topLeftCorner(3, 3) += Eigen::Matrix3d::Identity();
    const Eigen::MatrixXd left = Unmeasured(block, own);
    if (left.cols() == 0) continue;
    // Maps motions to coordinates in `own`, all scaled to lengths.
    const Eigen::MatrixXd measured =
        left.transpose() * (own.transpose() * own).ldlt().solve(own.transpose());
    block += measured.transpose() * measured;
  }
  return metric;
}

Eigen::VectorXd EigenvaluesOver(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& metric,
                                const Eigen::MatrixXd& motions) {
  const Eigen::LLT<Eigen::MatrixXd> root(motions.transpose() * metric * motions);
  if (motions.cols() == 0 || root.info() != Eigen::Success) return {};
  const Eigen::MatrixXd lower = root.matrixL();
  Eigen::MatrixXd half = motions.transpose() * stiffness * motions;
  lower.triangularView<Eigen::Lower>().solveInPlace(half);
  half.transposeInPlace();
  lower.triangularView<Eigen::Lower>().solveInPlace(half);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (half + half.transpose()));
  return solver.eigenvalues();
}

}  // namespace analysis

std::optional<double> LeastStiffness(const ModelDef& def, const LoadCaseSpec& loads) {
  using namespace analysis;        // NOLINT(google-build-using-namespace): this function alone
  constexpr double kZero = 1e-12;  // share of the largest eigenvalue that counts as rounding
  const Structure s(def, loads, true);
  if (s.bodies.empty()) return std::nullopt;
  const auto [holding, stiffness] = StiffnessAsDescribed(s);
  const Eigen::MatrixXd metric = PointMetric(def, s);
  const FreeMotions free = FreeMotionsOf(def, s, stiffness, metric, HeldDirections(s, holding));
  const Eigen::VectorXd values =
      EigenvaluesOver(stiffness, metric, free.basis.rightCols(free.basis.cols() - free.rigid));
  if (values.size() == 0) return std::nullopt;
  const double least = values[0];
  return std::fabs(least) > kZero * values.cwiseAbs().maxCoeff() ? least : 0;
}

}  // namespace taut
