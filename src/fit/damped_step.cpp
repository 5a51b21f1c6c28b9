#include "fit/damped_step.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace taut::fit {
namespace {

/// Computes the unconstrained minimum over the parameters that are not pinned. Pinned ones keep
/// their values in `d`.
void SolveFree(const Quadratic& quadratic, const Vector& weight, double damping,
               const std::vector<bool>& pinned, Vector& d) {
  std::vector<Eigen::Index> free;
  Vector rest = quadratic.q;
  for (Eigen::Index j = 0; j < d.size(); ++j) {
    if (!pinned[static_cast<std::size_t>(j)]) {
      free.push_back(j);
    } else {
      rest += quadratic.R.col(j) * d[j];
    }
  }
  if (free.empty()) return;
  const auto count = static_cast<Eigen::Index>(free.size());
  Matrix stacked = Matrix::Zero(quadratic.R.rows() + count, count);
  Vector right = Vector::Zero(stacked.rows());
  right.head(quadratic.R.rows()) = -rest;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index j = free[static_cast<std::size_t>(k)];
    stacked.block(0, k, quadratic.R.rows(), 1) = quadratic.R.col(j);
    stacked(quadratic.R.rows() + k, k) = std::sqrt(damping) * weight[j];
  }
  const Vector solved = stacked.colPivHouseholderQr().solve(right);
  for (Eigen::Index k = 0; k < count; ++k) d[free[static_cast<std::size_t>(k)]] = solved[k];
}

/// Returns by how much d_j exceeds its bounds; 0 within them.
double Outside(const StepBox& box, const Vector& d, Eigen::Index j) {
  return std::max({box.low[j] - d[j], d[j] - box.high[j], 0.0});
}

}  // namespace

Quadratic Reduce(const System& system) {
  const Eigen::Index columns = system.jacobian.cols();
  if (system.jacobian.rows() <= columns) return {system.jacobian, system.residual};
  const Eigen::HouseholderQR<Matrix> qr(system.jacobian);
  Quadratic quadratic;
  quadratic.R = qr.matrixQR().topRows(columns).triangularView<Eigen::Upper>();
  quadratic.q = (qr.householderQ().transpose() * system.residual).head(columns);
  return quadratic;
}

Vector DampedStep(const Quadratic& quadratic, const Vector& weight, double damping,
                  const StepBox& box) {
  const Eigen::Index n = quadratic.R.cols();
  std::vector<bool> pinned = box.held;
  Vector d = Vector::Zero(n), first;
  for (Eigen::Index turn = 0; turn <= n; ++turn) {
    SolveFree(quadratic, weight, damping, pinned, d);
    if (turn == 0) first = d;
    Eigen::Index worst = -1;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (pinned[static_cast<std::size_t>(j)] || Outside(box, d, j) <= 0) continue;
      if (worst < 0 || Outside(box, d, j) > Outside(box, d, worst)) worst = j;
    }
    if (worst < 0) break;
    pinned[static_cast<std::size_t>(worst)] = true;
    d[worst] = std::clamp(d[worst], box.low[worst], box.high[worst]);
  }
  const auto damped = [&](const Vector& step) {
    return quadratic.Reduction(step) - 0.5 * damping * weight.cwiseProduct(step).squaredNorm();
  };
  if (damped(d) > 0) return d;
  // If pinning fails, cut the free step at the first bound. This step always lowers the quadratic.
  double share = 1.0;
  for (Eigen::Index j = 0; j < n; ++j) {
    if (first[j] > box.high[j]) share = std::min(share, box.high[j] / first[j]);
    if (first[j] < box.low[j]) share = std::min(share, box.low[j] / first[j]);
  }
  return share * first;
}

}  // namespace taut::fit
