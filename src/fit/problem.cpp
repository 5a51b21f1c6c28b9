#include "fit/problem.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "math/elementary.h"

namespace taut {
namespace {

std::string Wrong(const FitParameter& p) {
  const double infinite = std::numeric_limits<double>::infinity();
  if (!std::isfinite(p.start)) return "its start is not a number";
  if (std::isnan(p.low) || std::isnan(p.high) || !(p.low < p.high)) {
    return "its lower bound is not below its upper bound";
  }
  if (p.start < p.low || p.start > p.high) return "its start is not within its bounds";
  if (!(p.prior_sd > 0)) return "its prior's standard deviation is not above 0";
  if (p.prior_mean && !std::isfinite(*p.prior_mean)) return "its prior's mean is not a number";
  if (p.prior_mean && p.prior_sd == infinite)
    return "its prior has a mean, but no standard deviation";
  if (!(p.scale >= 0) || p.scale == infinite) return "its scale is negative or not a number";
  if (!(p.step > 0) || p.step == infinite) return "its step is not above 0";
  return {};
}

}  // namespace

double FitScale(const FitParameter& p) {
  if (p.scale > 0) return p.scale;
  if (fit::HasPrior(p)) return p.prior_sd;
  const double range = p.high - p.low;
  if (std::isfinite(range) && range > 0) return 0.25 * range;
  return p.start != 0 ? 0.1 * std::fabs(p.start) : 1.0;
}

std::vector<std::string> CheckFitProblem(const FitProblem& problem) {
  std::vector<std::string> wrong;
  if (!problem.forward) wrong.push_back("there is no forward model");
  if (problem.parameters.empty()) wrong.push_back("there is no parameter to estimate");
  if (problem.rows.empty()) wrong.push_back("there are no data");
  std::set<std::string> names;
  for (const FitParameter& p : problem.parameters) {
    if (const std::string what = Wrong(p); !what.empty()) wrong.push_back(p.name + ": " + what);
    if (!names.insert(p.name).second) wrong.push_back(p.name + ": the name is used twice");
  }
  for (std::size_t i = 0; i < problem.rows.size(); ++i) {
    const FitRow& row = problem.rows[i];
    if (row.group < 0) wrong.push_back("row " + std::to_string(i) + ": its group is negative");
    if (row.loss != FitLoss::kSquare && !(row.loss_width > 0)) {
      wrong.push_back("row " + std::to_string(i) + ": the width of its loss is not above 0");
    }
  }
  return wrong;
}

}  // namespace taut

namespace taut::fit {
namespace {

std::string WhyUnusable(const Residuals& answer, std::size_t rows) {
  if (answer.value.size() != rows) {
    return "the forward model returned " + std::to_string(answer.value.size()) +
           " residuals instead of " + std::to_string(rows);
  }
  for (std::size_t i = 0; i < rows; ++i) {
    if (!std::isfinite(answer.value[i]))
      return "residual " + std::to_string(i) + " is not a number";
  }
  return {};
}

}  // namespace

std::optional<std::vector<Residuals>> Compute(const FitProblem& problem,
                                              std::span<const std::vector<double>> points) {
  if (points.empty()) return std::vector<Residuals>{};
  std::vector<Residuals> answers = problem.forward(points);
  if (answers.size() != points.size()) return {};
  for (Residuals& answer : answers) {
    if (answer.failed.empty()) answer.failed = WhyUnusable(answer, problem.rows.size());
    if (!answer.failed.empty()) answer.value.clear();
  }
  return answers;
}

double Loss(const FitRow& row, double r) {
  const double w = row.loss_width;
  switch (row.loss) {
    case FitLoss::kSquare:
      return r * r;
    case FitLoss::kHuber:
      return std::fabs(r) <= w ? r * r : w * (2.0 * std::fabs(r) - w);
    case FitLoss::kCauchy:
      return w * w * math::Log(1.0 + r / w * (r / w));
  }
  return r * r;
}

double LossWeight(const FitRow& row, double r) {
  const double w = row.loss_width;
  switch (row.loss) {
    case FitLoss::kSquare:
      return 1.0;
    case FitLoss::kHuber:
      return std::fabs(r) <= w ? 1.0 : w / std::fabs(r);
    case FitLoss::kCauchy:
      return 1.0 / (1.0 + r / w * (r / w));
  }
  return 1.0;
}

double Cost(const FitProblem& problem, const Rows& rows, const std::vector<double>& values,
            const std::vector<double>& residual) {
  double sum = 0;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    if (rows.counts(i)) sum += Loss(problem.rows[i], residual[i]);
  }
  for (std::size_t j = 0; j < values.size(); ++j) {
    const FitParameter& p = problem.parameters[j];
    if (!HasPrior(p)) continue;
    const double pull = (values[j] - PriorMean(p)) / p.prior_sd;
    sum += pull * pull;
  }
  return 0.5 * sum;
}

System MakeSystem(const FitProblem& problem, const Rows& rows, const std::vector<double>& values,
                  const std::vector<double>& residual,
                  std::span<const std::vector<double>* const> slopes) {
  std::vector<std::size_t> counted, priors;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    if (rows.counts(i)) counted.push_back(i);
  }
  for (std::size_t j = 0; j < values.size(); ++j) {
    if (HasPrior(problem.parameters[j])) priors.push_back(j);
  }
  System system;
  system.data_rows = static_cast<Eigen::Index>(counted.size());
  const auto columns = static_cast<Eigen::Index>(values.size());
  const auto height = static_cast<Eigen::Index>(counted.size() + priors.size());
  system.jacobian = Matrix::Zero(height, columns);
  system.residual = Vector::Zero(height);
  for (Eigen::Index k = 0; k < system.data_rows; ++k) {
    const std::size_t i = counted[static_cast<std::size_t>(k)];
    const double root = std::sqrt(LossWeight(problem.rows[i], residual[i]));
    system.residual[k] = root * residual[i];
    for (std::size_t j = 0; j < values.size(); ++j) {
      if (slopes[j] == nullptr || slopes[j]->empty()) continue;
      system.jacobian(k, static_cast<Eigen::Index>(j)) =
          root * (*slopes[j])[i] * FitScale(problem.parameters[j]);
    }
  }
  for (std::size_t k = 0; k < priors.size(); ++k) {
    const FitParameter& p = problem.parameters[priors[k]];
    const Eigen::Index row = system.data_rows + static_cast<Eigen::Index>(k);
    system.residual[row] = (values[priors[k]] - PriorMean(p)) / p.prior_sd;
    system.jacobian(row, static_cast<Eigen::Index>(priors[k])) = FitScale(p) / p.prior_sd;
  }
  return system;
}

std::string GroupName(const FitProblem& problem, int group) {
  const auto number = static_cast<std::size_t>(group);
  if (number < problem.group_names.size() && !problem.group_names[number].empty()) {
    return problem.group_names[number];
  }
  return "group " + std::to_string(group);
}

std::vector<int> Groups(const FitProblem& problem) {
  std::set<int> found;
  for (const FitRow& row : problem.rows) found.insert(row.group);
  return {found.begin(), found.end()};
}

}  // namespace taut::fit
