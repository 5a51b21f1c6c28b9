/// Fit problem for the solvers: validated residuals, losses, and linear systems in units of scales.
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

/// A parameter counts as estimated if its sd is at most this share of its prior sd (or scale). A
/// direction counts as fixed if its singular value is at least sqrt(1 / share^2 - 1).
inline constexpr double kEstimatedShare = 0.5;
/// Probability below which a contradiction is not by chance.
inline constexpr double kByChance = 1e-3;
inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

inline bool HasPrior(const FitParameter& parameter) {
  return parameter.prior_sd < std::numeric_limits<double>::infinity();
}
inline double PriorMean(const FitParameter& parameter) {
  return parameter.prior_mean.value_or(parameter.start);
}

/// Returns the validated residuals of `problem.forward`. `failed` contains errors. Returns nothing
/// if the computation was stopped.
std::optional<std::vector<Residuals>> Compute(const FitProblem& problem,
                                              std::span<const std::vector<double>> points);

/// Returns the robust loss of a residual; its square if the row has no loss.
double Loss(const FitRow& row, double residual);
/// Returns d loss / d(r^2), the weight in iteratively reweighted least squares.
double LossWeight(const FitRow& row, double residual);

/// Selects rows by group. Holds a reference to `left_out`, which must outlive the object.
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

/// Returns half the sum of losses of the selected rows and of squared prior pulls.
double Cost(const FitProblem& problem, const Rows& rows, const std::vector<double>& values,
            const std::vector<double>& residual);

/// Linear system r + J d, with d in units of scales. Rows: weighted data, then one row per prior.
struct System {
  Matrix jacobian;
  Vector residual;
  Eigen::Index data_rows = 0;
};

/// Assembles the linear system. `slopes`: one column per parameter, in residuals per unit of the
/// parameter; an empty column counts as zero.
System MakeSystem(const FitProblem& problem, const Rows& rows, const std::vector<double>& values,
                  const std::vector<double>& residual,
                  std::span<const std::vector<double>* const> slopes);

/// Returns the name of a group, or "group 3" if it has none.
std::string GroupName(const FitProblem& problem, int group);

/// Returns all groups of the rows, in ascending order.
std::vector<int> Groups(const FitProblem& problem);

}  // namespace taut::fit
