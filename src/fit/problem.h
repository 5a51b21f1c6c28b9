/// A problem as the solvers see it: checked answers, losses, and linear systems in scales.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/fit.h"

namespace taut::fit {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// Known to this share of its prior sd or scale, a parameter is estimated; a direction that is has
/// a singular value of sqrt(1 / share^2 - 1) at least.
inline constexpr double kEstimatedShare = 0.5;

inline bool HasPrior(const FitParameter& parameter) {
  return parameter.prior_sd < std::numeric_limits<double>::infinity();
}
inline double PriorMean(const FitParameter& parameter) {
  return parameter.prior_mean.value_or(parameter.start);
}

/// Answers of `problem.forward` with what is wrong with them in `failed`. Nothing: it was stopped.
std::optional<std::vector<Residuals>> Compute(const FitProblem& problem,
                                              std::span<const std::vector<double>> points);

/// Loss of a residual; its own square without a loss.
double Loss(const FitRow& row, double residual);
/// d loss / d r^2: the factor of the square that has the same derivative here.
double LossWeight(const FitRow& row, double residual);

/// Which groups count. A reference: `left_out` must outlive it.
class Rows {
 public:
  Rows(const FitProblem& problem, const std::vector<bool>& left_out)
      : problem_(&problem), left_out_(&left_out) {}
  bool counts(std::size_t row) const {
    const auto group = static_cast<std::size_t>(problem_->rows[row].group);
    return group >= left_out_->size() || !(*left_out_)[group];
  }

 private:
  const FitProblem* problem_;
  const std::vector<bool>* left_out_;
};

/// Half of the sum of the losses of what counts and of the squared priors.
double Cost(const FitProblem& problem, const Rows& rows, const std::vector<double>& values,
            const std::vector<double>& residual);

/// r + J d with d in scales: weighted rows of the data, then one row a prior.
struct System {
  Matrix jacobian;
  Vector residual;
  Eigen::Index data_rows = 0;
};

/// `slopes`: a column a parameter, in residuals a unit of it; an empty one is zero.
System MakeSystem(const FitProblem& problem, const Rows& rows, const std::vector<double>& values,
                  const std::vector<double>& residual,
                  std::span<const std::vector<double>* const> slopes);

/// "group 3" or its name.
std::string GroupName(const FitProblem& problem, int group);

/// Groups that occur, ascending.
std::vector<int> Groups(const FitProblem& problem);

}  // namespace taut::fit
