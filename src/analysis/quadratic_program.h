/// Solver for convex quadratic programs (QP) and linear programs with equality and inequality
/// constraints. Matrices are dense, for up to some hundred unknowns
/// (docs/theory/inverse_statics.md, section 3).
#pragma once

#include <Eigen/Core>

namespace taut::analysis {

/// Minimize x' H x / 2 + g' x subject to E x = e and A x >= b.
struct QuadraticProgram {
  Eigen::MatrixXd hessian;       ///< H, symmetric, positive semidefinite; may be zero.
  Eigen::VectorXd gradient;      ///< g, gradient at x = 0.
  Eigen::MatrixXd equalities;    ///< E. Rows may be linearly dependent. Empty: no equations.
  Eigen::VectorXd equal_to;      ///< e, right side of the equations.
  Eigen::MatrixXd inequalities;  ///< A. Empty: no inequalities.
  Eigen::VectorXd at_least;      ///< b, lower bounds of A x.
};

enum class QuadraticOutcome {
  kSolved,
  kInfeasible,  ///< No x satisfies all constraints.
  kUnbounded,   ///< The objective has no minimum.
  kFailed,      ///< Step limit reached, or values not finite.
};

struct QuadraticAnswer {
  QuadraticOutcome outcome = QuadraticOutcome::kFailed;
  Eigen::VectorXd x;
  /// If solved, the multipliers y and z >= 0 satisfy H x + g = E' y + A' z and z' (A x - b) = 0. If
  /// infeasible, they are the proof (Farkas): E' y + A' z = 0, z >= 0 and e' y + b' z > 0.
  Eigen::VectorXd equality, inequality;
  Eigen::VectorXd ray;  ///< Direction d if unbounded: H d = 0, g' d < 0, E d = 0, A d >= 0.
  int steps = 0;        ///< Number of constraints added and removed.
};

/// Solves a program. If several x are optimal, returns one of them. Thread-safe.
QuadraticAnswer Solve(const QuadraticProgram& program);

}  // namespace taut::analysis
