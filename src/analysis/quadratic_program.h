/// Convex quadratic programs, and linear ones: what is least of all that obeys equations and
/// inequalities. Dense, for some hundred unknowns (docs/theory/inverse_statics.md, section 3).
#pragma once

#include <Eigen/Core>

namespace taut::analysis {

/// The x that makes x' H x / 2 + g' x least, where E x = e and A x >= b.
struct QuadraticProgram {
  Eigen::MatrixXd hessian;       ///< H, symmetric, without negative eigenvalues; may be zero.
  Eigen::VectorXd gradient;      ///< g
  Eigen::MatrixXd equalities;    ///< E; a row may follow from others. Empty: none.
  Eigen::VectorXd equal_to;      ///< e
  Eigen::MatrixXd inequalities;  ///< A. Empty: none.
  Eigen::VectorXd at_least;      ///< b
};

enum class QuadraticOutcome {
  kSolved,
  kInfeasible,  ///< No x obeys all.
  kUnbounded,   ///< There is none that is least.
  kFailed,      ///< Steps ran out, or the numbers are not finite.
};

struct QuadraticAnswer {
  QuadraticOutcome outcome = QuadraticOutcome::kFailed;
  Eigen::VectorXd x;
  /// If solved, the multipliers y and z >= 0: H x + g = E' y + A' z and z' (A x - b) = 0.
  /// If infeasible, the proof (Farkas): E' y + A' z = 0, z >= 0 and e' y + b' z > 0.
  Eigen::VectorXd equality, inequality;
  Eigen::VectorXd ray;  ///< If unbounded: H d = 0, g' d < 0, E d = 0, A d >= 0.
  int steps = 0;        ///< Constraints that came in or went.
};

/// Of several solutions of a program that is not strictly convex it gives one.
QuadraticAnswer Solve(const QuadraticProgram& program);

}  // namespace taut::analysis
