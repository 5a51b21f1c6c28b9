/// Singular value decomposition (Jacobi) that survives failed allocations, and numerical rank.
#pragma once

#include <Eigen/Core>
#include <Eigen/SVD>

namespace taut::analysis {

/// Returns the number of singular values above `limit`. `values` must be in descending order.
inline Eigen::Index RankAbove(const Eigen::VectorXd& values, double limit) {
  Eigen::Index rank = 0;
  while (rank < values.size() && values[rank] > limit) ++rank;
  return rank;
}

/// Wrapper of Eigen's `JacobiSVD` without its double free. `JacobiSVD` destroys one of its members
/// and constructs it again in place. If this construction throws for lack of memory, the destructor
/// frees the member's memory a second time. `Svd` leaks the decomposition in this case.
class Svd {
 public:
  using Decomposition = Eigen::JacobiSVD<Eigen::MatrixXd>;

  /// Computes the decomposition; `options` as for `Eigen::JacobiSVD`.
  Svd(const Eigen::MatrixXd& matrix, unsigned options) : decomposition_(new Decomposition) {
    decomposition_->compute(matrix, options);
  }
  ~Svd() { delete decomposition_; }
  Svd(const Svd&) = delete;
  Svd& operator=(const Svd&) = delete;

  const Eigen::MatrixXd& matrixU() const { return decomposition_->matrixU(); }
  const Eigen::MatrixXd& matrixV() const { return decomposition_->matrixV(); }
  const Eigen::VectorXd& singularValues() const { return decomposition_->singularValues(); }

 private:
  Decomposition* decomposition_;
};

}  // namespace taut::analysis
