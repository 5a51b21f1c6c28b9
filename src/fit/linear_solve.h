/// Singular values and null space of scaled Jacobians, for identifiability (eq. F.10 to F.13 of
/// docs/theory/identification.md).
#pragma once

#include <vector>

#include "fit/problem.h"

namespace taut::fit {

/// J = U S V^T of a matrix with any number of rows, completed to as many singular values as
/// columns.
struct Singular {
  Vector value;  ///< Descending.
  Matrix V;      ///< Columns are directions.
};
Singular Decompose(const Matrix& jacobian);

/// Inverse of J^T J without its null directions, and the parameters in those: their variance is
/// infinite, although a pseudo-inverse yields a finite one.
struct Spread {
  Matrix covariance;          ///< Without null directions.
  std::vector<bool> endless;  ///< Whether a parameter is part of a null direction.
  Matrix null;                ///< Null directions, columns.
};

/// Least component of a parameter that is part of a null direction. Smaller components are errors
/// of singular vectors, since Jacobians are differences.
inline constexpr double kPartOfNull = 1e-3;
/// Singular values below this share of the largest are null.
inline constexpr double kNullShare = 1e-9;

Spread SpreadOf(const Matrix& jacobian);

/// Returns the minimum-norm d of |J d + r| without null directions: a Gauss-Newton step.
Vector LeastSquares(const Matrix& jacobian, const Vector& residual);

/// Returns the given columns.
Matrix Columns(const Matrix& matrix, const std::vector<Eigen::Index>& columns);

/// Returns the parameters that are not at a bound, or whose gradient points away from it.
std::vector<Eigen::Index> FreeOf(const FitProblem& problem, const std::vector<double>& values,
                                 const System& system);

/// Assembles the system at `values` from checked derivatives.
System SystemOf(const FitProblem& problem, const std::vector<bool>& left_out,
                const std::vector<double>& values, const FitDerivatives& derivatives);

}  // namespace taut::fit
