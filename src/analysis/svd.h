/// Singular value decomposition of any matrix that survives missing memory.
#pragma once

#include <Eigen/Core>
#include <Eigen/SVD>

namespace taut::analysis {

/// Eigen's `JacobiSVD` destroys one of its members and constructs it again in place. If the
/// construction throws for lack of memory, the destructor of `JacobiSVD` would free the memory of
/// this member a second time. `Svd` leaks the decomposition in this case.
class Svd {
 public:
  using Decomposition = Eigen::JacobiSVD<Eigen::MatrixXd>;

  /// `options` as in Eigen.
  Svd(const Eigen::MatrixXd& matrix, unsigned options) : of_(new Decomposition) {
    of_->compute(matrix, options);
  }
  ~Svd() { delete of_; }
  Svd(const Svd&) = delete;
  Svd& operator=(const Svd&) = delete;

  const Eigen::MatrixXd& matrixU() const { return of_->matrixU(); }
  const Eigen::MatrixXd& matrixV() const { return of_->matrixV(); }
  const Eigen::VectorXd& singularValues() const { return of_->singularValues(); }

 private:
  Decomposition* of_;
};

}  // namespace taut::analysis
