#include "fit/linear_solve.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>

namespace taut::fit {

Singular Decompose(const Matrix& jacobian) {
  const Eigen::Index n = jacobian.cols();
  if (n == 0) return {Vector(0), Matrix(0, 0)};  // all parameters are at bounds
  Matrix square = Matrix::Zero(n, n);
  if (jacobian.rows() <= n) {
    square.topRows(jacobian.rows()) = jacobian;
  } else {
    const Eigen::HouseholderQR<Matrix> qr(jacobian);
    square = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  }
  // Jacobi's method computes small singular values with high relative accuracy.
  const Eigen::JacobiSVD<Matrix> svd(square, Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV()};
}

Spread SpreadOf(const Matrix& jacobian) {
  const Singular svd = Decompose(jacobian);
  const Eigen::Index n = jacobian.cols();
  Spread spread;
  spread.covariance = Matrix::Zero(n, n);
  spread.endless.assign(static_cast<std::size_t>(n), false);
  std::vector<Eigen::Index> null;
  for (Eigen::Index k = 0; k < n; ++k) {
    if (svd.value[k] <= kNullShare * svd.value[0]) {
      null.push_back(k);
      for (Eigen::Index j = 0; j < n; ++j) {
        if (std::fabs(svd.V(j, k)) > kPartOfNull)
          spread.endless[static_cast<std::size_t>(j)] = true;
      }
    } else {
      const Vector scaled = svd.V.col(k) / svd.value[k];
      spread.covariance += scaled * scaled.transpose();
    }
  }
  spread.null = Columns(svd.V, null);
  return spread;
}

Vector LeastSquares(const Matrix& jacobian, const Vector& residual) {
  const Spread spread = SpreadOf(jacobian);
  return -spread.covariance * (jacobian.transpose() * residual);
}

Matrix Columns(const Matrix& matrix, const std::vector<Eigen::Index>& columns) {
  Matrix chosen(matrix.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    chosen.col(static_cast<Eigen::Index>(k)) = matrix.col(columns[k]);
  }
  return chosen;
}

std::vector<Eigen::Index> FreeOf(const FitProblem& problem, const std::vector<double>& values,
                                 const System& system) {
  const Vector gradient = system.jacobian.transpose() * system.residual;
  std::vector<Eigen::Index> free;
  for (std::size_t j = 0; j < values.size(); ++j) {
    const FitParameter& p = problem.parameters[j];
    const auto k = static_cast<Eigen::Index>(j);
    const bool held =
        (values[j] <= p.low && gradient[k] > 0) || (values[j] >= p.high && gradient[k] < 0);
    if (!held) free.push_back(k);
  }
  return free;
}

System SystemOf(const FitProblem& problem, const std::vector<bool>& left_out,
                const std::vector<double>& values, const FitDerivatives& derivatives) {
  std::vector<const std::vector<double>*> slopes;
  for (const FitColumn& column : derivatives.columns) slopes.push_back(&column.slope);
  return MakeSystem(problem, Rows(problem, left_out), values, derivatives.residual, slopes);
}

}  // namespace taut::fit
