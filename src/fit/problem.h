/// Fit problem for the solvers: validated residuals, losses, and linear systems in scales.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/fit.h"

namespace taut::fit {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// A parameter counts as estimated if its sd is at most this share of its prior sd or scale; for a
/// direction, the singular value is then at least sqrt(1 / share^2 - 1).
inline constexpr double kEstimatedShare = 0.5;
inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

inline bool HasPrior(const FitParameter& parameter) {
  return parameter.prior_sd < std::numeric_limits<double>::infinity();
}
inline double PriorMean(const FitParameter& parameter) {
  return parameter.prior_mean.value_or(parameter.start);
}

/// Returns the residuals of `problem.forward` after validation; errors are in `failed`. Nothing if
/// it was stopped.
std::optional<std::vector<Residuals>> Compute(const FitProblem& problem,
                                              std::span<const std::vector<double>> points);

/// Returns the loss of a residual; its square if the row has no loss.
double Loss(const FitRow& row, double residual);
/// Returns d loss / d r^2: the factor of the square with the same derivative at this residual.
double LossWeight(const FitRow& row, double residual);

/// Rows whose groups count. Holds a reference: `left_out` must outlive it.
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

/// Returns half of the sum of losses of counting rows and of squared priors.
double Cost(const FitProblem& problem, const Rows& rows, const std::vector<double>& values,
            const std::vector<double>& residual);

/// Linear system r + J d with d in scales: weighted rows of the data, then one row per prior.
struct System {
  Matrix jacobian;
  Vector residual;
  Eigen::Index data_rows = 0;
};

/// `slopes`: one column per parameter, in residuals per unit of the parameter; an empty one is
/// zero.
System MakeSystem(const FitProblem& problem, const Rows& rows, const std::vector<double>& values,
                  const std::vector<double>& residual,
                  std::span<const std::vector<double>* const> slopes);

/// Returns "group 3" or the group's name.
std::string GroupName(const FitProblem& problem, int group);

/// Returns the occurring groups, ascending.
std::vector<int> Groups(const FitProblem& problem);

}  // namespace taut::fit
