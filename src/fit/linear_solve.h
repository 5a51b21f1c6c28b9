/// Singular values and null space of scaled Jacobians, for identifiability (eq. F.10 to F.13 of
/// docs/theory/identification.md).
#pragma once

#include <vector>

#include "fit/problem.h"

namespace taut::fit {

/// Singular value decomposition J = U S V^T, with one singular value per column (zeros if J has
/// fewer rows).
struct Singular {
  Vector value;  ///< Singular values in descending order.
  Matrix V;      ///< Columns are the right singular vectors.
};
Singular Decompose(const Matrix& jacobian);

/// Pseudo-inverse of J^T J, and the parameters in its null space. The variance of these parameters
/// is infinite, but the pseudo-inverse gives finite values.
struct Spread {
  Matrix covariance;          ///< Pseudo-inverse, without null directions.
  std::vector<bool> endless;  ///< Whether a parameter belongs to a null direction.
  Matrix null;                ///< Null directions as columns.
};

/// A parameter belongs to a null direction if its component is at least this large. Smaller
/// components are errors of finite differences.
inline constexpr double kPartOfNull = 1e-3;
/// Singular values below this share of the largest count as zero.
inline constexpr double kNullShare = 1e-9;

Spread SpreadOf(const Matrix& jacobian);

/// Minimizes |J d + r| by the d of least norm, without null directions: a Gauss-Newton step.
Vector LeastSquares(const Matrix& jacobian, const Vector& residual);

/// Returns the matrix of the listed columns.
Matrix Columns(const Matrix& matrix, const std::vector<Eigen::Index>& columns);

/// Returns the parameters that are not at a bound, or whose descent direction points away from the
/// bound.
std::vector<Eigen::Index> FreeOf(const FitProblem& problem, const std::vector<double>& values,
                                 const System& system);

/// Assembles the linear system at `values` from checked derivatives.
System SystemOf(const FitProblem& problem, const std::vector<bool>& left_out,
                const std::vector<double>& values, const FitDerivatives& derivatives);

}  // namespace taut::fit
