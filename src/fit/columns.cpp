// Columns of the Jacobian by finite differences. Each step is checked against half the step, and
// shortened if the results disagree.
#include <cmath>

#include "fit/differences.h"

namespace taut::fit {
namespace {

constexpr double kShorter = 0.25;
constexpr int kRounds = 5;  ///< Shortens the step to a thousandth at most.

double SizeOf(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

/// Returns whether a shortened step is valid: no kink is left, and the step is at least the
/// standard error that the slope implies.
bool Serves(const FitColumn& column) {
  return column.failed.empty() && !column.kink && column.step * SizeOf(column.slope) >= 1.0;
}

FitColumn ColumnOf(const FitProblem& problem, const ColumnTask& task, const Stencil& stencil,
                   double share, std::span<const Residuals> answers) {
  const double value = (*task.values)[task.parameter];
  FitColumn column;
  if (task.check) {
    column = CheckedColumn(stencil, value, FitScale(problem.parameters[task.parameter]),
                           *task.residual, answers);
  } else {
    column.slope = Slope(stencil, value, *task.residual, answers);
  }
  column.step = std::fabs(stencil.at[0] - value);
  column.step_share = share;
  return column;
}

}  // namespace

std::optional<std::vector<FitColumn>> FindColumns(const FitProblem& problem,
                                                  std::span<const ColumnTask> tasks,
                                                  const ComputePoints& compute) {
  std::vector<FitColumn> columns(tasks.size());
  std::vector<std::size_t> open(tasks.size());
  for (std::size_t k = 0; k < open.size(); ++k) open[k] = k;
  double shorter = 1.0;
  for (int round = 0; round <= kRounds && !open.empty(); ++round, shorter *= kShorter) {
    std::vector<std::vector<double>> points;
    std::vector<std::size_t> owners;
    std::vector<Stencil> stencils;
    const auto share = [&](const ColumnTask& task) { return task.check ? shorter : task.share; };
    for (const std::size_t k : open) {
      const ColumnTask& task = tasks[k];
      stencils.push_back(
          MakeStencil(problem, *task.values, task.parameter, task.check, share(task)));
      AddPoints(stencils.back(), *task.values, points);
      owners.resize(points.size(), task.owner);
    }
    std::vector<Residuals> answers;
    if (!compute(points, owners, answers)) return std::nullopt;
    std::span<const Residuals> rest(answers);
    std::vector<std::size_t> disagree;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const ColumnTask& task = tasks[open[i]];
      FitColumn column =
          ColumnOf(problem, task, stencils[i], share(task), rest.first(stencils[i].at.size()));
      rest = rest.subspan(stencils[i].at.size());
      if (round == 0 || Serves(column)) columns[open[i]] = std::move(column);
      if (columns[open[i]].kink) disagree.push_back(open[i]);
    }
    open = std::move(disagree);
  }
  return columns;
}

}  // namespace taut::fit

namespace taut {

FitDerivatives Differentiate(const FitProblem& problem, const std::vector<double>& values) {
  FitDerivatives result;
  const auto compute = [&](const std::vector<std::vector<double>>& points,
                           const std::vector<std::size_t>&, std::vector<Residuals>& answers) {
    // The first call also computes the point itself.
    std::vector<std::vector<double>> all = points;
    if (!result.done) all.push_back(values);
    auto computed = fit::Compute(problem, all);
    if (!computed) {
      result.why = "stopped";
      return false;
    }
    if (!result.done) {
      if (!computed->back().failed.empty()) {
        result.why = computed->back().failed;
        return false;
      }
      result.residual = std::move(computed->back().value);
      computed->pop_back();
      result.done = true;
    }
    answers = std::move(*computed);
    return true;
  };
  std::vector<fit::ColumnTask> tasks;
  for (std::size_t j = 0; j < values.size(); ++j) {
    tasks.push_back({0, j, &values, &result.residual});
  }
  auto columns = fit::FindColumns(problem, tasks, compute);
  result.done = columns.has_value();
  if (columns) result.columns = std::move(*columns);
  return result;
}

}  // namespace taut
