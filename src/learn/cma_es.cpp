// Covariance matrix adaptation evolution strategy (CMA-ES).
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "learn/optimizers.h"
#include "learn/random_points.h"
#include "math/elementary.h"

namespace taut::learn {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// Covariance matrix adaptation evolution strategy, (mu / mu_w, lambda), with default settings.
/// Source: N. Hansen, "The CMA evolution strategy: a tutorial", arXiv:1604.00772, figure 6 and
/// table 1, without negative weights. Differences: points beyond a bound are mirrored, while the
/// path and the covariance use the step before mirroring. Sigma is at most 1, the full width of the
/// bounds.
class CmaEs final : public Optimizer {
 public:
  CmaEs(const CmaEsSpec& spec, int lambda, OptimizerStart start)
      : start_(std::move(start)),
        n_(static_cast<Eigen::Index>(start_.point.size())),
        lambda_(lambda),
        mu_(lambda / 2),
        sigma_(spec.deviation),
        mean_(Eigen::Map<const Vector>(start_.point.data(), n_)),
        path_c_(Vector::Zero(n_)),
        path_sigma_(Vector::Zero(n_)),
        C_(Matrix::Identity(n_, n_)),
        B_(Matrix::Identity(n_, n_)),
        D_(Vector::Ones(n_)),
        weights_(mu_) {
    const double n = static_cast<double>(n_);
    for (int i = 0; i < mu_; ++i) {
      weights_[i] = math::Log(0.5 * (lambda + 1.0)) - math::Log(i + 1.0);
    }
    weights_ /= weights_.sum();
    mu_eff_ = 1.0 / weights_.squaredNorm();
    c_sigma_ = (mu_eff_ + 2.0) / (n + mu_eff_ + 5.0);
    d_sigma_ = 1.0 + 2.0 * std::fmax(0.0, std::sqrt((mu_eff_ - 1.0) / (n + 1.0)) - 1.0) + c_sigma_;
    c_c_ = (4.0 + mu_eff_ / n) / (n + 4.0 + 2.0 * mu_eff_ / n);
    c_1_ = 2.0 / ((n + 1.3) * (n + 1.3) + mu_eff_);
    c_mu_ = std::fmin(1.0 - c_1_,
                      2.0 * (mu_eff_ - 2.0 + 1.0 / mu_eff_) / ((n + 2.0) * (n + 2.0) + mu_eff_));
    expected_norm_ = std::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
  }

  std::vector<UnitPoint> Ask() override {
    steps_.assign(static_cast<std::size_t>(lambda_), Vector(n_));
    std::vector<UnitPoint> points;
    for (Vector& step : steps_) {
      math::Random random = DrawOf(start_, drawn_++);
      Vector z(n_);
      for (Eigen::Index i = 0; i < n_; ++i) z[i] = D_[i] * random.Normal();
      step = B_ * z;  // distributed as N(0, C)
      UnitPoint& point = points.emplace_back(start_.point.size());
      for (Eigen::Index i = 0; i < n_; ++i) {
        point[static_cast<std::size_t>(i)] = Reflect(mean_[i] + sigma_ * step[i]);
      }
    }
    return points;
  }

  void Tell(const std::vector<double>& scores) override {
    std::vector<std::size_t> order(scores.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return Better(scores[a], scores[b]); });
    ++generation_;
    Vector step = Vector::Zero(n_);
    for (int i = 0; i < mu_; ++i) step += weights_[i] * steps_[order[static_cast<std::size_t>(i)]];
    mean_ += sigma_ * step;

    path_sigma_ =
        (1.0 - c_sigma_) * path_sigma_ + std::sqrt(c_sigma_ * (2.0 - c_sigma_) * mu_eff_) *
                                             (B_ * (B_.transpose() * step).cwiseQuotient(D_));
    decay_ *= (1.0 - c_sigma_) * (1.0 - c_sigma_);
    const double n = static_cast<double>(n_), norm = path_sigma_.norm();
    const bool h_sigma = norm / std::sqrt(1.0 - decay_) < (1.4 + 2.0 / (n + 1.0)) * expected_norm_;
    path_c_ = (1.0 - c_c_) * path_c_;
    if (h_sigma) path_c_ += std::sqrt(c_c_ * (2.0 - c_c_) * mu_eff_) * step;

    const double lost = h_sigma ? 0.0 : c_1_ * c_c_ * (2.0 - c_c_);
    C_ *= 1.0 - c_1_ - c_mu_ + lost;
    C_ += c_1_ * path_c_ * path_c_.transpose();
    for (int i = 0; i < mu_; ++i) {
      const Vector& y = steps_[order[static_cast<std::size_t>(i)]];
      C_ += (c_mu_ * weights_[i]) * y * y.transpose();
    }
    sigma_ *= math::Exp(std::fmin(1.0, c_sigma_ / d_sigma_ * (norm / expected_norm_ - 1.0)));
    sigma_ = std::fmin(sigma_, 1.0);
    // The decomposition costs O(n^3). With this interval, it takes at most half of the time of all
    // updates.
    if (static_cast<double>(generation_ - decomposed_) > 0.1 / ((c_1_ + c_mu_) * n)) Decompose();
  }

 private:
  void Decompose() {
    decomposed_ = generation_;
    C_ = (0.5 * (C_ + C_.transpose())).eval();
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(C_);
    if (solver.info() != Eigen::Success) return;  // keep the previous decomposition
    // Limits the scale of directions that have shrunk to rounding errors.
    const double least = 1e-20 * std::fmax(solver.eigenvalues()[n_ - 1], 1e-300);
    D_ = solver.eigenvalues().cwiseMax(least).cwiseSqrt();
    B_ = solver.eigenvectors();
  }

  OptimizerStart start_;
  Eigen::Index n_;
  int lambda_, mu_;
  double sigma_;
  Vector mean_, path_c_, path_sigma_;
  Matrix C_, B_;  ///< Covariance matrix and its eigenvectors.
  Vector D_;      ///< Square roots of its eigenvalues.
  Vector weights_;
  double mu_eff_ = 0, c_sigma_ = 0, d_sigma_ = 0, c_c_ = 0, c_1_ = 0, c_mu_ = 0, expected_norm_ = 0;
  double decay_ = 1;  ///< Decay of the initial path: (1 - c_sigma)^(2 generations).
  std::int64_t generation_ = 0, decomposed_ = 0;
  std::vector<Vector> steps_;  ///< Steps of the points before mirroring.
  std::uint64_t drawn_ = 0;
};

}  // namespace

std::unique_ptr<Optimizer> MakeCmaEs(const CmaEsSpec& spec, int batch,
                                     const OptimizerStart& start) {
  return std::make_unique<CmaEs>(spec, batch, start);
}

}  // namespace taut::learn
