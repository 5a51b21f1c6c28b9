/// Singular values of scaled Jacobians and what is null of them. Equations (F.10) to (F.13) of
/// docs/theory/identification.md.
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

/// The inverse of J^T J without its null directions, and which parameters they touch: those have no
/// finite variance, whatever a pseudo-inverse gives them.
struct Spread {
  Matrix covariance;          ///< Without null directions.
  std::vector<bool> endless;  ///< A parameter that is part of a null direction.
  Matrix null;                ///< Null directions, columns.
};

/// A parameter is part of a null direction if its component is above this: below it are the errors
/// of singular vectors of a Jacobian by differences.
inline constexpr double kPartOfNull = 1e-3;
/// A singular value is null below this share of the largest.
inline constexpr double kNullShare = 1e-9;

Spread SpreadOf(const Matrix& jacobian);

/// The minimum-norm d of |J d + r| without null directions: a Gauss-Newton step.
Vector LeastSquares(const Matrix& jacobian, const Vector& residual);

/// Columns that are named.
Matrix Columns(const Matrix& matrix, const std::vector<Eigen::Index>& columns);

/// Parameters that a bound does not hold: not at one, or pulled back from it.
std::vector<Eigen::Index> FreeOf(const FitProblem& problem, const std::vector<double>& values,
                                 const System& system);

/// The system at `values` from checked derivatives.
System SystemOf(const FitProblem& problem, const std::vector<bool>& left_out,
                const std::vector<double>& values, const FitDerivatives& derivatives);

}  // namespace taut::fit
